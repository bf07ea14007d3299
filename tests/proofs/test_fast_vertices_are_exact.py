"""geometry/transform: what el_transform_vertex computes from 31 bits of the reciprocal is what el_project has.

Let N = w 2^s be the normalised divisor, 2^31 <= N < 2^32, v its reciprocal, and R = v >> 1 | 2^31. From
1 <= 2^64 - (v + 2^32) N <= N follows 1 <= 2^63 - R N <= N: call that k.

Snapping. With m = |c| <= w and P = 2^(31 - s), m R = 2^32 ratio + f gives

    2^(32 + s) (m P - w ratio) = 2^s w f + m k,    so 0 <= m P - w ratio < 3/2 w.

Times half that is the sum before rounding, which the C has too low by 0 to 2 half units. Where its fraction F of P
units is neither 0 nor that near to the next whole number, 2 m half + w lies strictly between 2 w o and 2 w (o + 1), o
being its whole part: the nearest, and no tie, so that the sign may be put on afterwards.

Depth. near = n 2^near_shift exactly, with n of 32 bits, and near / w = n / (N 2^e), e the excess: only e, n and N
count. n R = 2^32 ratio + f gives

    2^32 (2^31 n - ratio N) = f N + n k,    so 0 <= 2^31 n - ratio N < 2 N,

and depth_of has r = floor(2^32 near / w), 2^32 - 1 where near = w: 2^e r < 2 ratio + 4 and 2 ratio < 2^e (r + 1). Times
the scale, both depths are within the units that are kept free on both sides of the fraction.
"""

from __future__ import annotations

from typing import Any

import pytest

import contracts
from proof import EVERY_PRECISION, Fault, Machine, Number, Pointer, Poly, Subject, quotient_of
from symbolic import Infeasible, require

TRANSFORM = "geometry/transform.c"
WORD = 1 << 32
I32 = (-(2**31), 2**31 - 1)


def normalised_reciprocal(machine: Machine, n: Poly) -> tuple[Poly, Poly]:
    """R, and k = 2^63 - R N in 1..N: what prove_half proves of project_inside."""
    path = machine.path
    r = path.atom("R", 2**31, WORD - 1)
    k = 2**63 - r * n
    path.assume(k - 1)
    path.assume(n - k)
    return r, k


def half_reciprocal(divisor: Any) -> int:
    """Of a sample."""
    return int(divisor.content["reciprocal"].content.poly.known) >> 1 | 1 << 31


# --- R ----------------------------------------------------------------------------------------------------------------


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


class Exact:
    """The results of snap and depth_of on one path; the fast ways return the same, or nothing."""

    def __init__(self) -> None:
        self.snapped: dict[str, Poly] = {}

    def divisor_make(self, machine: Machine, arguments: list[Any]) -> Any:
        """el_divisor_make, with what its members are."""
        path, w = machine.path, arguments[0].poly
        path.prove(w - 1, "w >= 1")
        shift, v = path.choose(path.atom("shift", 1, 31)), path.atom("v", 0, WORD - 1)
        n = w * (1 << shift)
        path.assume(n - 2**31)
        path.assume(WORD - 1 - n)
        k = 2**64 - (v + WORD) * n
        path.assume(k - 1)
        path.assume(n - k)
        cell = machine.struct("el_divisor", normalised=n, reciprocal=v, shift=shift)
        cell.stands_for = w
        return cell

    def _result(self, machine: Machine, c: Poly, size: Poly) -> Poly:
        key = f"{c} {size}"
        if key not in self.snapped:
            self.snapped[key] = machine.path.atom("snapped", 0, 32640)
        return self.snapped[key]

    def snap(self, machine: Machine, arguments: list[Any]) -> Number:
        return machine.exactly("el_coordinate", self._result(machine, arguments[0].poly, arguments[1].poly))

    def snap_fast(self, machine: Machine, arguments: list[Any]) -> Number:
        c, size, divisor, reciprocal, result = arguments
        path, w = machine.path, contracts.divisor_of(divisor)
        path.prove(w - c.poly, "c <= w")
        path.prove(w + c.poly, "c >= -w")
        shift = machine.poly(divisor.cell, "shift")
        path.prove(machine.constant(machine.unit.constants["FAST_SHIFT"]) - shift, "a shift up to FAST_SHIFT")
        prove_half(machine, divisor, reciprocal.poly)
        if path.choose(path.atom("fast", 0, 1)) == 0:
            return machine.exactly("_Bool", 0)
        machine.put(result.cell, self._result(machine, c.poly, size.poly))
        return machine.exactly("_Bool", 1)

    def depth_of(self, machine: Machine, arguments: list[Any]) -> Number:
        return machine.exactly("uint16_t", self.snapped.setdefault("depth", machine.path.atom("depth", 0, 65534)))

    def depth_fast(self, machine: Machine, arguments: list[Any]) -> Number:
        transform, divisor, reciprocal, result = arguments
        require(machine.poly(transform.cell, "orthographic").known == 0, "in perspective only")
        prove_half(machine, divisor, reciprocal.poly)
        if machine.path.choose(machine.path.atom("fast", 0, 1)) == 0:
            return machine.exactly("_Bool", 0)
        machine.put(result.cell, self.depth_of(machine, []))
        return machine.exactly("_Bool", 1)


def prove_half(machine: Machine, divisor: Pointer, r: Poly) -> None:
    """1 <= 2^63 - R N <= N and 2^31 <= R."""
    path = machine.path
    n, v = (machine.poly(divisor.cell, name) for name in ("normalised", "reciprocal"))
    w = contracts.divisor_of(divisor)
    bit = v + WORD - r * 2
    path.prove(bit, "R is half of v + 2^32, cut off")
    path.prove(1 - bit, "R is half of v + 2^32, cut off")
    path.assume_product(bit, w)
    path.assume_product(1 - bit, w)
    path.prove(2**63 - r * n - 1, "2^63 - R N >= 1")
    path.prove(n - 2**63 + r * n, "2^63 - R N <= N")
    path.prove(r - 2**31, "R has its top bit")


def project_inside() -> Subject:
    """Each member is from its fast way or from its exact one, asked for the same."""
    exacts: dict[int, Exact] = {}

    def domain(machine: Machine) -> list[Any]:
        exact = exacts[id(machine.path)] = Exact()
        machine.contracts = {
            "el_divisor_make": exact.divisor_make,
            "snap": exact.snap,
            "snap_fast": exact.snap_fast,
            "depth_of": exact.depth_of,
            "depth_fast": exact.depth_fast,
        }
        return inside_domain(machine)

    def check(machine: Machine, arguments: list[Any], _: Any) -> None:
        exact = exacts.pop(id(machine.path))
        fast = arguments[2].cell
        transform, vertex = arguments[0].cell, arguments[1].cell
        sizes = [machine.poly(transform, "size", i) for i in range(2)]
        x, y = machine.poly(vertex, "x"), -machine.poly(vertex, "y")
        for name, key in (("x", f"{x} {sizes[0]}"), ("y", f"{y} {sizes[1]}"), ("z", "depth")):
            require(key in exact.snapped, f"{name} is of its coordinate and its size")
            machine.path.prove(machine.poly(fast, name) - exact.snapped[key], f"{name} is el_project's", zero=True)

    return Subject(TRANSFORM, "project_inside", domain, check)


# --- snapping ---------------------------------------------------------------------------------------------------------


def snap_domain(machine: Machine) -> list[Any]:
    path = machine.path
    most = machine.constant(machine.unit.constants["FAST_SHIFT"])
    size = path.atom("size", 1, 2040)
    result = machine.array("el_coordinate", [0])
    sample = size.constant is not None
    if sample:
        w = path.atom("w", 2 ** (31 - most), 2**31 - 1)
        divisor = machine.call("el_divisor_make", machine.exactly("uint32_t", w))
        r = Poly.of(half_reciprocal(divisor))
        m = path.atom("m", 0, w.known)
    else:
        s = path.choose(path.atom("shift", 1, most))
        w = path.atom("w", 2 ** (31 - s), 2 ** (32 - s) - 1)
        r, k = normalised_reciprocal(machine, w * (1 << s))
        m = path.atom("m", 0, 2**31 - 1)
        path.assume(w - m)
        divisor = machine.struct("el_divisor", shift=s)
        # m k <= w N, and w < 2^31.
        path.assume_product(m, k - 1)
        path.assume_product(w - m, k - 1)
        path.assume_product(w, w * (1 << s) - k)
        path.assume_product(2**31 - 1 - w, w)
        SNAPS[id(path)] = (m, w, size * (machine.constant(machine.unit.constants["EL_GUARD_SUB"]) // 4080), s, r)
    negative = path.choose(path.atom("negative", 0, 1))
    numbers = machine.exactly("int32_t", -m if negative else m), machine.exactly("uint16_t", size)
    return [*numbers, Pointer([divisor]), machine.exactly("uint32_t", r), result]


SNAPS: dict[int, tuple[Poly, Poly, Poly, int, Poly]] = {}


def ratio_lemma(machine: Machine, ratio: Number) -> Number:
    """0 <= m P - w ratio < 2 w, times half."""
    m, w, half, s, r = SNAPS[id(machine.path)]
    path = machine.path
    f = m * r - ratio.poly * WORD
    path.prove(f, "f >= 0")
    path.prove(WORD - 1 - f, "f < 2^32")
    path.assume_product(f, w)
    path.assume_product(WORD - 1 - f, w)
    low = m * 2 ** (31 - s) - w * ratio.poly
    k = 2**63 - r * w * (1 << s)
    require((low * (WORD << s) - f * w * (1 << s) - m * k).constant == 0, "2^(32 + s) (m P - w ratio) = 2^s w f + m k")
    path.assume_product(low, half)
    path.assume_product(w * 2 - 1 - low, half)
    return ratio


def offset_lemma(machine: Machine, offset: Number) -> Number:
    """2 w o < 2 m half + w < 2 w (o + 1), and with that o <= half."""
    path = machine.path
    m, w, half, s, _ = SNAPS[id(path)]
    o, p = offset.poly, 2 ** (31 - s)
    scaled = machine.locals["snap_fast.scaled"].poly
    f = scaled - o * p
    path.assume_product(f - 1, w)
    path.assume_product(p - half * 2 - 1 - f, w)
    path.prove(m * half * 2 + w - w * o * 2 - 1, "2 w o < 2 m half + w")
    path.prove(w * (o + 1) * 2 - m * half * 2 - w - 1, "2 m half + w < 2 w (o + 1)")
    path.assume_product(w - m, half)
    if not path.decide(half - o, o - half - 1):
        path.assume_product(o - half - 1, w)
        path.prove(Poly.of(-1), "o <= half")
        raise Infeasible
    return offset


def snap_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    """As test_vertices_keep_their_bounds has it for snap: the nearest, ties up."""
    _, w, half, _, _ = SNAPS.pop(id(machine.path))
    path = machine.path
    if result.poly.constant == 0:
        return
    c = arguments[0].poly
    error = c * half + path.floor(w, 2) - (machine.poly(arguments[4].cell) - half) * w
    path.prove(error, "not above the nearest")
    path.prove(w - 1 - error, "not below the nearest")


SNAP = Subject(
    TRANSFORM,
    "snap_fast",
    snap_domain,
    snap_check,
    ["snap_fast"],
    lemmas={"snap_fast.ratio": ratio_lemma, "snap_fast.offset": offset_lemma},
)

# --- depth ------------------------------------------------------------------------------------------------------------


def depth_domain(machine: Machine) -> list[Any]:
    """near <= w in perspective; of the two shifts only their sum counts, here as in the C."""
    path = machine.path
    near = path.atom("near_bits", 2**31, WORD - 1)
    scale = path.atom("depth_scale", 65534 << 12, 65534 * 9 << 12)
    excess = path.choose(path.atom("excess", 0, 32))
    sample = near.constant is not None
    shift = path.atom("shift", 1, 31)
    transform = machine.struct("el_transform", near_bits=near, near_shift=32 - shift - excess, depth_scale=scale)
    n = path.atom("N", 2**31, WORD - 1)
    path.assume(n * (1 << excess) - near)
    if sample:
        r = Poly.of(half_reciprocal(machine.call("el_divisor_make", machine.exactly("uint32_t", n))))
    else:
        r, k = normalised_reciprocal(machine, n)
        path.assume_product(near, k - 1)
        path.assume_product(near, n - k)
        path.assume_product(WORD - 1 - near, n)
        DEPTHS[id(path)] = (near, scale, excess, n, r)
    divisor = machine.struct("el_divisor", shift=shift)
    numbers = Pointer([divisor]), machine.exactly("uint32_t", r), machine.array("uint16_t", [0])
    return [Pointer([transform]), *numbers]


DEPTHS: dict[int, tuple[Poly, Poly, int, Poly, Poly]] = {}


def near_lemma(machine: Machine, value: Number) -> Number:
    """ratio N <= 2^31 n < (ratio + 2) N; and near <= w, so scale near / w is not above the scale."""
    path, ratio = machine.path, value.poly
    near, scale, excess, n, r = DEPTHS[id(path)]
    f = near * r - ratio * WORD
    path.assume_product(f, n)
    path.assume_product(WORD - 1 - f, n)
    path.prove(near * 2**31 - ratio * n, "ratio N <= 2^31 n")
    path.prove(n * 2 - 1 - near * 2**31 + ratio * n, "2^31 n < (ratio + 2) N")
    quotient_of(path, 2**31 * (1 << excess) - ratio, n, "near <= w")
    path.assume_product(2**31 * (1 << excess) - ratio, scale)
    return value


def depth_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    path = machine.path
    near, scale, excess, n, _ = DEPTHS.pop(id(path))
    if result.poly.constant == 0:
        return
    ratio = machine.locals["depth_fast.ratio"].poly

    # depth_of's quotient, near / w in Q32.
    r = Poly.of(WORD - 1)
    if path.decide(n * (1 << excess) - near - 1, near - n * (1 << excess)):
        r = path.new_quotient(near * WORD, n * (1 << excess), 0, WORD - 1)
    quotient_of(path, ratio * 2 + 4 - r * (1 << excess), n, "2^e r <= 2 ratio + 4")
    quotient_of(path, (r + 1) * (1 << excess) - ratio * 2, n, "2 ratio <= 2^e (r + 1)")
    path.assume_product(ratio * 2 + 4 - r * (1 << excess), scale)
    path.assume_product((r + 1) * (1 << excess) - ratio * 2, scale)
    z = machine.poly(arguments[3].cell)
    rounded = scale * (WORD - 1 - r) + 2**43 - z * 2**44
    path.prove(rounded, "depth_of is not below")
    path.prove(2**44 - 1 - rounded, "depth_of is not above")
    path.prove(65534 - z, "depth_of leaves it as it is")


DEPTH = Subject(TRANSFORM, "depth_fast", depth_domain, depth_check, lemmas={"depth_fast.ratio": near_lemma})

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
        "el_transform_position": lambda *_: vertex,
        "project_inside": inside_contract,
        "el_project": lambda *_: None,
    }
    return [Pointer([transform]), machine.array("int16_t", [0, 0, 0]), Pointer([machine.struct("el_screen_vertex")])]


def inside_contract(machine: Machine, arguments: list[Any]) -> None:
    """What comes here has no outcode, and is what project_inside is proven for."""
    transform, vertex, screen = arguments
    code = machine.call("el_outcode", transform, vertex)
    require(code.poly.constant == 0 and machine.poly(screen.cell, "code").constant == 0, "inside by el_outcode")
    x, y, d, w = (machine.poly(vertex.cell, axis) for axis in "xydw")
    for bound in (w - x, w + x, w - y, w + y, w - 1, d - machine.poly(transform.cell, "near")):
        machine.path.prove(bound, "project_inside: |x|, |y| <= w, near <= d")


VERTEX = Subject(TRANSFORM, "el_transform_vertex", vertex_domain, modular=["el_transform_vertex"])
SUBJECTS = {"snap": SNAP, "depth": DEPTH, "inside": project_inside(), "vertex": VERTEX}


@pytest.mark.parametrize("name", SUBJECTS)
def test_every_vertex(name: str) -> None:
    SUBJECTS[name].prove()


@pytest.mark.parametrize("bits", [6, 8])
def test_snapping_with_more_bits(bits: int) -> None:
    SNAP.prove(bits)


@EVERY_PRECISION
@pytest.mark.parametrize("name", ["snap", "depth"])
def test_the_compiler_agrees(name: str, bits: int) -> None:
    subject = SUBJECTS[name]
    modular = ["snap_fast", "reciprocal_word", "el_divide_words"]
    Subject(TRANSFORM, subject.function, subject.domain, modular=modular).agree(bits, count=200)


@pytest.mark.parametrize(
    ("name", "old", "new"),
    [
        ("snap", "fraction == 0 || ", ""),
        ("snap", "0U - (half << (s + 2U))", "0U - (half << s)"),
        ("snap", "(1ULL << (30U - s))", "(1ULL << (29U - s))"),
        ("depth", "fraction < 5U", "fraction < 1U"),
        ("depth", "depth_scale >> 1) - high", "depth_scale >> 1) - high - 9U"),
        ("inside", "divisor.reciprocal >> 1 | 1U << 31", "(divisor.reciprocal >> 1 | 1U << 31) - 1U"),
        ("inside", "divisor.shift <= FAST_SHIFT", "divisor.shift <= FAST_SHIFT + 1"),
        ("inside", "snap_fast(-vertex->y, transform->size[1]", "snap_fast(-vertex->y, transform->size[0]"),
        ("vertex", "(uint32_t)vertex.y + w <= 2U * w", "(uint32_t)vertex.y + w <= 2U * w + 1U"),
        ("vertex", "(uint32_t)vertex.d - (uint32_t)transform->near <=", "(uint32_t)vertex.d <="),
    ],
)
def test_the_proof_can_fail(name: str, old: str, new: str) -> None:
    SUBJECTS[name].fails_with(Fault(TRANSFORM, old, new))
