"""geometry/vertex: what transform_in_view computes without the last bits is what el_project has.

Let N = w 2^s be the normalised divisor, 2^31 <= N < 2^32, and r = el_reciprocal_near(N). With k = 2^63 - r N, proven
for every N, 1 <= k < E N, E = EL_RECIPROCAL_ERROR = 18. A product a r has g = a r - 2^32 el_product_near_u32(a, r),
0 <= g < 2^32 G, G = EL_PRODUCT_ERROR = 3.

Snapping. With m = w + c in [0, 2 w], middle + half c / w is half m / w, to the nearest. M = m 2^(s - 1) is at most N,
and half m / w = 2 half M / N. M r = 2^32 ratio + g gives

    2^32 (2^31 M - N ratio) = g N + M k,    so 0 <= 2^31 M - N ratio < (E + G) N.

Times size 2^-11 N^-1 that is 2^F half m / w less A = floor(2^-11 size ratio), F = SNAP_FRACTION: from 0 to below
(E + G) 2040 / 2048 + 1 < SNAP_OFF + 1. So A + SNAP_OFF is above 2^F half m / w by SNAP_OFF at most, and below by less
than 1. Where its fraction is not that near to the whole number below, with the half for rounding, the whole part o is
the nearest: 0 <= 4 half M + N - 2 N o < 2 N, which is the same with m and w for M and N.

Depth. near = n 2^shift exactly, with n of 32 bits, and near / w = n / (N 2^e), e the excess: only e, n and N count.
K = depth_near = floor(8 scale n / 2^32) and K r = 2^32 P + g give, with T = 4 scale n / N,

    2^32 N P = 2^63 K - K k - g N,    so N P <= 4 scale n < (P + E + G + 1) N.

depth_of has q = floor(2^32 near / w), 2^32 - 1 where near = w, and so 2^-32 4 scale (q + 1) for T 2^-e: not below it,
and above it by less than half a unit. What P 2^-e lacks is within the units that are kept free below.

1 / w. el_divisor_make has V = floor((2^64 - 1) / N), and 2 r <= V < 2 r + 2 E: what is rounded to 16 bits is the same
where r is not as near as that to the next one.
"""

from __future__ import annotations

from typing import Any

import pytest

import contracts
from c_values import ArrayType, Cell
from proof import ARMV6M, EVERY_PRECISION, Fault, Machine, Number, Pointer, Poly, Subject, quotient_of
from symbolic import require

VERTEX = "geometry/vertex.c"
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


def constant_of(machine: Machine, name: str) -> int:
    return machine.constant(machine.unit.constants[name])


def error_of(machine: Machine) -> int:
    return constant_of(machine, "EL_RECIPROCAL_ERROR")


def error_of_products(machine: Machine) -> int:
    """Of a product with the reciprocal."""
    return error_of(machine) + constant_of(machine, "EL_PRODUCT_ERROR")


PRODUCTS = {"el_product_near_u32": contracts.product_near, "el_product_high_u16": contracts.product_high_u16}


# --- which is asked for what ------------------------------------------------------------------------------------------


def any_vertex(machine: Machine) -> tuple[Any, Any, Any]:
    """A transform of either projection, any clip coordinates, and where they go."""
    path = machine.path
    near, far = path.atom("near", 1, 2**30 - 1), path.atom("far", 1, 2**31 - 1)
    path.assume(far - near)
    orthographic = path.choose(path.atom("orthographic", 0, 1))
    w = path.atom("w", 1, 2**31 - 1)
    transform = machine.struct("el_transform", near=near, far=far, orthographic=orthographic, constant_w=w)
    machine.put(transform.content["size"], [path.atom("width", 1, 2040), path.atom("height", 1, 2040)])
    machine.put(transform.content["guard_shift"], [0, 0])
    if "over" in transform.content:
        machine.put(transform.content["over"], path.choose(path.atom("over", 0, 1)))
    vertex = machine.struct("el_clip_vertex", **{axis: path.atom(axis, *I32) for axis in "xyd"})
    # In perspective w is d, in orthographic projection a constant.
    machine.put(vertex.content["w"], w if orthographic else machine.poly(vertex, "d"))
    return transform, vertex, machine.struct("el_screen_vertex")


class Asked:
    """The results of el_project and its parts on one path; the fast ways return the same, or nothing."""

    def __init__(self, machine: Machine, transform: Any, vertex: Any, screen: Any) -> None:
        self.transform, self.vertex, self.screen = transform, vertex, screen
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
        machine.path.prove(machine.poly(self.vertex, "d") - machine.poly(transform.cell, "near"), "near <= d")
        unit = self._prove_reciprocal(machine, reciprocal.poly)
        require(unit.known == 1 << w_shift.poly.known, "the shift of w")
        fast = self._either(machine)
        if fast:
            machine.put(result.cell, self.exact["z"])
        return machine.exactly("_Bool", fast)

    def form_value(self, machine: Machine, arguments: list[Any]) -> Number:
        if arguments[3].poly.known:
            require("over" in self.transform.content, "the core has an upper sum")
            require(machine.poly(self.transform, "over").known == 0, "no bit is shifted out")
        return machine.exactly("int32_t", machine.poly(self.vertex, "xyd"[arguments[1].poly.known]))

    def position_of(self, _: Machine, __: list[Any]) -> Any:
        return self.vertex

    def outcode(self, machine: Machine) -> int:
        code: Number = machine.call("el_outcode", Pointer([self.transform]), Pointer([self.vertex]))
        return code.poly.known

    def project(self, machine: Machine, arguments: list[Any]) -> None:
        require(self.outcode(machine) & constant_of(machine, "EL_CODE_CLIP") == 0, "el_project: what can be projected")
        for name, value in self.exact.items():
            machine.put(arguments[2].cell.content[name], value)

    def in_view(self, machine: Machine, _: list[Any]) -> None:
        """el_transform_vertex_in_view, proven as el_transform_vertices."""
        inside = self.outcode(machine) == 0
        machine.put(self.screen.content["code"], 0 if inside else constant_of(machine, "EL_CODE_LATER") | 1)
        for name, value in self.exact.items() if inside else ():
            machine.put(self.screen.content[name], value)


COORDINATE = (-(2**15), 2**15 - 1)


ASKED: dict[int, Asked] = {}


def vertex_domain(machine: Machine) -> list[Any]:
    asked = ASKED[id(machine.path)] = Asked(machine, *any_vertex(machine))
    machine.contracts = {
        "form_value": asked.form_value,
        "el_transform_position": asked.position_of,
        "el_reciprocal_near": asked.near,
        "snap_fast": asked.snap_fast,
        "keep_reciprocal_fast": asked.keep_reciprocal_fast,
        "depth_fast": asked.depth_fast,
        "el_project": asked.project,
    }
    return [Pointer([asked.transform]), machine.array("int16_t", [0, 0, 0]), Pointer([asked.screen])]


def later_domain(machine: Machine) -> list[Any]:
    """el_transform_vertex, which begins with what is proven of the others."""
    arguments = vertex_domain(machine)
    machine.contracts = {**machine.contracts, "el_transform_vertex_in_view": ASKED[id(machine.path)].in_view}
    return arguments


def several_domain(machine: Machine) -> list[Any]:
    """el_transform_vertices, of one: each is by itself."""
    transform, position, screen = vertex_domain(machine)
    row = Cell(ArrayType(machine.type_named("int16_t"), 3), position.cells)
    return [transform, Pointer([row]), machine.exactly("uint32_t", 1), screen]


def is_projected(machine: Machine, asked: Asked) -> None:
    for name, value in asked.exact.items():
        machine.path.prove(machine.poly(asked.screen, name) - value, f"{name} is el_project's", zero=True)


def vertex_check(machine: Machine, _: list[Any], __: Any) -> None:
    """The code is el_outcode's; what can be projected is."""
    asked = ASKED.pop(id(machine.path))
    code = asked.outcode(machine)
    require(machine.poly(asked.screen, "code").known == code, "its code")
    if code & constant_of(machine, "EL_CODE_CLIP") == 0:
        is_projected(machine, asked)


def in_view_check(machine: Machine, _: list[Any], __: Any) -> None:
    """What is in the view is projected; else the code has a side of el_outcode's, and that the rest is left."""
    asked = ASKED.pop(id(machine.path))
    code, exact = machine.poly(asked.screen, "code").known, asked.outcode(machine)
    if exact == 0:
        require(code == 0, "its code")
        is_projected(machine, asked)
        return
    later = constant_of(machine, "EL_CODE_LATER")
    require(code & later != 0 and code != later, "a side, and the rest later")
    require(code & ~(exact | later) == 0, "a side that it is beyond")


def vertices(core: str) -> Subject:
    modular = ["el_transform_vertices", "transform_vertices", "transform_in_view"]
    return Subject(VERTEX, "el_transform_vertices", several_domain, in_view_check, modular, core=core)


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
        path.assume_product(2040 - size, n)
        SNAPS[id(path)] = (m, n, size, r)
    numbers = machine.exactly("uint32_t", m), machine.exactly("uint16_t", size), machine.exactly("uint32_t", r)
    return [*numbers, machine.array("el_coordinate", [0])]


SNAPS: dict[int, tuple[Poly, Poly, Poly, Poly]] = {}


def ratio_lemma(machine: Machine, ratio: Number) -> Number:
    """How much too low, times the size; and M <= N, so the ratio is at most 1."""
    path = machine.path
    m, n, size, r = SNAPS[id(path)]
    g, k = m * r - ratio.poly * WORD, 2**63 - r * n
    path.assume_product(g, n)
    path.assume_product(constant_of(machine, "EL_PRODUCT_ERROR") * WORD - 1 - g, n)
    low = m * 2**31 - n * ratio.poly
    require((low * WORD - g * n - m * k).constant == 0, "2^32 (2^31 M - N ratio) = g N + M k")
    path.prove(low, "not too high")
    most = n * error_of_products(machine) - 1 - low
    path.prove(most, "too low by less than E + G")
    path.assume_product(low, size)
    path.assume_product(most, size)
    quotient_of(path, 2**31 - ratio.poly, n, "M <= N")
    path.assume_product(2**31 - ratio.poly, size)
    return ratio


def snap_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    """The nearest, ties up."""
    m, n, size, _ = SNAPS.pop(id(machine.path))
    path = machine.path
    if result.poly.constant == 0:
        return
    o = machine.poly(arguments[3].cell)
    unit, off = 1 << constant_of(machine, "SNAP_FRACTION"), constant_of(machine, "SNAP_OFF")
    scaled = machine.locals["snap_fast.scaled"].poly
    cut_off = machine.locals["snap_fast.ratio"].poly * size - (scaled - unit // 2 - off) * 2**11
    fraction = scaled - o * unit
    for part in (cut_off, 2**11 - 1 - cut_off, fraction - off, unit - 1 - fraction):
        path.assume_product(part, n)
    # half is size 2^(19 - F)
    error = m * size * (2**21 // unit) + n - n * o * 2
    path.prove(error, "not above the nearest")
    path.prove(n * 2 - 1 - error, "not below the nearest")


SNAP = Subject(
    VERTEX,
    "snap_fast",
    snap_domain,
    snap_check,
    ["snap_fast"],
    contracts=PRODUCTS,
    lemmas={"snap_fast.ratio": ratio_lemma},
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

    return Subject("geometry/transform.c", "guard_shift", domain)


# --- depth ------------------------------------------------------------------------------------------------------------


def depth_domain(machine: Machine) -> list[Any]:
    """near <= w in perspective; of the two shifts only their difference counts, here as in the C. Or no short way."""
    path = machine.path
    n = path.atom("N", 2**31, WORD - 1)
    near, scale = path.atom("near_bits", 2**31, WORD - 1), path.atom("depth_scale", 65534 << 12, 2**29 - 1)
    excess = path.choose(path.atom("excess", -1, 31))
    shift = path.choose(path.atom("shift", 1, 31)) if excess < 0 else 1
    k_near = path.floor(scale * near * 8, WORD)
    transform = machine.struct(
        "el_transform", depth_near=k_near, depth_excess=max(0, excess + shift), depth_scale=scale
    )
    path.assume(n * (1 << max(excess, 0)) - near)
    r, k = near_reciprocal(machine, n)
    if n.constant is None:
        path.assume_product(k_near, k)
        path.assume_product(k_near, n * error_of(machine) - 1 - k)
        path.assume_product(WORD - 1 - k_near, n)
        path.assume_product(n * (1 << max(excess, 0)) - near, scale)
        DEPTHS[id(path)] = (near, scale, excess, n, r)
    numbers = machine.exactly("unsigned", shift), machine.exactly("uint32_t", r), machine.array("uint16_t", [0])
    return [Pointer([transform]), *numbers]


DEPTHS: dict[int, tuple[Poly, Poly, int, Poly, Poly]] = {}


def depth_product(machine: Machine, arguments: list[Any]) -> Number:
    """P, and N P <= 4 scale n < (P + E + G + 1) N; so P is at most 4 scale 2^e."""
    path = machine.path
    near, scale, excess, n, r = DEPTHS[id(path)]
    product = contracts.product_near(machine, arguments)
    p, k_near = product.poly, arguments[0].poly
    g, k = k_near * r - p * WORD, 2**63 - r * n
    path.assume_product(g, n)
    path.assume_product(constant_of(machine, "EL_PRODUCT_ERROR") * WORD - 1 - g, n)
    require((n * p * WORD - k_near * 2**63 + k_near * k + g * n).constant == 0, "2^32 N P = 2^63 K - K k - g N")
    path.prove(scale * near * 4 - n * p, "not too high")
    path.prove(n * (p + error_of_products(machine) + 1) - scale * near * 4 - 1, "too low by less than E + G + 1")
    quotient_of(path, scale * (4 << excess) - p, n, "P <= 4 scale 2^e")
    return product


def depth_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    path = machine.path
    near, scale, excess, n, _ = DEPTHS.pop(id(path))
    require(excess >= 0 or result.poly.constant == 0, "the short way is not taken")
    if result.poly.constant == 0:
        return
    p = machine.locals["depth_fast.product"].poly

    # depth_of's quotient, near / w in Q32.
    q = Poly.of(WORD - 1)
    if path.decide(n * (1 << excess) - near - 1, near - n * (1 << excess)):
        q = path.new_quotient(near * WORD, n * (1 << excess), 0, WORD - 1)
    path.assume_product(near * WORD - q * n * (1 << excess), scale)
    path.assume_product((q + 1) * n * (1 << excess) - near * WORD, scale)
    above = (p + error_of_products(machine) + 1) * WORD - scale * q * (4 << excess)
    below = scale * (q + 1) * (4 << excess) - p * WORD
    quotient_of(path, above, n, "2^e 4 scale q <= 2^32 (P + E + G + 1)")
    quotient_of(path, below, n, "2^32 P <= 2^e 4 scale (q + 1)")
    z = machine.poly(arguments[3].cell)
    rounded = scale * (WORD - 1 - q) + 2**43 - z * 2**44
    path.prove(rounded, "depth_of is not below")
    path.prove(2**44 - 1 - rounded, "depth_of is not above")
    path.prove(65534 - z, "depth_of leaves it as it is")


DEPTH = Subject(VERTEX, "depth_fast", depth_domain, depth_check, contracts={"el_product_near_u32": depth_product})


def set_depth_domain(machine: Machine) -> list[Any]:
    """near of 32 bits, moved up; and moved down, where no bit may be lost."""
    path = machine.path
    shift = path.choose(path.atom("shift", -11, 29))
    near = path.atom("near", 2**31 >> max(0, -shift), (WORD - 1) >> max(0, -shift)) * (1 << max(0, shift))
    scale = path.atom("scale", 65534 << 12, 65534 * 9 << 12)
    NEARS[id(path)] = (near, shift, scale)
    transform = machine.struct("el_transform")
    return [Pointer([transform]), machine.exactly("uint64_t", near), machine.exactly("uint32_t", scale)]


NEARS: dict[int, tuple[Poly, int, Poly]] = {}


def set_depth_check(machine: Machine, arguments: list[Any], _: Any) -> None:
    """near is rounded up; K is floor(8 scale n / 2^32) with near = n 2^shift, and the excess 32 - shift."""
    near, shift, scale = NEARS.pop(id(machine.path))
    transform, path = arguments[0].cell, machine.path
    rest = machine.poly(transform, "near") * WORD - near
    path.prove(rest, "not below near")
    path.prove(WORD - 1 - rest, "near, rounded up")
    excess = machine.poly(transform, "depth_excess").known
    require(excess in (0, 32 - shift), "the excess")
    if excess != 0:
        require(shift >= 0, "near has 32 bits")
        path.prove(2**29 - 1 - scale, "its scale is small")
        rest = scale * near * 8 - machine.poly(transform, "depth_near") * (1 << (32 + shift))
        path.prove(rest, "K is not above")
        path.prove((1 << (32 + shift)) - 1 - rest, "K is not below")


def product_high(machine: Machine, arguments: list[Any]) -> Number:
    """el_product_high_u32 (test_products_are_exact)."""
    a, b = (argument.poly for argument in arguments)
    return machine.exactly("uint32_t", machine.path.floor(a * b, WORD))


SET_DEPTH = Subject(
    VERTEX, "el_transform_set_depth", set_depth_domain, set_depth_check, contracts={"el_product_high_u32": product_high}
)

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


KEEP = Subject(VERTEX, "keep_reciprocal_fast", keep_domain, keep_check, ["keep_reciprocal_fast"])

SUBJECTS = {
    "snap": SNAP,
    "depth": DEPTH,
    "set depth": SET_DEPTH,
    "1/w": KEEP,
    "vertex": Subject(VERTEX, "el_transform_vertex", later_domain, vertex_check),
    "vertices": vertices(""),
    "vertices, armv6m": vertices(ARMV6M),
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
@pytest.mark.parametrize("name", ["snap", "depth", "set depth", "1/w"])
def test_the_compiler_agrees(name: str, bits: int) -> None:
    subject = SUBJECTS[name]
    Subject(VERTEX, subject.function, subject.domain, modular=subject.modular).agree(bits, count=200)


@pytest.mark.parametrize(
    ("name", "old", "new"),
    [
        ("snap", "SNAP_OFF = 21", "SNAP_OFF = 20"),
        ("snap", "(1U << SNAP_FRACTION) / 2U", "(1U << SNAP_FRACTION) / 4U"),
        ("depth", "DEPTH_OFF = 23", "DEPTH_OFF = 22"),
        ("depth", "(1U << DEPTH_FRACTION) / 2U - (product", "(1U << DEPTH_FRACTION) / 2U + 1U - (product"),
        ("set depth", "scale_q12 < 1U << 29", "scale_q12 <= 1U << 29"),
        ("set depth", "near_q32 >> shift)", "near_q32 >> shift) + 1U"),
        ("1/w", "& 0xFFFFU) >= EL_RECIPROCAL_ERROR", "& 0xFFFFU) >= EL_RECIPROCAL_ERROR - 2U"),
        ("1/w", " && (int32_t)rounded < 0", ""),
        ("vertex", "(screen->code & EL_CODE_CLIP) == 0", "(screen->code & EL_CODE_GUARD) == 0"),
        ("vertices", "el_reciprocal_near(normalised)", "el_reciprocal_near(normalised | 1U)"),
        ("vertices", "snap_fast(from_above << (shift - 1U)", "snap_fast(from_left << (shift - 1U)"),
        ("vertices", "shift - 1U), transform->size[1]", "shift - 1U), transform->size[0]"),
        ("vertices", "from_above > 2U * w", "from_above > 2U * w + 1U"),
        ("vertices", "d < near ? EL_CODE_NEAR", "d <= near ? EL_CODE_FAR"),
        ("vertices", "y < 0 ? EL_CODE_BELOW", "y > 0 ? EL_CODE_BELOW"),
    ],
)
def test_the_proof_can_fail(name: str, old: str, new: str) -> None:
    SUBJECTS[name].fails_with(Fault(VERTEX, old, new))
