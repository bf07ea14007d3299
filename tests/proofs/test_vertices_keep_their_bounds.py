"""geometry/vertex and geometry/clip: from a position to the snapped screen, and the new vertices of cut triangles.

el_transform_position's domain is what el_transform_make promises. All that comes after it is proven for any clip
coordinates of 32 bits, also those of a mesh whose bounding sphere is a lie: el_outcode first, then el_project for the
vertices that it found inside, and the clip for the others. What most vertices take, el_transform_vertex, has the same
results: see test_fast_vertices_are_exact.

A cut takes t = da / (da - db) in [0, 1] as Q31, so mix() stays between its ends, and nothing that is mixed grows. The
product in mix() is below (2^32 - 1) 2^31 + 2^30 < 2^63.
"""

from __future__ import annotations

import itertools
from typing import Any

import pytest

import contracts
from c_source import SMALL_CODE
from c_values import ArrayType, Cell
from proof import ARMV6M, EVERY_PRECISION, Fault, Machine, Number, Pointer, Poly, Subject, as_unknown
from symbolic import Path, require

TRANSFORM, VERTEX, CLIP = "geometry/transform.c", "geometry/vertex.c", "geometry/clip.c"
I32 = (-(2**31), 2**31 - 1)


def constant_of(machine: Machine, name: str) -> int:
    return machine.constant(machine.unit.constants[name])


# --- position to clip space -------------------------------------------------------------------------------------------


def row_of(machine: Machine, core: str, shift: int) -> tuple[dict[str, Any], list[Poly], Poly]:
    """The members of a row and of its transform, the elements that they stand for, and the offset."""
    path = machine.path
    if core != ARMV6M:
        elements, offset = [path.atom(f"row{i}", *I32) for i in range(3)], path.atom("offset", -(2**62) + 1, 2**62 - 1)
        return {"shift": shift, "offset": offset, "elements": elements}, elements, offset
    split = min(shift, 15)
    half = 1 << (split - 1)
    high = [path.atom(f"high{i}", -(2**31 >> split), 2**31 >> split) for i in range(3)]
    low = [path.atom(f"low{i}", -half, half) for i in range(3)]
    whole = path.atom("whole", -(2**62 >> shift), 2**62 >> shift)
    rest_high = path.atom("rest_high", 0, (1 << (shift - split)) - 1)
    rest_low = path.atom("rest_low", 0, (1 << split) - 1)
    up = 1 << (15 - split)
    members = {"split": split, "over": shift - split, "high": high, "low": [each * up for each in low]}
    members |= {"whole": whole - path.floor(whole, 2**32) * 2**32, "rest_high": rest_high, "rest_low": rest_low * up}
    offset = whole * (1 << shift) + rest_high * (1 << split) + rest_low
    return members, [h * (1 << split) + lo for h, lo in zip(high, low, strict=True)], offset


def form_domain(core: str) -> Any:
    """|offset| < 2^62, rows as el_transform_set_rows has them, positions of 16 bits, a shift of 1..31.

    The sum is within 32 bits after it.
    """

    def domain(machine: Machine) -> list[Any]:
        path = machine.path
        shift = path.choose(path.atom("shift", 1, 31))
        members, row, offset = row_of(machine, core, shift)
        most = constant_of(machine, "EL_ROW_MOST")
        for signs in itertools.product((1, -1), repeat=3):
            path.assume(most - contracts.weighted(signs, row))
        position = [path.atom(f"p{i}", -(2**15), 2**15 - 1) for i in range(3)]
        if core == ARMV6M and shift > 15 and row[0].constant is None:
            bound_upper_sum(machine, members["high"], position)
        total = contracts.weighted(row, position) + offset
        path.assume(total + 2 ** (31 + shift))
        path.assume(2 ** (31 + shift) - 1 - total)
        TOTALS[id(path)] = (total, 1 << shift)
        transform = machine.struct("el_transform")
        of_row = transform.content["rows"].content[0].content
        for name, value in members.items():
            machine.put((of_row if name in of_row else transform.content)[name], value)
        place = machine.struct("el_place", x=position[0], y=position[1], z=position[2])
        known = shift <= 15 if core == ARMV6M else shift == constant_of(machine, "EL_ROW_SHIFT")
        plain = known and path.choose(path.atom("plain", 0, 1))
        return [Pointer([transform]), machine.exactly("uint32_t", 0), place, machine.exactly("_Bool", int(plain))]

    return domain


def bound_upper_sum(machine: Machine, high: list[Poly], position: list[Poly]) -> None:
    """|high| 2^15 is at most 2^14 more than the element's magnitude, so these add up to 3 * 2^14 more; and times a
    position it is at most 2^15 times as much."""
    path = machine.path
    magnitudes = Poly.of(0)
    for i, (h, p) in enumerate(zip(high, position, strict=True)):
        magnitude = path.atom(f"|high{i}|", 0, 2**16)
        for bound in (magnitude - h, magnitude + h, magnitude * 2**15 - h * p, magnitude * 2**15 + h * p):
            path.assume(bound)
        magnitudes += magnitude
    path.assume(constant_of(machine, "EL_ROW_MOST") + 3 * 2**14 - magnitudes * 2**15)


TOTALS: dict[int, tuple[Poly, int]] = {}


def form_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    """floor(sum / 2^shift)."""
    total, unit = TOTALS.pop(id(machine.path))
    rest = total - result.poly * unit
    machine.path.prove(rest, "not above the sum")
    machine.path.prove(unit - 1 - rest, "not below it")


def form(core: str) -> Subject:
    return Subject(VERTEX, "form_value", form_domain(core), form_check, ["form_value"], core=core)


def rows_domain(machine: Machine) -> list[Any]:
    """One row's elements and offset; the others are 0."""
    path = machine.path
    row = [path.atom("element", -(2**30), 2**30), Poly.of(0), Poly.of(0)]
    offset = path.atom("offset", -(2**62) + 1, 2**62 - 1)
    shift = path.choose(path.atom("shift", 1, 31))
    rows = [machine.array("int32_t", each).cells for each in (row, [0] * 3, [0] * 3)]
    of = ArrayType(machine.type_named("int32_t"), 3)
    transform = machine.struct("el_transform")
    numbers = machine.array("int64_t", [offset, 0, 0]), machine.exactly("unsigned", shift)
    return [Pointer([transform]), Pointer([Cell(of, cells) for cells in rows]), *numbers]


def rows_check(machine: Machine, arguments: list[Any], _: Any) -> None:
    """The row is what el_row's comment says."""
    transform, path = arguments[0].cell, machine.path
    element, offset = machine.poly(arguments[1].cells[0].content[0]), machine.poly(arguments[2].cells[0])
    split, over = machine.poly(transform, "split").known, machine.poly(transform, "over").known
    require(split == min(arguments[3].poly.known, 15) and split + over == arguments[3].poly.known, "where it is split")
    row = transform.content["rows"].content[0]
    high, low = machine.poly(row, "high", 0), machine.poly(row, "low", 0)
    up = 1 << (15 - split)
    path.prove((element - high * (1 << split)) * up - low, "the element", zero=True)
    path.prove(2**14 - low, "low is short")
    path.prove(2**14 + low, "low is short")
    rest = machine.poly(row, "rest_high") * 2**15 + machine.poly(row, "rest_low")
    path.prove(2**15 - 1 - machine.poly(row, "rest_low"), "the lower rest is short")
    turns = path.floor(offset, 1 << split + over + 32)
    whole = machine.poly(row, "whole") + turns * 2**32
    path.prove((offset - whole * (1 << split + over)) * up - rest, "the offset, modulo 2^32 of the whole", zero=True)


FORM = {"form_value": form(""), "form_value, armv6m": form(ARMV6M), "form_value, small": form(SMALL_CODE)}
ROWS = Subject(VERTEX, "el_transform_set_rows", rows_domain, rows_check, core=ARMV6M)


def raised_check(machine: Machine, arguments: list[Any], _: Any) -> None:
    """All of the row is moved up alike, to the shift that is known, or not at all; the offset modulo 2^64."""
    transform, path = arguments[0].cell, machine.path
    element, offset = machine.poly(arguments[1].cells[0].content[0]), machine.poly(arguments[2].cells[0])
    raised, shift = machine.poly(transform, "raise").known, machine.poly(transform, "shift").known
    require(shift == arguments[3].poly.known + raised, "the shift")
    require(raised == 0 or shift == constant_of(machine, "EL_ROW_SHIFT"), "up to what is known")
    row = transform.content["rows"].content[0]
    path.prove(machine.poly(row, "elements", 0) - element * (1 << raised), "the element", zero=True)
    turns = path.floor(offset * (1 << raised) + 2**63, 2**64)
    path.prove(machine.poly(row, "offset") - offset * (1 << raised) + turns * 2**64, "the offset", zero=True)


RAISED = Subject(VERTEX, "el_transform_set_rows", rows_domain, raised_check, ["el_transform_set_rows"])

# --- where it lies ----------------------------------------------------------------------------------------------------


def transform_of(machine: Machine, shift: int | None = None, **fields: Any) -> Any:
    """A transform with guard shifts as el_view_make chooses them; x and y are treated alike: one shift serves both."""
    path = machine.path
    transform = machine.struct("el_transform", **fields)
    shift = path.choose(path.atom("guard_shift", 0, 11)) if shift is None else shift
    machine.put(transform.content["guard_shift"], [shift, shift])
    return transform


def two_guard_shifts(machine: Machine, transform: Any) -> Any:
    """The same with shifts that differ, whatever they are: 0..11 for x, and what it lacks of 11 for y."""
    shift = machine.poly(transform, "guard_shift", 0).known
    machine.put(transform.content["guard_shift"], [shift, 11 - shift])
    return transform


def clip_vertex(machine: Machine, name: str = "", least_w: int = I32[0]) -> Any:
    values = {axis: machine.path.atom(name + axis, *I32) for axis in "xyd"}
    return machine.struct("el_clip_vertex", **values, w=machine.path.atom(f"{name}w", least_w, I32[1]))


def side_of(machine: Machine, transform: Any, vertex: Any, axis: int) -> Poly:
    """Where the guard band of x (0) or y (1) ends: w << guard_shift."""
    return machine.poly(vertex, "w") * (1 << machine.poly(transform, "guard_shift", axis).known)


def outcode_domain(machine: Machine) -> list[Any]:
    near, far = machine.path.atom("near", 1, 2**30 - 1), machine.path.atom("far", 1, 2**31 - 1)
    transform = transform_of(machine, near=near, far=far)
    return [Pointer([transform]), Pointer([clip_vertex(machine)])]


def outcode_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    """Without a bit of EL_CODE_CLIP: near <= d <= far, and |x|, |y| <= w << guard_shift."""
    path = machine.path
    if result.poly.known & constant_of(machine, "EL_CODE_CLIP"):
        return
    transform, vertex = arguments[0].cell, arguments[1].cell
    x, y, d = (machine.poly(vertex, axis) for axis in "xyd")
    path.prove(d - machine.poly(transform, "near"), "d >= near")
    path.prove(machine.poly(transform, "far") - d, "d <= far")
    for i, coordinate in enumerate((x, y)):
        limit = side_of(machine, transform, vertex, i)
        path.prove(limit - coordinate, "x, y <= w << guard_shift")
        path.prove(limit + coordinate, "x, y >= -w << guard_shift")


OUTCODE = Subject(VERTEX, "el_outcode", outcode_domain, outcode_check)

# --- onto the screen --------------------------------------------------------------------------------------------------


def guard_shift_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    size, shift = arguments[0].poly.known, result.poly.known
    require(
        size * (1 + (1 << shift)) <= 2 * 2040 and shift <= 11, "half a screen and the guard band are within 2040 px"
    )


def snap_domain(machine: Machine) -> list[Any]:
    """Sizes that belong to a guard shift g: size (1 + 2^g) <= 2 * 2040."""
    path = machine.path
    g = path.choose(path.atom("guard_shift", 0, 11))
    size = path.atom("size", 1, 4080 // (1 + (1 << g)))
    w, c = path.atom("w", 1, 2**31 - 1), path.atom("c", *I32)
    path.assume(w * (1 << g) - c)
    path.assume(w * (1 << g) + c)
    if w.constant is None:
        # |c| <= w << g, times half the size.
        path.assume_product(w * (1 << g) - c, size)
        path.assume_product(w * (1 << g) + c, size)
        most = 4080 // (1 + (1 << g))
        path.assume_product(most - size, w)
        divisor = contracts.divisor_make(machine, [machine.exactly("uint32_t", w)])
    else:
        divisor = machine.call("el_divisor_make", machine.exactly("uint32_t", w))
    numbers = machine.exactly("int64_t", c), machine.exactly("uint16_t", size), machine.exactly("uint32_t", w)
    return [*numbers, Pointer([divisor])]


def snap_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    """Within the guard band, and nearest to size / 2 (1 + c / w), ties up."""
    path = machine.path
    guard = constant_of(machine, "EL_GUARD_SUB")
    c, size, w = (argument.poly for argument in arguments[:3])
    half = size * (guard // 2040 // 2)
    path.prove(result.poly + guard, "x >= -EL_GUARD_SUB")
    path.prove(guard - result.poly, "x <= EL_GUARD_SUB")
    error = c * half + path.floor(w, 2) - (result.poly - half) * w
    path.prove(error, "not above the nearest")
    path.prove(w - 1 - error, "not below the nearest")


SNAP = Subject(
    VERTEX,
    "snap",
    snap_domain,
    snap_check,
    modular=["el_reciprocal_word", "el_divide_words"],
    contracts=contracts.DIVISION,
)


def project_domain(orthographic: bool) -> Any:
    def domain(machine: Machine) -> list[Any]:
        path = machine.path
        near, w = path.atom("near", 1, 2**30 - 1), path.atom("w", 1, 2**31 - 1)
        # far >= 9/8 near: far / (far - near) <= 9.
        scale = path.atom("depth_scale", 1, 2**32 - 1 if orthographic else 65534 * 9 << 12)
        near_q32 = path.atom("near_q32", 1, 2**62)
        path.assume(near * 2**32 - near_q32)
        d = path.atom("d", 1, 2**31 - 1)
        path.assume(d - near)
        transform = machine.struct(
            "el_transform", near=near, near_q32=near_q32, depth_scale=scale, orthographic=int(orthographic)
        )
        machine.put(
            transform.content["depth_shift"], path.choose(path.atom("depth_shift", 0, 63)) if orthographic else 12
        )
        machine.put(transform.content["size"], [1, 1])
        x, y = path.atom("x", *I32), path.atom("y", *I32)
        vertex = machine.struct("el_clip_vertex", x=x, y=y, d=d, w=w)
        return [Pointer([transform]), Pointer([vertex]), Pointer([machine.struct("el_screen_vertex")])]

    return domain


def project_check(machine: Machine, arguments: list[Any], _: Any) -> None:
    screen = arguments[2].cell
    path = machine.path
    path.prove(65534 - machine.poly(screen, "z"), "z <= EL_DEPTH_MAX")
    path.prove(machine.poly(screen, "w") - 2**15, "1/w is normalised")
    path.prove(31 - machine.poly(screen, "w_shift"), "w_shift fits 5 bits")


def snapped(machine: Machine, arguments: list[Any]) -> Number:
    """snap, proven above."""
    guard = constant_of(machine, "EL_GUARD_SUB")
    return machine.number("int32_t", "snapped", -guard, guard)


def project(orthographic: bool) -> Subject:
    return Subject(
        VERTEX,
        "el_project",
        project_domain(orthographic),
        project_check,
        contracts={**contracts.DIVISION, "snap": snapped},
        lemmas={"depth_of.distance": lambda machine, distance: as_unknown(machine, distance, 0, 2**31 - 1)},
    )


# --- clipping ---------------------------------------------------------------------------------------------------------


def mix_domain(machine: Machine) -> list[Any]:
    path = machine.path
    a, b, t = path.atom("from", *I32), path.atom("to", *I32), path.atom("t", 0, 2**31)
    if a.constant is None and path.decide(b - a, a - b - 1):
        path.assume_product(b - a, t)
        path.assume_product(b - a, 2**31 - t)
    elif a.constant is None:
        path.assume_product(a - b, t)
        path.assume_product(a - b, 2**31 - t)
    return [machine.exactly("int32_t", a), machine.exactly("int32_t", b), machine.exactly("int64_t", t)]


def mix_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    path = machine.path
    a, b, t = (argument.poly for argument in arguments)
    low, high = (a, b) if path.decide(b - a, a - b - 1) else (b, a)
    path.prove(result.poly - low, "not below both ends")
    path.prove(high - result.poly, "not above both ends")
    error = a * 2**32 + (b - a) * t * 2 + 2**31 - result.poly * 2**32
    path.prove(error, "not above the nearest")
    path.prove(2**32 - 1 - error, "not below the nearest")


MIX = Subject(CLIP, "mix", mix_domain, mix_check)


def inside_domain(machine: Machine) -> list[Any]:
    path = machine.path
    transform = transform_of(machine, near=path.atom("near", 1, 2**30 - 1), far=path.atom("far", 1, 2**31 - 1))
    transform = two_guard_shifts(machine, transform)
    plane = machine.exactly("uint32_t", path.choose(path.atom("plane", 0, 5)))
    return [Pointer([transform]), Pointer([clip_vertex(machine)]), plane]


MOST_INSIDE = 2**42 + 2**31


def inside_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    """near <= d <= far, -w << guard_shift <= x, y <= w << guard_shift: what is left to the plane."""
    transform, vertex, plane = arguments[0].cell, arguments[1].cell, arguments[2].poly.known
    x, y, d = (machine.poly(vertex, axis) for axis in "xyd")
    x_side, y_side = (side_of(machine, transform, vertex, axis) for axis in (0, 1))
    near, far = machine.poly(transform, "near"), machine.poly(transform, "far")
    distance = (d - near, far - d, x + x_side, x_side - x, y + y_side, y_side - y)[plane]
    require((result.poly - distance).constant == 0, "the distance to the plane")
    require(machine.path.within(result.poly, -MOST_INSIDE, MOST_INSIDE), "|inside| <= 2^42 + 2^31")


INSIDE = Subject(CLIP, "inside", inside_domain, inside_check)


# A coordinate of a mesh within its sphere is below 2^30; each cut at a side plane can add SIDE_ERROR (see below).
SIDE_ERROR = 5 << 10
MOST_COORDINATE = 2**30 + 4 * SIDE_ERROR


def cut_domain(machine: Machine) -> list[Any]:
    """Two corners, the first inside and the second outside of a plane.

    t depends on the two distances only, and the new coordinate on a side plane's guard shift only: all distances with
    near and far and the largest shift, all shifts with the side planes and one distance.
    """
    path = machine.path
    plane = path.choose(path.atom("plane", 0, 5))
    near, far = path.atom("near", 1, 2**30 - 1), path.atom("far", 1, 2**31 - 1)
    transform = transform_of(machine, 11 if plane < 2 else None, near=near, far=far)
    machine.put(transform.content["orthographic"], path.choose(path.atom("orthographic", 0, 1)))
    guard = 1 << machine.poly(transform, "guard_shift", 0).known
    # Orthographic: w << guard_shift is below |x| or |y| of the corner outside.
    machine.put(transform.content["constant_w"], path.atom("constant_w", 1, MOST_COORDINATE // guard))
    da, db = Poly.of(1), Poly.of(-1)
    if plane < 2:
        da, db = path.atom("da", 0, MOST_INSIDE), path.atom("db", -MOST_INSIDE, -1)
    corners = []
    for name in "ab":
        corner = machine.struct("el_clip_corner")
        machine.put(corner.content["position"], clip_vertex(machine, name))
        machine.put(corner.content["attributes"], [path.atom(f"{name}{i}", -(2**30), 2**30) for i in range(5)])
        corners.append(Pointer([corner]))
    numbers = machine.exactly("int64_t", da), machine.exactly("int64_t", db)
    new = Pointer([machine.struct("el_clip_corner")])
    which = machine.exactly("uint32_t", plane)
    return [Pointer([transform]), corners[0], numbers[0], corners[1], numbers[1], which, new]


def cut_check(machine: Machine, arguments: list[Any], _: Any) -> None:
    """t is the exact 2^31 da / (da - db) with an error in (-2, 1], and the new corner is on the plane exactly."""
    path = machine.path
    position = Pointer([arguments[6].cell.content["position"]])
    distance = machine.call("inside", arguments[0], position, arguments[5])
    path.prove(distance.poly, "the new corner is on the plane", zero=True)
    t = machine.locals["cut.t_q31"].poly
    shift = 1 << machine.locals["cut.shift"].poly.known
    da, db = arguments[2].poly, arguments[4].poly
    whole = da - db
    upper = path.floor(whole, shift)
    cut_off = whole - upper * shift
    path.prove(2**31 - t, "t <= 1")
    path.assume(2**31 - t)
    path.assume_product(t, cut_off)
    path.assume_product(t, shift - 1 - cut_off)
    path.prove((t + 2) * whole - da * 2**31 - 1, "t > T - 2")
    path.prove(da * 2**31 - (t - 1) * whole, "t <= T + 1")


def mixed(machine: Machine, arguments: list[Any]) -> Number:
    """mix, proven above: between its ends for t in [0, 1]. At a side plane, d is as test_a_side_plane has it."""
    a, b, t = (argument.poly for argument in arguments)
    path = machine.path
    path.prove(t, "t >= 0")
    path.prove(2**31 - t, "t <= 1")
    low = min(path.bounds(a)[0], path.bounds(b)[0])
    high = max(path.bounds(a)[1], path.bounds(b)[1])
    if machine.scopes[0]["plane"].content.poly.known >= 2:
        guard = 1 << machine.poly(machine.scopes[0]["transform"].content.cell, "guard_shift", 0).known
        low, high = -(MOST_COORDINATE // guard), MOST_COORDINATE // guard
    return machine.number("int32_t", "mixed", low, high)


CUT = Subject(CLIP, "cut", cut_domain, cut_check, contracts={**contracts.DIVISION, "mix": mixed})


def prove_side_plane(error: int) -> None:
    """w << g of a new corner at the plane x = w << g stays within `error` of the largest |x|, for g <= 11.

    With G = 2^g, da = G wa - xa and T = 2^31 da / (da - db), the exact crossing has G (2^31 wa + (wb - wa) T) =
    2^31 xa + (xb - xa) T, between 2^31 xa and 2^31 xb. The code takes t = T + e, e in [-2, 1], and rounds by 2^30.
    """
    path = Path([])
    wide = 2**30
    xa, xb = path.atom("xa", -wide, wide), path.atom("xb", -wide, wide)
    wa, wb = path.atom("wa", -wide, wide), path.atom("wb", -wide, wide)
    whole_t, e, rounding = path.atom("T", 0, 2**31), path.atom("e", -2, 1), path.atom("rounding", -(2**30), 2**30)
    guard = 2**11
    # The identity: da 2^31 + (db - da) T = 0 makes the two sides equal.
    da, db = wa * guard - xa, wb * guard - xb
    difference = (wa * 2**31 + (wb - wa) * whole_t) * guard - (xa * 2**31 + (xb - xa) * whole_t)
    require((difference - (da * 2**31 + (db - da) * whole_t)).constant == 0, "the crossing is on the plane")
    change = path.atom("wb - wa", -2 * wide, 2 * wide)
    moved = (change * e + rounding) * guard
    path.prove(error * 2**31 - moved, "w << g grows by less")
    path.prove(error * 2**31 + moved, "w << g falls by less")
    for x in (xa, xb):
        path.prove(wide - x, "between xa and xb")


def put_back_domain(machine: Machine) -> list[Any]:
    """What the planes have left: three corners, one of them anywhere with w >= 1. Each is put back by itself.

    The places behind them are not the function's: they keep what the corners were.
    """
    path = machine.path
    transform = two_guard_shifts(machine, transform_of(machine))
    corners = [machine.struct("el_clip_corner") for _ in range(constant_of(machine, "EL_CLIP_MAX_VERTICES"))]
    anywhere = path.choose(path.atom("corner", 0, 2))
    for i in range(3):
        middle = machine.struct("el_clip_vertex", x=0, y=0, d=1, w=1)
        vertex = clip_vertex(machine, least_w=1) if i == anywhere else middle
        for place in (i, i + 3):
            machine.put(corners[place].content["position"], vertex)
    return [Pointer([transform]), Pointer(corners), machine.exactly("uint32_t", 3), machine.exactly("uint8_t", 0)]


def put_back_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    """|x|, |y| <= w << guard_shift; what was is what is, or was beyond the limit that it is on now."""
    path = machine.path
    transform, corners = arguments[0].cell, arguments[1].cells
    require(result.poly.known == 3, "all corners are left")
    for new, old in ((corners[i].content["position"], corners[i + 3].content["position"]) for i in range(3)):
        for axis in "dw":
            require((machine.poly(new, axis) - machine.poly(old, axis)).constant == 0, f"{axis} stays")
        for i, axis in enumerate("xy"):
            is_, was, side = machine.poly(new, axis), machine.poly(old, axis), side_of(machine, transform, new, i)
            path.prove(side - is_, f"{axis} <= w << guard_shift")
            path.prove(side + is_, f"{axis} >= -w << guard_shift")
            if (is_ - was).constant != 0:
                upper = (is_ - side).constant == 0
                require(upper or (is_ + side).constant == 0, f"{axis} is on a limit")
                path.prove(was - side if upper else -side - was, f"{axis} was beyond it")


# With no plane to cut at, what is left of the function is what it does to the corners after the cuts.
PUT_BACK = Subject(CLIP, "el_clip_polygon", put_back_domain, put_back_check)


SUBJECTS = {
    **FORM,
    "rows": RAISED,
    "rows, armv6m": ROWS,
    "outcode": OUTCODE,
    "snap": SNAP,
    "project, perspective": project(False),
    "project, orthographic": project(True),
    "mix": MIX,
    "inside": INSIDE,
    "cut": CUT,
    "put back": PUT_BACK,
}


@pytest.mark.parametrize("name", SUBJECTS)
def test_all_values(name: str) -> None:
    SUBJECTS[name].prove()


@pytest.mark.parametrize("bits", [6, 8])
def test_snapping_with_more_bits(bits: int) -> None:
    SNAP.prove(bits)


def test_the_guard_band_of_every_size() -> None:
    def subject(size: int) -> Subject:
        return Subject(TRANSFORM, "guard_shift", lambda m: [m.exactly("uint16_t", size)], guard_shift_check)

    for size in range(1, 2041):
        subject(size).prove()


def test_a_side_plane() -> None:
    prove_side_plane(SIDE_ERROR)
    with pytest.raises(AssertionError):
        prove_side_plane(SIDE_ERROR - 1)


@EVERY_PRECISION
@pytest.mark.parametrize(
    "name",
    ["form_value", "form_value, armv6m", "outcode", "snap", "mix", "inside", "put back"],
)
def test_the_compiler_agrees(name: str, bits: int) -> None:
    subject = SUBJECTS[name]
    Subject(subject.file, subject.function, subject.domain, modular=subject.modular, core=subject.core).agree(bits, 100)


@pytest.mark.parametrize(
    ("name", "file", "old", "new"),
    [
        ("form_value", VERTEX, "(uint32_t)sum >> shift)", "(uint32_t)(sum + 1U) >> shift)"),
        ("form_value", VERTEX, "(32U - shift)", "(31U - shift)"),
        ("form_value", VERTEX, "plain ? (unsigned)EL_ROW_SHIFT", "!plain ? (unsigned)EL_ROW_SHIFT"),
        ("form_value, small", VERTEX, "(uint32_t)sum >> transform->shift", "(uint32_t)(sum + 1U) >> transform->shift"),
        ("rows", VERTEX, "all >> (31U - missing)", "all >> (32U - missing)"),
        ("rows", VERTEX, "elements[i][j] * (1 << raise)", "elements[i][j] * (1 << (raise / 2U))"),
        ("form_value, armv6m", VERTEX, "(uint32_t)(low >> EL_ROW_SHIFT)", "((uint32_t)low >> EL_ROW_SHIFT)"),
        ("form_value, armv6m", VERTEX, "plain ? row->whole :", "!plain ? row->whole :"),
        ("form_value, armv6m", "geometry/transform.h", "EL_ROW_MOST = 0x70000000", "EL_ROW_MOST = 0x7FFFFFFF"),
        ("rows, armv6m", VERTEX, "shift < EL_ROW_SHIFT ? shift", "shift < EL_ROW_SHIFT ? shift - 1U"),
        ("rows, armv6m", VERTEX, "(1 << (split - 1U))) >> split", "(1 << (split - 1U)) + 1) >> split"),
        ("rows, armv6m", VERTEX, "offsets[i], shift) >> split", "offsets[i], shift - 1U) >> split"),
        ("outcode", VERTEX, "vertex->d < transform->near ?", "vertex->d < transform->near - 1 ?"),
        ("snap", VERTEX, "c * half + (w >> 1)", "c * half + (w >> 1) + 1"),
        ("project, perspective", VERTEX, "rest > 0x7FFFU ? 0x7FFFU", "rest > 0x8000U ? 0x8000U"),
        ("project, orthographic", VERTEX, "z > EL_DEPTH_MAX ? EL_DEPTH_MAX", "z > EL_DEPTH_MAX + 1 ? EL_DEPTH_MAX"),
        ("mix", CLIP, "+ (1LL << 30)) >> 31", "+ (1LL << 30) + 1) >> 31"),
        ("inside", CLIP, "side = (int64_t)v->w * (1", "side = v->w * (1"),
        ("inside", CLIP, "plane / 2 - 1]", "plane / 3]"),
        ("inside", CLIP, "plane < 4 ? &v->x", "plane < 3 ? &v->x"),
        ("inside", CLIP, "return (plane & 1U) == 0 ? -side : side", "return (plane & 1U) == 0 ? side : -side"),
        ("cut", CLIP, "el_bit_length_u64(whole) - 32", "el_bit_length_u64(whole) - 34"),
        ("cut", CLIP, "if (plane > PLANE_FAR) {", "if (plane > PLANE_FAR + 1) {"),
        ("cut", CLIP, "position.w = 0;\n    if (plane <= PLANE_FAR)", "position.w = 0;\n    if (plane < PLANE_FAR)"),
        ("put back", CLIP, ".position, plane) < 0)", ".position, plane) < -1)"),
        ("put back", CLIP, ".position, plane) < 0)", ".position, plane) <= 1)"),
        ("put back", CLIP, "plane = PLANE_FAR + 1;", "plane = PLANE_FAR + 2;"),
    ],
)
def test_the_proof_can_fail(name: str, file: str, old: str, new: str) -> None:
    SUBJECTS[name].fails_with(Fault(file, old, new))
