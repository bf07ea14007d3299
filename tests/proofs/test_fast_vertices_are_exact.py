"""geometry/transform: what project_inside computes from a reciprocal that is only near is what el_project has.

Let N = w 2^s be the normalised divisor, 2^31 <= N < 2^32, and r = el_reciprocal_near(N). With k = 2^63 - r N, proven
for every N, 1 <= k < E N, E = EL_RECIPROCAL_ERROR = 18.

Snapping. With m = w + c in [0, 2 w], middle + half c / w is half m / w, to the nearest. M = m 2^(s - 1) is at most N,
and half m / w = 2 half M / N. M r = 2^32 ratio + f gives

    2^32 (2^31 M - N ratio) = f N + M k,    so 0 <= 2^31 M - N ratio < (E + 1) N.

Times half that is the sum before rounding, which the C has too low by less than 20 half units of 2^-30. Where its
fraction is not that near to the next whole number, the whole part o is the nearest: 0 <= 4 half M + N - 2 N o < 2 N,
which is the same with m and w for M and N.

Depth. near = n 2^near_shift exactly, with n of 32 bits, and near / w = n / (N 2^e), e the excess: only e, n and N
count. n r = 2^32 ratio + f gives

    2^32 (2^31 n - ratio N) = f N + n k,    so 0 <= 2^31 n - ratio N < (E + 1) N,

and depth_of has q = floor(2^32 near / w), 2^32 - 1 where near = w: 2^e q < 2 ratio + 2 (E + 1) and
2 ratio < 2^e (q + 1). Times the scale, both depths are within the units that are kept free on both sides of the
fraction.

1 / w. el_divisor_make has V = floor((2^64 - 1) / N), and 2 r <= V < 2 r + 2 E: what is rounded to 16 bits is the same
where r is not as near as that to the next one.
"""

from __future__ import annotations

from typing import Any

import pytest

import contracts
from c_values import ArrayType, Cell
from proof import EVERY_PRECISION, Fault, Machine, Number, Pointer, Poly, Subject, quotient_of
from symbolic import require

TRANSFORM = "geometry/transform.c"
WORD = 1 << 32
I32 = (-(2**31), 2**31 - 1)


def near_reciprocal(machine: Machine, n: Poly) -> tuple[Poly, Poly]:
    """r, and k = 2^63 - r N; of a sample as the C has them."""
    number = machine.exactly("uint32_t", n)
    if n.constant is None:
        r = contracts.reciprocal_near(machine, [number]).poly
    else:
        r = machine.call("el_reciprocal_near", number).poly
    return r, 2**63 - r * n


def error_of(machine: Machine) -> int:
    return machine.constant(machine.unit.constants["EL_RECIPROCAL_ERROR"])


# --- which is asked for what ------------------------------------------------------------------------------------------


def inside_domain(machine: Machine) -> list[Any]:
    """A vertex that is inside by el_outcode, of either projection."""
    path = machine.path
    near, far, w = (path.atom(name, 1, 2**31 - 1) for name in ("near", "far", "w"))
    d = path.atom("d", 1, 2**31 - 1)
    path.assume(d - near)
    path.assume(far - d)
    x, y = path.atom("x", *I32), path.atom("y", *I32)
    for c in (x, y):
        path.assume(w - c)
        path.assume(w + c)
    transform = machine.struct(
        "el_transform", near=near, far=far, orthographic=path.choose(path.atom("orthographic", 0, 1))
    )
    machine.put(transform.content["size"], [path.atom("width", 1, 2040), path.atom("height", 1, 2040)])
    vertex = machine.struct("el_clip_vertex", x=x, y=y, d=d, w=w)
    return [Pointer([transform]), Pointer([vertex]), Pointer([machine.struct("el_screen_vertex")])]


class Asked:
    """The results of el_project and its parts on one path; the fast ways return the same, or nothing."""

    def __init__(self, machine: Machine, arguments: list[Any]) -> None:
        transform, vertex = arguments[0].cell, arguments[1].cell
        self.w = machine.poly(vertex, "w")
        sizes = [machine.poly(transform, "size", i) for i in range(2)]
        x, y = machine.poly(vertex, "x"), machine.poly(vertex, "y")
        self.sides = {"x": (self.w + x, sizes[0]), "y": (self.w - y, sizes[1])}
        self.exact = {axis: machine.path.atom(axis, 0, 32640) for axis in "xy"}
        self.exact["z"] = machine.path.atom("z", 0, 65534)
        self.exact["w"] = machine.path.atom("w", 2**15, 2**16 - 1)
        self.exact["w_shift"] = machine.path.atom("w_shift", 0, 31)
        self.reciprocal: tuple[Poly, Poly] | None = None

    def near(self, machine: Machine, arguments: list[Any]) -> Number:
        number = contracts.reciprocal_near(machine, arguments)
        self.reciprocal = arguments[0].poly, number.poly
        return number

    def _prove_reciprocal(self, machine: Machine, r: Poly) -> Poly:
        """r is that of N = w 2^s; the result is 2^s."""
        assert self.reciprocal is not None
        n, near = self.reciprocal
        machine.path.prove(near - r, "the reciprocal", zero=True)
        shifts = [s for s in range(32) if (n - self.w * (1 << s)).constant == 0]
        require(len(shifts) == 1, "of w, moved up")
        return Poly.of(1 << shifts[0])

    def _either(self, machine: Machine) -> int:
        return machine.path.choose(machine.path.atom("fast", 0, 1))

    def snap_fast(self, machine: Machine, arguments: list[Any]) -> Number:
        from_the_side, size, reciprocal, result = arguments
        unit = self._prove_reciprocal(machine, reciprocal.poly)
        asked = [axis for axis, (_, of) in self.sides.items() if of.terms == size.poly.terms]
        require(len(asked) == 1, "the size of one axis")
        axis = asked[0]
        machine.path.prove(from_the_side.poly * 2 - self.sides[axis][0] * unit, "M = (w + c) 2^(s - 1)", zero=True)
        fast = self._either(machine)
        machine.put(result.cell, self.exact[axis] if fast else machine.path.atom("off", *COORDINATE))
        return machine.exactly("_Bool", fast)

    def keep_reciprocal_fast(self, machine: Machine, arguments: list[Any]) -> Number:
        screen, w_shift, reciprocal = arguments
        unit = self._prove_reciprocal(machine, reciprocal.poly)
        require(unit.known == 1 << w_shift.poly.known, "the shift of w")
        fast = self._either(machine)
        for name, low, high in (("w", 0, 2**16 - 1), ("w_shift", 0, 31)):
            machine.put(screen.cell.content[name], self.exact[name] if fast else machine.path.atom("off", low, high))
        return machine.exactly("_Bool", fast)

    def depth_fast(self, machine: Machine, arguments: list[Any]) -> Number:
        transform, w_shift, reciprocal, result = arguments
        require(machine.poly(transform.cell, "orthographic").known == 0, "in perspective only")
        unit = self._prove_reciprocal(machine, reciprocal.poly)
        require(unit.known == 1 << w_shift.poly.known, "the shift of w")
        fast = self._either(machine)
        if fast:
            machine.put(result.cell, self.exact["z"])
        return machine.exactly("_Bool", fast)

    def depth_of(self, machine: Machine, arguments: list[Any]) -> Number:
        require((arguments[2].poly - self.w).constant == 0, "w")
        require((contracts.divisor_of(arguments[3]) - self.w).constant == 0, "the divisor of w")
        return machine.exactly("uint16_t", self.exact["z"])

    def project(self, machine: Machine, arguments: list[Any]) -> None:
        for name, value in self.exact.items():
            machine.put(arguments[2].cell.content[name], value)


COORDINATE = (-(2**15), 2**15 - 1)


def project_inside() -> Subject:
    """Each member is from its fast way or from its exact one, asked for the same."""
    every: dict[int, Asked] = {}

    def domain(machine: Machine) -> list[Any]:
        arguments = inside_domain(machine)
        asked = every[id(machine.path)] = Asked(machine, arguments)
        machine.contracts = {
            "el_divisor_make": contracts.divisor_make,
            "el_reciprocal_near": asked.near,
            "snap_fast": asked.snap_fast,
            "keep_reciprocal_fast": asked.keep_reciprocal_fast,
            "depth_fast": asked.depth_fast,
            "depth_of": asked.depth_of,
            "el_project": asked.project,
        }
        return arguments

    def check(machine: Machine, arguments: list[Any], _: Any) -> None:
        for name, value in every.pop(id(machine.path)).exact.items():
            machine.path.prove(machine.poly(arguments[2].cell, name) - value, f"{name} is el_project's", zero=True)

    return Subject(TRANSFORM, "project_inside", domain, check, ["project_inside"])


# --- snapping ---------------------------------------------------------------------------------------------------------


def snap_domain(machine: Machine) -> list[Any]:
    """M, and N by its reciprocal: of the two shifts that they were moved by, nothing is left."""
    path = machine.path
    size, n = path.atom("size", 1, 2040), path.atom("N", 2**31, WORD - 1)
    m = path.atom("M", 0, WORD - 1)
    path.assume(n - m)
    r, k = near_reciprocal(machine, n)
    if n.constant is None:
        # M k < E N N, and N < 2^32.
        path.assume_product(m, k - 1)
        path.assume_product(n - m, k - 1)
        path.assume_product(n, n * error_of(machine) - 1 - k)
        path.assume_product(WORD - 1 - n, n)
        SNAPS[id(path)] = (m, n, half_of(machine, size), r)
    numbers = machine.exactly("uint32_t", m), machine.exactly("uint16_t", size), machine.exactly("uint32_t", r)
    return [*numbers, machine.array("el_coordinate", [0])]


def half_of(machine: Machine, size: Poly) -> Poly:
    return size * (machine.constant(machine.unit.constants["EL_GUARD_SUB"]) // 4080)


SNAPS: dict[int, tuple[Poly, Poly, Poly, Poly]] = {}


def too_low(machine: Machine, m: Poly, n: Poly, r: Poly, ratio: Poly) -> Poly:
    """2^31 M - N ratio, and that it is in [0, (E + 1) N)."""
    path = machine.path
    f, k = m * r - ratio * WORD, 2**63 - r * n
    path.prove(f, "f >= 0")
    path.prove(WORD - 1 - f, "f < 2^32")
    path.assume_product(f, n)
    path.assume_product(WORD - 1 - f, n)
    low = m * 2**31 - n * ratio
    require((low * WORD - f * n - m * k).constant == 0, "2^32 (2^31 M - N ratio) = f N + M k")
    path.prove(low, "not too high")
    path.prove(n * (error_of(machine) + 1) - 1 - low, "too low by less than E + 1")
    return low


def ratio_lemma(machine: Machine, ratio: Number) -> Number:
    """How much too low, times half; and M <= N, so the ratio is at most 1."""
    m, n, half, r = SNAPS[id(machine.path)]
    low = too_low(machine, m, n, r, ratio.poly)
    machine.path.assume_product(low, half)
    machine.path.assume_product(n * (error_of(machine) + 1) - 1 - low, half)
    quotient_of(machine.path, 2**31 - ratio.poly, n, "M <= N")
    return ratio


def scaled_lemma(machine: Machine, scaled: Number) -> Number:
    """The ratio is at most 1, times half: the result fits its type before it is known to be right."""
    machine.path.assume_product(2**31 - machine.locals["snap_fast.ratio"].poly, SNAPS[id(machine.path)][2])
    return scaled


def snap_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    """The nearest, ties up."""
    m, n, half, _ = SNAPS.pop(id(machine.path))
    path = machine.path
    if result.poly.constant == 0:
        return
    o = machine.poly(arguments[3].cell)
    fraction = machine.locals["snap_fast.scaled"].poly - o * 2**30
    # Less than what is kept free, of N.
    path.assume_product(fraction, n)
    path.assume_product(2**30 - half * 20 - fraction, n)
    path.prove(m * half * 4 + n - n * o * 2, "not above the nearest")
    path.prove(n * 2 - 1 - m * half * 4 - n + n * o * 2, "not below the nearest")


SNAP = Subject(
    TRANSFORM,
    "snap_fast",
    snap_domain,
    snap_check,
    ["snap_fast"],
    lemmas={"snap_fast.ratio": ratio_lemma, "snap_fast.scaled": scaled_lemma},
)


def nearest_is_snapped(tie: int) -> Subject:
    """What is the nearest of half m / w is what snap has (test_vertices_keep_their_bounds), with c = m - w."""

    def domain(machine: Machine) -> list[Any]:
        path = machine.path
        w, half, o = path.atom("w", 1, 2**31 - 1), path.atom("half", 1, 2**18), path.atom("o", 0, 2**19)
        c = path.atom("c", *I32)
        error = (c + w) * half * 2 + w - w * o * 2
        path.assume(error)
        path.assume(w * 2 - tie - error)
        snapped = c * half + path.floor(w, 2) - (o - half) * w
        path.prove(snapped, "not above snap's")
        path.prove(w - 1 - snapped, "not below snap's")
        return [machine.exactly("uint16_t", 1)]

    return Subject(TRANSFORM, "guard_shift", domain)


# --- depth ------------------------------------------------------------------------------------------------------------


def depth_domain(machine: Machine) -> list[Any]:
    """near <= w in perspective; of the two shifts only their sum counts, here as in the C."""
    path = machine.path
    near = path.atom("near_bits", 2**31, WORD - 1)
    scale = path.atom("depth_scale", 65534 << 12, 65534 * 9 << 12)
    excess = path.choose(path.atom("excess", 0, 32))
    shift = path.atom("shift", 1, 31)
    transform = machine.struct("el_transform", near_bits=near, near_shift=32 - shift - excess, depth_scale=scale)
    n = path.atom("N", 2**31, WORD - 1)
    path.assume(n * (1 << excess) - near)
    r, k = near_reciprocal(machine, n)
    if n.constant is None:
        path.assume_product(near, k - 1)
        path.assume_product(near, n * error_of(machine) - 1 - k)
        path.assume_product(WORD - 1 - near, n)
        DEPTHS[id(path)] = (near, scale, excess, n, r)
    numbers = machine.exactly("unsigned", shift), machine.exactly("uint32_t", r), machine.array("uint16_t", [0])
    return [Pointer([transform]), *numbers]


DEPTHS: dict[int, tuple[Poly, Poly, int, Poly, Poly]] = {}


def near_lemma(machine: Machine, ratio: Number) -> Number:
    """How much too low; and near <= w, so scale near / w is not above the scale."""
    path = machine.path
    near, scale, excess, n, r = DEPTHS[id(path)]
    too_low(machine, near, n, r, ratio.poly)
    quotient_of(path, 2**31 * (1 << excess) - ratio.poly, n, "near <= w")
    path.assume_product(2**31 * (1 << excess) - ratio.poly, scale)
    return ratio


def depth_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    path = machine.path
    near, scale, excess, n, _ = DEPTHS.pop(id(path))
    if result.poly.constant == 0:
        return
    ratio = machine.locals["depth_fast.ratio"].poly

    # depth_of's quotient, near / w in Q32.
    q = Poly.of(WORD - 1)
    if path.decide(n * (1 << excess) - near - 1, near - n * (1 << excess)):
        q = path.new_quotient(near * WORD, n * (1 << excess), 0, WORD - 1)
    above, below = (ratio + error_of(machine) + 1) * 2 - q * (1 << excess), (q + 1) * (1 << excess) - ratio * 2
    quotient_of(path, above, n, "2^e q <= 2 ratio + 2 (E + 1)")
    quotient_of(path, below, n, "2 ratio <= 2^e (q + 1)")
    path.assume_product(above, scale)
    path.assume_product(below, scale)
    z = machine.poly(arguments[3].cell)
    rounded = scale * (WORD - 1 - q) + 2**43 - z * 2**44
    path.prove(rounded, "depth_of is not below")
    path.prove(2**44 - 1 - rounded, "depth_of is not above")
    path.prove(65534 - z, "depth_of leaves it as it is")


DEPTH = Subject(TRANSFORM, "depth_fast", depth_domain, depth_check, lemmas={"depth_fast.ratio": near_lemma})

# --- 1 / w ------------------------------------------------------------------------------------------------------------


def keep_domain(machine: Machine) -> list[Any]:
    path = machine.path
    n, shift = path.atom("N", 2**31, WORD - 1), path.atom("shift", 1, 31)
    r, k = near_reciprocal(machine, n)
    if n.constant is None:
        v = path.atom("v", 0, WORD - 1)
        of_v = 2**64 - (v + WORD) * n
        path.assume(of_v - 1)
        path.assume(n - of_v)
        require(((v + WORD - r * 2) * n - k * 2 + of_v).constant == 0, "(V - 2 r) N = 2 k - k', k' of V as k of r")
        quotient_of(path, v + WORD - r * 2, n, "2 r <= V")
        quotient_of(path, r * 2 + error_of(machine) * 2 - 1 - v - WORD, n, "V < 2 r + 2 E")
        KEPT[id(path)] = v
    numbers = machine.exactly("unsigned", shift), machine.exactly("uint32_t", r)
    return [Pointer([machine.struct("el_screen_vertex")]), *numbers]


KEPT: dict[int, Poly] = {}


def keep_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    """What keep_reciprocal makes of the exact one."""
    v = KEPT.pop(id(machine.path))
    if result.poly.constant == 0:
        return
    divisor = machine.struct("el_divisor", reciprocal=v, shift=arguments[1].poly)
    exact = machine.struct("el_screen_vertex")
    machine.call("keep_reciprocal", Pointer([exact]), Pointer([divisor]))
    for name in ("w", "w_shift"):
        machine.path.prove(machine.poly(arguments[0].cell, name) - machine.poly(exact, name), name, zero=True)


KEEP = Subject(TRANSFORM, "keep_reciprocal_fast", keep_domain, keep_check, ["keep_reciprocal_fast"])

# --- which way --------------------------------------------------------------------------------------------------------


def vertex_domain(machine: Machine) -> list[Any]:
    """Any clip coordinates; far is not below near."""
    path = machine.path
    near, far = path.atom("near", 1, 2**30 - 1), path.atom("far", 1, 2**31 - 1)
    path.assume(far - near)
    transform = machine.struct("el_transform", near=near, far=far)
    machine.put(transform.content["guard_shift"], [0, 0])
    vertex = machine.struct("el_clip_vertex", **{axis: path.atom(axis, *I32) for axis in "xyd"})
    # In perspective w is d, in orthographic projection a constant.
    orthographic = path.choose(path.atom("orthographic", 0, 1))
    w = path.atom("w", 1, 2**31 - 1) if orthographic else machine.poly(vertex, "d")
    machine.put(vertex.content["w"], w)
    machine.contracts = {
        "position_of": lambda *_: vertex,
        "project_inside": inside_contract,
        "el_project": lambda *_: None,
    }
    screen = machine.struct("el_screen_vertex")
    VERTICES[id(path)] = (transform, vertex, screen)
    return [Pointer([transform]), machine.array("int16_t", [0, 0, 0]), Pointer([screen])]


VERTICES: dict[int, tuple[Any, Any, Any]] = {}


def several_domain(machine: Machine) -> list[Any]:
    """el_transform_vertices, of one: each is by itself."""
    transform, position, screen = vertex_domain(machine)
    row = Cell(ArrayType(machine.type_named("int16_t"), 3), position.cells)
    return [transform, Pointer([row]), machine.exactly("uint32_t", 1), screen]


def vertex_check(machine: Machine, arguments: list[Any], _: Any) -> None:
    """The code is el_outcode's, or has its sides and says that the rest is left for later."""
    transform, vertex, screen = VERTICES.pop(id(machine.path))
    code, later = machine.poly(screen, "code").known, machine.constant(machine.unit.constants["EL_CODE_LATER"])
    exact = machine.call("el_outcode", Pointer([transform]), Pointer([vertex])).poly.known
    sides = exact & machine.constant(machine.unit.constants["EL_CODE_OUTSIDE"])
    require(code == exact or (len(arguments) == 4 and code == sides | later), "its code")


def inside_contract(machine: Machine, arguments: list[Any]) -> None:
    """What comes here has no outcode, and is what project_inside is proven for."""
    transform, vertex, screen = arguments
    code = machine.call("el_outcode", transform, vertex)
    require(code.poly.constant == 0 and machine.poly(screen.cell, "code").constant == 0, "inside by el_outcode")
    x, y, d, w = (machine.poly(vertex.cell, axis) for axis in "xydw")
    for bound in (w - x, w + x, w - y, w + y, w - 1, d - machine.poly(transform.cell, "near")):
        machine.path.prove(bound, "project_inside: |x|, |y| <= w, near <= d")


MODULAR = ["el_transform_vertex", "el_transform_vertices", "is_in_view"]
SUBJECTS = {
    "snap": SNAP,
    "depth": DEPTH,
    "1/w": KEEP,
    "inside": project_inside(),
    "vertex": Subject(TRANSFORM, "el_transform_vertex", vertex_domain, vertex_check, MODULAR),
    "vertices": Subject(TRANSFORM, "el_transform_vertices", several_domain, vertex_check, MODULAR),
}


@pytest.mark.parametrize("name", SUBJECTS)
def test_every_vertex(name: str) -> None:
    SUBJECTS[name].prove()


@pytest.mark.parametrize("bits", [6, 8])
def test_snapping_with_more_bits(bits: int) -> None:
    SNAP.prove(bits)


def test_the_nearest_is_what_is_snapped() -> None:
    nearest_is_snapped(tie=1).prove()
    nearest_is_snapped(tie=0).fails_with(None)


@EVERY_PRECISION
@pytest.mark.parametrize("name", ["snap", "depth", "1/w"])
def test_the_compiler_agrees(name: str, bits: int) -> None:
    subject = SUBJECTS[name]
    Subject(TRANSFORM, subject.function, subject.domain, modular=subject.modular).agree(bits, count=200)


@pytest.mark.parametrize(
    ("name", "old", "new"),
    [
        ("snap", "half * (20U << 2)", "half * (18U << 2)"),
        ("snap", "+ (1U << 29);", "+ (1U << 28);"),
        ("depth", "OFF = 24", "OFF = 10"),
        ("depth", "depth_scale >> 1) - high", "depth_scale >> 1) - high - 9U"),
        ("1/w", "0x10000U - EL_RECIPROCAL_ERROR", "0x10000U - EL_RECIPROCAL_ERROR + 2U"),
        ("1/w", "rounded > 0xFFFFU ? 0xFFFFU", "rounded > 0x10000U ? 0xFFFFU"),
        ("inside", "el_reciprocal_near(w << shift)", "el_reciprocal_near(w << shift | 1U)"),
        ("inside", "(w - (uint32_t)vertex->y) << (shift - 1U)", "(w + (uint32_t)vertex->y) << (shift - 1U)"),
        ("inside", "snap_fast(y, transform->size[1]", "snap_fast(y, transform->size[0]"),
        ("inside", "el_transform_is_orthographic(transform) || !depth_fast", "!depth_fast"),
        ("vertex", "(uint32_t)vertex->y + w <= 2U * w", "(uint32_t)vertex->y + w <= 2U * w + 1U"),
        ("vertex", "(uint32_t)vertex->d - near <=", "(uint32_t)vertex->d <="),
        ("vertices", "(outside_code(transform, &vertex) | EL_CODE_LATER)", "(EL_CODE_LATER)"),
    ],
)
def test_the_proof_can_fail(name: str, old: str, new: str) -> None:
    SUBJECTS[name].fails_with(Fault(TRANSFORM, old, new))
