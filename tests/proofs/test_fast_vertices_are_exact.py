"""geometry/vertex: what transform_in_view computes without the last bits is what el_project has.

Let N = w 2^s be the divisor with 31 bits, 2^30 <= N < 2^31, and r = el_reciprocal_beside(N). With k = 2^61 - r N,
proven for every N, -H N < k < L N, H = EL_RECIPROCAL_HIGH = 3, L = EL_RECIPROCAL_LOW = 4. A product a r has g = a r -
2^32 el_product_near_u32(a, r), 0 <= g < 2^32 G, G = EL_PRODUCT_ERROR = 3. What is so made is a number with some bits of
fraction, beside the exact one by less than 2^TIE_BITS of its units; where it is that near to the step below,
is_near_step says so, and it is not taken.

Snapping. With m = w + c in [0, 2 w], middle + half c / w is half m / w, to the nearest. M = m 2^s is at most 2 N, below
2^32, and half m / w = half M / N. M r = 2^32 ratio + g gives

    2^32 (2^29 M - N ratio) = g N + M k,    so -H N < 2^29 M - N ratio < (L + G) N.

Times size 2^-11 N^-1 that is 2^F half m / w less A = size 2^-11 ratio, F = SNAP_FRACTION; A without its fraction is too
low by less than (L + G) 2040 / 2048 + 1 < SNAP_OFF, or too high by less than H. So A + SNAP_OFF is above 2^F half m /
w, by less than 2^TIE_BITS. Where its fraction is not below that, with the half for rounding, the whole part o is the
nearest: 0 <= 2 half M + N - 2 N o < 2 N, which is the same with m and w for M and N.

Depth. near = n 2^shift exactly, with n of 32 bits, and near / w = n / (N 2^(e + 1)), e the excess: only e, n and N
count. K = depth_near = floor(8 scale n / 2^32) and K r = 2^32 P + g give

    2^32 (scale n - N P) = (2^32 scale n - 2^61 K) + K k + g N,    so N (P - H) < scale n < N (P + L + G + 1).

depth_of has q = floor(2^32 near / w), 2^32 - 1 where near = w, and so 2^-32 scale (q + 1) for scale near / w: not below
it, and above it by less than a quarter of a unit of 2^-13. What P 2^-e lacks is within the units that are kept free
below.

1 / w. el_divisor_make has V = floor((2^64 - 1) / 2 N) - 2^32, and 4 r is above 2^32 + V - 16 and below 2^32 + V + 13:
what is rounded to 16 bits is the same where r is not that near to the next one.
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
    """r, and k = 2^61 - r N; of a sample as the C has them."""
    number = machine.exactly("uint32_t", n)
    if n.constant is None:
        r = contracts.reciprocal_beside(machine, [number]).poly
    else:
        r = machine.call("el_reciprocal_beside", number).poly
    return r, 2**61 - r * n


def constant_of(machine: Machine, name: str) -> int:
    return machine.constant(machine.unit.constants[name])


def most_too_high(machine: Machine) -> int:
    """H: of a product with the reciprocal."""
    return constant_of(machine, "EL_RECIPROCAL_HIGH")


def most_too_low(machine: Machine) -> int:
    """L + G: of a product with the reciprocal."""
    return constant_of(machine, "EL_RECIPROCAL_LOW") + constant_of(machine, "EL_PRODUCT_ERROR")


def is_near_step(machine: Machine, value: Poly, fraction: int) -> bool:
    """What the C's is_near_step says (STEP)."""
    path = machine.path
    tie = 1 << constant_of(machine, "TIE_BITS")
    rest = value - path.floor(value, 1 << fraction) * (1 << fraction)
    return path.decide(tie - 1 - rest, rest - tie)


def near_step(machine: Machine, arguments: list[Any]) -> Number:
    value, fraction = arguments
    return machine.exactly("_Bool", int(is_near_step(machine, value.poly, fraction.poly.known)))


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
    # What is known of the loop: all; that there is no short way; nothing of the rows' shift.
    kind = 1 if orthographic else path.choose(path.atom("kind", 0, 2))
    machine.put(transform.content["depth_excess"], 0 if kind == 1 else 30)
    machine.put(transform.content["depth_scale"], path.atom("depth_scale", 0, WORD - 1))
    known, value = shift_known(machine, transform)
    machine.put(transform.content[known], value + (kind == 2))
    vertex = machine.struct("el_clip_vertex", **{axis: path.atom(axis, *I32) for axis in "xyd"})
    # In perspective w is d, in orthographic projection a constant.
    machine.put(vertex.content["w"], w if orthographic else machine.poly(vertex, "d"))
    return transform, vertex, machine.struct("el_screen_vertex")


def shift_known(machine: Machine, transform: Any) -> tuple[str, int]:
    """Where rows are plain: which member of the transform has which value."""
    return ("over", 0) if "over" in transform.content else ("shift", constant_of(machine, "EL_ROW_SHIFT"))


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
        self.keeps_w = True
        self.beside: list[tuple[Poly, Poly, Poly]] = []

    def near(self, machine: Machine, arguments: list[Any]) -> Number:
        number = contracts.reciprocal_beside(machine, arguments)
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

    def _beside(self, machine: Machine, exact: Poly, most: int, fraction: int) -> Number:
        """What is not near a step has the exact whole part; what is near one may have any."""
        whole = machine.path.atom("whole", 0, most)
        rest = machine.path.atom("rest", 0, (1 << fraction) - 1)
        self.beside.append((whole, rest, exact))
        return machine.exactly("uint32_t", whole * (1 << fraction) + rest)

    def near_step(self, machine: Machine, arguments: list[Any]) -> Number:
        value, fraction = arguments[0].poly, 1 << arguments[1].poly.known
        found = [of for of in self.beside if (of[0] * fraction + of[1]).terms == value.terms]
        require(len(found) == 1, "a result")
        whole, rest, exact = found[0]
        tie = 1 << constant_of(machine, "TIE_BITS")
        near = machine.path.decide(tie - 1 - rest, rest - tie)
        if not near:
            machine.path.assume(whole - exact, zero=True)
        return machine.exactly("_Bool", int(near))

    def snap_fast(self, machine: Machine, arguments: list[Any]) -> Number:
        from_the_side, size, reciprocal = arguments
        unit = self._prove_reciprocal(machine, reciprocal.poly)
        asked = [axis for axis, (_, of) in self.sides.items() if (of * 2**5).terms == size.poly.terms]
        require(len(asked) == 1, "the size of one axis")
        axis = asked[0]
        machine.path.prove(from_the_side.poly - self.sides[axis][0] * unit, "M = (w + c) 2^s", zero=True)
        return self._beside(machine, self.exact[axis], COORDINATE[1], constant_of(machine, "SNAP_FRACTION"))

    def keep_reciprocal_fast(self, machine: Machine, arguments: list[Any]) -> Number:
        screen, w_shift, reciprocal = arguments
        unit = self._prove_reciprocal(machine, reciprocal.poly)
        require(unit.known == 1 << w_shift.poly.known, "the shift of w")
        fast = self._either(machine)
        for name, low, high in (("w", 0, 2**16 - 1), ("w_shift", 0, 31)):
            machine.put(screen.cell.content[name], self.exact[name] if fast else machine.path.atom("off", low, high))
        return machine.exactly("_Bool", fast)

    def depth_fast(self, machine: Machine, arguments: list[Any]) -> Number:
        transform, scales, w_shift, reciprocal = arguments
        machine.path.prove(machine.poly(self.vertex, "d") - machine.poly(transform.cell, "near"), "near <= d")
        require(machine.poly(transform.cell, "depth_excess").known != 0, "there is a short way")
        machine.path.prove(machine.poly(scales.cell, "depth") - depth_scale(machine, transform), "its scale", zero=True)
        unit = self._prove_reciprocal(machine, reciprocal.poly)
        require(unit.known == 1 << w_shift.poly.known, "the shift of w")
        return self._beside(machine, self.exact["z"], 2**19 - 1, constant_of(machine, "DEPTH_FRACTION"))

    def form_value(self, machine: Machine, arguments: list[Any]) -> Number:
        if arguments[3].poly.known:
            known, value = shift_known(machine, self.transform)
            require(machine.poly(self.transform, known).known == value, f"{known} is what is taken for known")
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


def depth_scale(machine: Machine, transform: Any) -> Poly:
    """el_scales.depth. The scale is below 2^29 where there is a short way (SET_DEPTH), and is there for that alone."""
    scale = machine.poly(transform.cell if isinstance(transform, Pointer) else transform, "depth_scale")
    machine.path.assume(2**29 - 1 - scale)
    depth: Poly = scale * 2 + (2 ** (constant_of(machine, "DEPTH_FRACTION") - 1) + constant_of(machine, "DEPTH_OFF"))
    return depth


def leading_zeros(machine: Machine, arguments: list[Any]) -> Number:
    """el_leading_zeros, whose table tests/unit/test_reciprocals.c tries. Pre: not 0."""
    path, x = machine.path, arguments[0].poly
    path.prove(x - 1, "el_leading_zeros: not of 0")
    zeros = path.choose(path.atom("zeros", 0, 31))
    path.assume(x - 2 ** (31 - zeros))
    path.assume(2 ** (32 - zeros) - 1 - x)
    return machine.exactly("unsigned", zeros)


ASKED: dict[int, Asked] = {}


def vertex_domain(machine: Machine) -> list[Any]:
    asked = ASKED[id(machine.path)] = Asked(machine, *any_vertex(machine))
    machine.contracts = {
        "form_value": asked.form_value,
        "el_transform_position": asked.position_of,
        "el_leading_zeros": leading_zeros,
        "el_reciprocal_beside": asked.near,
        "is_near_step": asked.near_step,
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
    """el_transform_vertices, of one: each is by itself. With 1 / w and without."""
    transform, position, screen = vertex_domain(machine)
    row = Cell(ArrayType(machine.type_named("int16_t"), 3), position.cells)
    asked = ASKED[id(machine.path)]
    plain = machine.poly(asked.transform, "depth_excess").known != 0
    asked.keeps_w = not plain or bool(machine.path.choose(machine.path.atom("keeps_w", 0, 1)))
    keeps_w = machine.exactly("_Bool", int(asked.keeps_w))
    return [transform, Pointer([row]), machine.exactly("uint32_t", 1), screen, keeps_w]


def is_projected(machine: Machine, asked: Asked) -> None:
    for name, value in asked.exact.items():
        if name in ("w", "w_shift") and not asked.keeps_w:
            continue
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
    size, n = path.atom("size", 1, 2040), path.atom("N", 2**30, 2**31 - 1)
    m = path.atom("M", 0, WORD - 2)
    path.assume(n * 2 - m)
    r, k = near_reciprocal(machine, n)
    if n.constant is None:
        # M k is within L N and H N times M, and M < 2^32.
        path.assume_product(m, k + n * most_too_high(machine) - 1)
        path.assume_product(m, n * constant_of(machine, "EL_RECIPROCAL_LOW") - 1 - k)
        path.assume_product(WORD - 1 - m, n)
        path.assume_product(2040 - size, n)
        SNAPS[id(path)] = (m, n, size, r)
    numbers = machine.exactly("uint32_t", m), machine.exactly("uint32_t", size * 2**5), machine.exactly("uint32_t", r)
    return [*numbers]


SNAPS: dict[int, tuple[Poly, Poly, Poly, Poly]] = {}


def ratio_lemma(machine: Machine, ratio: Number) -> Number:
    """How much too low or too high, times the size."""
    path = machine.path
    m, n, size, r = SNAPS[id(path)]
    g, k = m * r - ratio.poly * WORD, 2**61 - r * n
    path.assume_product(g, n)
    path.assume_product(constant_of(machine, "EL_PRODUCT_ERROR") * WORD - 1 - g, n)
    low = m * 2**29 - n * ratio.poly
    require((low * WORD - g * n - m * k).constant == 0, "2^32 (2^29 M - N ratio) = g N + M k")
    above, below = low + n * most_too_high(machine), n * most_too_low(machine) - low
    path.prove(above, "too high by H at most")
    path.prove(below, "too low by L + G at most")
    path.assume_product(above, size)
    path.assume_product(below, size)
    quotient_of(path, 2**30 + most_too_high(machine) - ratio.poly, n, "M <= 2 N")
    path.assume_product(2**30 + most_too_high(machine) - ratio.poly, size)
    return ratio


def snap_check(machine: Machine, _: list[Any], result: Number) -> None:
    """The nearest, ties up."""
    m, n, size, _r = SNAPS.pop(id(machine.path))
    path, bits = machine.path, constant_of(machine, "SNAP_FRACTION")
    if is_near_step(machine, result.poly, bits):
        return
    unit, off = 1 << bits, constant_of(machine, "SNAP_OFF")
    o = path.floor(result.poly, unit)
    cut_off = machine.locals["snap_fast.ratio"].poly * size - (result.poly - unit // 2 - off) * 2**11
    fraction = result.poly - o * unit
    for part in (cut_off, 2**11 - 1 - cut_off, fraction - (1 << constant_of(machine, "TIE_BITS")), unit - 1 - fraction):
        path.assume_product(part, n)
    # 2 half is size 2^(19 - F)
    error = m * size * (2**19 // unit) + n - n * o * 2
    path.prove(error, "not above the nearest")
    path.prove(n * 2 - 1 - error, "not below the nearest")


SNAP = Subject(
    VERTEX,
    "snap_fast",
    snap_domain,
    snap_check,
    ["snap_fast", "el_reciprocal_beside"],
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
    """near <= w in perspective; of the two shifts only their difference counts, here as in the C."""
    path = machine.path
    n = path.atom("N", 2**30, 2**31 - 1)
    near, scale = path.atom("near_bits", 2**31, WORD - 1), path.atom("depth_scale", 65534 << 12, 2**29 - 1)
    excess = path.choose(path.atom("excess", 0, 30))
    shift = 0
    k_near = path.floor(scale * near * 8, WORD)
    transform = machine.struct("el_transform", depth_near=k_near, depth_excess=excess + shift, depth_scale=scale)
    scales = machine.struct("el_scales", depth=depth_scale(machine, transform))
    path.assume(n * (2 << excess) - near)
    r, k = near_reciprocal(machine, n)
    if n.constant is None:
        path.assume_product(k_near, k + n * most_too_high(machine) - 1)
        path.assume_product(k_near, n * constant_of(machine, "EL_RECIPROCAL_LOW") - 1 - k)
        path.assume_product(WORD - 1 - k_near, n)
        path.assume_product(n * (2 << excess) - near, scale)
        DEPTHS[id(path)] = (near, scale, excess, n, r)
    numbers = machine.exactly("unsigned", shift), machine.exactly("uint32_t", r)
    return [Pointer([transform]), Pointer([scales]), *numbers]


DEPTHS: dict[int, tuple[Poly, Poly, int, Poly, Poly]] = {}


def depth_product(machine: Machine, arguments: list[Any]) -> Number:
    """P, and N (P - H) < scale n < (P + L + G + 1) N; so P is at most scale 2^(e + 1) + H."""
    path = machine.path
    near, scale, excess, n, r = DEPTHS[id(path)]
    product = contracts.product_near(machine, arguments)
    p, k_near = product.poly, arguments[0].poly
    g, k = k_near * r - p * WORD, 2**61 - r * n
    high, low = most_too_high(machine), most_too_low(machine)
    path.assume_product(g, n)
    path.assume_product(constant_of(machine, "EL_PRODUCT_ERROR") * WORD - 1 - g, n)
    require((n * p * WORD - k_near * 2**61 + k_near * k + g * n).constant == 0, "2^32 N P = 2^61 K - K k - g N")
    path.prove(scale * near - n * (p - high), "not too high")
    path.prove(n * (p + low + 1) - scale * near - 1, "too low by less than L + G + 1")
    quotient_of(path, scale * (2 << excess) + high - p, n, "P <= 2^(e + 1) scale + H")
    return product


def depth_check(machine: Machine, _: list[Any], result: Number) -> None:
    path = machine.path
    near, scale, excess, n, _r = DEPTHS.pop(id(path))
    p = machine.locals["depth_fast.product"].poly
    bits = constant_of(machine, "DEPTH_FRACTION")
    if is_near_step(machine, result.poly, bits):
        return
    z = path.floor(result.poly, 1 << bits)
    if not path.decide(65534 - z, z - 65535):
        return  # transform_in_view leaves it

    # depth_of's quotient, near / w in Q32.
    q = Poly.of(WORD - 1)
    if path.decide(n * (2 << excess) - near - 1, near - n * (2 << excess)):
        q = path.new_quotient(near * WORD, n * (2 << excess), 0, WORD - 1)
    path.assume_product(near * WORD - q * n * (2 << excess), scale)
    path.assume_product((q + 1) * n * (2 << excess) - near * WORD, scale)
    above = (p + most_too_low(machine) + 1) * WORD - scale * q * (2 << excess)
    below = scale * (q + 1) * (2 << excess) - (p - most_too_high(machine)) * WORD
    quotient_of(path, above, n, "2^(e + 1) scale q <= 2^32 (P + L + G + 1)")
    quotient_of(path, below, n, "2^32 (P - H) <= 2^(e + 1) scale (q + 1)")
    rounded = scale * (WORD - 1 - q) + 2**43 - z * 2**44
    path.prove(rounded, "depth_of is not below")
    path.prove(2**44 - 1 - rounded, "depth_of is not above")


DEPTH = Subject(
    VERTEX,
    "depth_fast",
    depth_domain,
    depth_check,
    ["el_reciprocal_beside"],
    contracts={"el_product_near_u32": depth_product},
)


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
    """near is rounded up; K is floor(8 scale n / 2^32) with near = n 2^shift, and the excess 31 - shift."""
    near, shift, scale = NEARS.pop(id(machine.path))
    transform, path = arguments[0].cell, machine.path
    rest = machine.poly(transform, "near") * WORD - near
    path.prove(rest, "not below near")
    path.prove(WORD - 1 - rest, "near, rounded up")
    excess = machine.poly(transform, "depth_excess").known
    require(excess in (0, 31 - shift), "the excess")
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
    n, shift = path.atom("N", 2**30, 2**31 - 1), path.atom("shift", 0, 30)
    r, k = near_reciprocal(machine, n)
    if n.constant is None:
        v = path.atom("v", 0, WORD - 1)
        of_v = 2**64 - (v + WORD) * n * 2
        path.assume(of_v - 1)
        path.assume(n * 2 - of_v)
        require(
            ((v + WORD - r * 4) * n * 2 - k * 8 + of_v).constant == 0, "(V - 4 r) 2 N = 8 k - k', k' of V as k of r"
        )
        low, high = (constant_of(machine, f"EL_RECIPROCAL_{end}") for end in ("LOW", "HIGH"))
        quotient_of(path, v + WORD - r * 4 + high * 4 + 1, n * 2, "4 r <= V + 4 H + 1")
        quotient_of(path, r * 4 + low * 4 - 1 - v - WORD, n * 2, "V < 4 r + 4 L")
        KEPT[id(path)] = v
    numbers = machine.exactly("unsigned", shift), machine.exactly("uint32_t", r)
    return [Pointer([machine.struct("el_screen_vertex")]), *numbers]


KEPT: dict[int, Poly] = {}


def keep_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    """What keep_reciprocal makes of the exact one."""
    v = KEPT.pop(id(machine.path))
    if result.poly.constant == 0:
        return
    divisor = machine.struct("el_divisor", reciprocal=v, shift=arguments[1].poly + 1)
    exact = machine.struct("el_screen_vertex")
    machine.call("keep_reciprocal", Pointer([exact]), Pointer([divisor]))
    for name in ("w", "w_shift"):
        machine.path.prove(machine.poly(arguments[0].cell, name) - machine.poly(exact, name), name, zero=True)


KEEP = Subject(
    VERTEX,
    "keep_reciprocal_fast",
    keep_domain,
    keep_check,
    ["keep_reciprocal_fast", "el_reciprocal_beside"],
    contracts={"is_near_step": near_step},
)

# --- steps ------------------------------------------------------------------------------------------------------------


def step_domain(machine: Machine) -> list[Any]:
    bits = machine.path.choose(machine.path.atom("fraction", 8, 16))
    return [machine.exactly("uint32_t", machine.path.atom("value", 0, WORD - 1)), machine.exactly("unsigned", bits)]


def step_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    """As the other proofs take it."""
    value, fraction = arguments
    wanted = is_near_step(machine, value.poly, fraction.poly.known)
    machine.path.prove(result.poly - int(wanted), "is near a step", zero=True)


STEP = Subject(VERTEX, "is_near_step", step_domain, step_check)

SUBJECTS = {
    "snap": SNAP,
    "depth": DEPTH,
    "set depth": SET_DEPTH,
    "1/w": KEEP,
    "step": STEP,
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
        ("snap", "SNAP_OFF = 8", "SNAP_OFF = 6"),
        ("snap", "(1U << SNAP_FRACTION) / 2U", "(1U << SNAP_FRACTION) / 4U"),
        ("depth", "DEPTH_OFF = 4", "DEPTH_OFF = 2"),
        ("depth", "scales->depth - (product", "scales->depth - 16U - (product"),
        ("set depth", "scale_q12 < 1U << 29", "scale_q12 <= 1U << 29"),
        ("set depth", "near_q32 >> shift)", "near_q32 >> shift) + 1U"),
        ("1/w", "/ 2U + (uint32_t)EL_RECIPROCAL_LOW)", "/ 2U)"),
        ("1/w", " || (int32_t)rounded < 0", ""),
        ("step", "(1U << TIE_BITS))", "(2U << TIE_BITS))"),
        ("vertex", "(screen->code & EL_CODE_CLIP) == 0", "(screen->code & EL_CODE_GUARD) == 0"),
        ("vertices", "el_reciprocal_beside(w << shift)", "el_reciprocal_beside((w << shift) + 1U)"),
        ("vertices", "snap_fast(from_above << shift", "snap_fast(from_left << shift"),
        ("vertices", "from_above << shift, scales->height", "from_above << shift, scales->width"),
        ("vertices", "if (!plain && transform->depth_excess == 0)", "if (false)"),
        ("vertices", "is_near_step(down, SNAP_FRACTION) ||", ""),
        ("vertices", "(transform->depth_scale << 1) +", "(transform->depth_scale << 2) +"),
        ("vertices", "from_above > 2U * w", "from_above > 2U * w + 1U"),
        ("vertices", "d < near ? EL_CODE_NEAR", "d <= near ? EL_CODE_FAR"),
        ("vertices", "y < 0 ? EL_CODE_BELOW", "y > 0 ? EL_CODE_BELOW"),
    ],
)
def test_the_proof_can_fail(name: str, old: str, new: str) -> None:
    SUBJECTS[name].fails_with(Fault(VERTEX, old, new))
