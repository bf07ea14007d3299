"""raster/sampled and raster/wires: what they ask of edges, which are exact where their precondition holds.

A sample lies inside a triangle where the pixel's centre lies inside the triangle that is moved the other way: the edges
that are made of it are those of corners less the sample's place, from the first row on that has a centre below them and
for as long as each has rows. So a sample's coverage is the edge rule at its position.

A wire's edge is the same from either end: what is drawn of it is asked for with the same numbers. Its pixels and depths
are those of their column or row, wherever the target begins: the edge is exact from any row on, and depth is a product.
"""

from __future__ import annotations

from typing import Any

import pytest

from proof import EVERY_PRECISION, Fault, Machine, Number, Pointer, Poly, Subject, as_unknown
from symbolic import Path, require

SAMPLED, WIRES = "raster/sampled.c", "raster/wires.c"
WORD = 1 << 32


def subpixels(machine: Machine) -> int:
    return machine.constant(machine.unit.constants["EL_GUARD_SUB"]) // 2040


def first_centre(path: Path, a: Poly, s: int) -> Poly:
    return path.floor(a + s // 2 - 1, s)


class Edges:
    """The contract of el_edge_make, and what it was asked for."""

    def __init__(self) -> None:
        self.made: list[tuple[Any, list[Poly]]] = []

    def make(self, machine: Machine, arguments: list[Any]) -> None:
        edge, *numbers = arguments
        x0, y0, x1, y1, row = (number.poly for number in numbers)
        path, s = machine.path, subpixels(machine)
        reach = s * 2040 + s // 2
        for place in (x0, y0, x1, y1):
            require(path.within(place, -reach, reach), "an edge's ends are moved by half a pixel at most")
        for way in (x1 - x0, y1 - y0):
            require(path.within(way, -2 * 2040 * s, 2 * 2040 * s), "and both alike")
        path.prove(y1 - y0 - 1, "it goes down")
        path.prove(row - first_centre(path, y0, s), "the row is not above it")
        path.prove(first_centre(path, y1, s) - 1 - row, "nor below it")
        machine.put(edge.cell.content["x_q32"], path.atom("x_q32", -(2**43), 2**43))
        machine.put(edge.cell.content["step_q32"], path.atom("step_q32", -(2**44), 2**44))
        self.made.append((edge.cell, [x0, y0, x1, y1, row]))


def any_corners(machine: Machine) -> list[Any]:
    """Three, from the top down."""
    path, guard = machine.path, subpixels(machine) * 2040
    x = [path.atom(f"x{i}", -guard, guard) for i in range(3)]
    y = [path.atom(f"y{i}", -guard, guard) for i in range(3)]
    path.assume(y[1] - y[0])
    path.assume(y[2] - y[1])
    return [machine.struct("el_corner", x=x[i], y=y[i]) for i in range(3)]


# --- samples ----------------------------------------------------------------------------------------------------------


def sample_edges(short_is_left: bool) -> Subject:
    edges = Edges()

    def domain(machine: Machine) -> list[Any]:
        edges.made.clear()
        path, s = machine.path, subpixels(machine)
        corners = any_corners(machine)
        reach = s * 7 // 16
        point = machine.struct("el_sample_point", x=path.atom("x", -reach, reach), y=path.atom("y", -reach, reach))
        return [
            Pointer([machine.struct("sample_edges")]),
            pointers(machine, corners),
            Pointer([point]),
            machine.number("int32_t", "row", -2041, 2041),
            machine.boolean(short_is_left),
        ]

    def check(machine: Machine, arguments: list[Any], _: Any) -> None:
        path, s = machine.path, subpixels(machine)
        made, corners, point, row = arguments[0].cell, arguments[1], arguments[2].cell, arguments[3].poly
        sample = [machine.poly(point, axis) for axis in "xy"]
        places = [
            [machine.poly(corner.content.cell, axis) - at for axis, at in zip("xy", sample, strict=True)]
            for corner in corners.cells
        ]
        rows = [first_centre(path, y, s) for _, y in places]
        begin, middle, end = (machine.poly(made, name) for name in ("y", "y_middle", "y_end"))
        path.prove(middle - rows[1], "the middle", zero=True)
        path.prove(end - rows[2], "the end", zero=True)
        above = path.holds(rows[0] - row)
        path.prove(begin - (rows[0] if above else row), "the begin", zero=True)
        if path.holds(begin - end):
            require(not edges.made, "no rows, no edges")
            return
        straight, bent = ("right", "left") if short_is_left else ("left", "right")
        wanted = {straight: (0, 2, begin)}
        has_upper = path.holds(middle - 1 - begin)
        if has_upper:
            wanted[bent] = (0, 1, begin)
        if path.holds(end - 1 - middle):
            wanted["lower" if has_upper else bent] = (1, 2, middle if path.holds(middle - begin) else begin)
        asked = {name: numbers for name in wanted for cell, numbers in edges.made if cell is made.content[name]}
        require(len(asked) == len(wanted) == len(edges.made), "an edge for each")
        for name, (a, b, at) in wanted.items():
            for number, exact in zip(asked[name], (*places[a], *places[b], at), strict=True):
                path.prove(number - exact, f"{name}: corners less the sample's place, from its first row", zero=True)

    return Subject(SAMPLED, "make_edges", domain, check, contracts={"el_edge_make": edges.make})


def pointers(machine: Machine, cells: list[Any]) -> Pointer:
    """An array of pointers to them."""
    found = machine.allocate(machine.type_of(machine.unit.functions["make_edges"].decl.type.args.params[1].type))
    for place, cell in zip(found.content, cells, strict=True):
        place.content = Pointer([cell])
    return Pointer(found.content)


@EVERY_PRECISION
@pytest.mark.parametrize("short_is_left", [False, True])
def test_a_sample_has_the_moved_triangles_edges(bits: int, short_is_left: bool) -> None:
    sample_edges(short_is_left).prove(bits)


@pytest.mark.parametrize(
    ("short_is_left", "old", "new"),
    [
        (False, "corners[i]->x - point->x", "corners[i]->x + point->x"),
        (False, "el_max_i32(row, el_first_centre(y[0]))", "el_max_i32(row, el_first_centre(corners[0]->y))"),
        (True, "short_is_left ? &e->right : &e->left", "short_is_left ? &e->left : &e->left"),
        (False, "if (y_begin < y_middle) {", "if (y_begin <= y_middle) {"),
        (True, "y[2], el_max_i32(y_begin, y_middle));", "y[2], y_begin);"),
        (False, "const int32_t y_end = el_first_centre(y[2]);", "const int32_t y_end = el_first_centre(y[2] + 1);"),
    ],
)
def test_the_proof_of_samples_can_fail(short_is_left: bool, old: str, new: str) -> None:
    sample_edges(short_is_left).fails_with(Fault(SAMPLED, old, new))


# --- wires ------------------------------------------------------------------------------------------------------------


class Calls:
    """The contracts of draw_end and draw_run: with which numbers they are called."""

    def __init__(self) -> None:
        self.made: list[tuple[str, list[Poly]]] = []

    def end(self, machine: Machine, arguments: list[Any]) -> None:
        _, at, steep, first, last = arguments
        self.made.append(("end", [*self.place(machine, at), steep.poly, first.poly, last.poly]))

    def run(self, machine: Machine, arguments: list[Any]) -> None:
        _, start, to, steep, first, last = arguments
        ends = [*self.place(machine, start), *self.place(machine, to)]
        self.made.append(("run", [*ends, steep.poly, first.poly, last.poly]))

    @staticmethod
    def place(machine: Machine, at: Pointer) -> list[Poly]:
        return [machine.poly(at.cell, name) for name in ("along", "across", "z")]


def any_pen(machine: Machine) -> Pointer:
    """Rows [top, bottom) of the screen, all of them or every other one."""
    path = machine.path
    top, bottom = path.atom("top", 0, 2039), path.atom("bottom", 1, 2040)
    path.assume(bottom - top - 1)
    width = path.atom("width", 1, 2040)
    target = machine.struct("el_target", width=width)
    return Pointer([machine.struct("pen", top=top, bottom=bottom, target=Pointer([target]))])


def any_ends(machine: Machine) -> list[Any]:
    path, guard = machine.path, subpixels(machine) * 2040
    return [
        machine.struct(
            "el_corner",
            x=path.atom(f"x{i}", -guard, guard),
            y=path.atom(f"y{i}", -guard, guard),
            z=path.atom(f"z{i}", 0, 65534),
        )
        for i in range(2)
    ]


def either_way() -> Subject:
    calls = Calls()

    def domain(machine: Machine) -> list[Any]:
        calls.made.clear()
        return [any_pen(machine), *(Pointer([corner]) for corner in any_ends(machine))]

    def check(machine: Machine, arguments: list[Any], _: Any) -> None:
        path, (pen, a, b) = machine.path, arguments
        forward, calls.made = calls.made, []
        machine.call("draw_edge", pen, b, a)
        require(len(forward) == len(calls.made), "as much is drawn")
        if not forward:
            return
        backward = calls.made
        is_point = all(path.holds(d) and path.holds(-d) for d in difference(machine, a, b))
        if is_point:
            # It has no rows, and whichever end comes first, both are drawn: the nearer one stays.
            backward = [backward[1], backward[0]]
            forward, backward = forward[:2], backward[:2]
        for (kind, numbers), (other, others) in zip(forward, backward, strict=True):
            require(kind == other, "in the same order")
            for number, same in zip(numbers, others, strict=True):
                path.prove(number - same, f"{kind}: the same from either end", zero=True)

    contracts = {"draw_end": calls.end, "draw_run": calls.run}
    return Subject(WIRES, "draw_edge", domain, check, modular=["el_abs_u64"], contracts=contracts)


def difference(machine: Machine, a: Pointer, b: Pointer) -> list[Poly]:
    return [machine.poly(a.cell, axis) - machine.poly(b.cell, axis) for axis in "xy"]


@EVERY_PRECISION
def test_a_wire_is_the_same_from_either_end(bits: int) -> None:
    either_way().prove(bits)


class Run:
    """Two rows of a wire's longer direction, or columns: `at` and the next one, if they are in the target.

    Other rows are as these: of a run nothing but its first row differs from band to band.
    """

    def __init__(self, steep: bool) -> None:
        self.steep, self.edges = steep, Edges()
        self.pixels: list[tuple[Poly, Poly, Poly]] = []  # along, across, depth
        self.ends: list[Any] = []

    def domain(self, machine: Machine) -> list[Any]:
        self.edges.made, self.pixels = [], []
        path, s = machine.path, subpixels(machine)
        guard = s * 2040
        self.ends = [
            machine.struct(
                "end",
                along=path.atom(f"along{i}", -guard, guard),
                across=path.atom(f"across{i}", -guard, guard),
                z=path.atom(f"z{i}", 0, 65534),
            )
            for i in range(2)
        ]
        at, start, end = path.atom("at", -2041, 2041), *(machine.poly(to, "along") for to in self.ends)
        path.assume(at - first_centre(path, start, s))
        path.assume(first_centre(path, end, s) - at - 2)
        numbers = [machine.boolean(self.steep), machine.exactly("int32_t", at), machine.exactly("int32_t", at + 2)]
        return [any_pen(machine), *(Pointer([to]) for to in self.ends), *numbers]

    def draw_pixel(self, machine: Machine, arguments: list[Any]) -> None:
        _, x, y, z = arguments
        along, across = (y, x) if self.steep else (x, y)
        self.pixels.append((along.poly, across.poly, z.poly))

    def ratio(self, machine: Machine, arguments: list[Any]) -> Number:
        """el_ratio_q32 of a difference of depths, which is below 2^16."""
        value, length = (argument.poly for argument in arguments)
        path = machine.path
        path.prove(length - 1, "a ratio's divisor is positive")
        ratio = path.atom("ratio", -(1 << 48), 1 << 48)
        path.assume(value * WORD - ratio * length)
        path.assume(ratio * length + length - 1 - value * WORD)
        return machine.exactly("int64_t", ratio)

    def begin(self, machine: Machine, begin: Number) -> Number:
        """How far steps lead, in both rows: from one end towards the other."""
        path, s = machine.path, subpixels(machine)
        step = machine.locals["draw_run.step_q32"].poly
        length = machine.poly(self.ends[1], "along") - machine.poly(self.ends[0], "along")
        size = step if path.decide(step, -step - 1) else -step
        path.assume_product(size, Poly.of(2 * s))
        for way in (begin.poly, begin.poly + s):
            if path.decide(length - 1 - way, way - length):
                path.assume_product(size, way)
                path.assume_product(size, length - 1 - way)
        return begin

    def check(self, machine: Machine, _: list[Any], __: Any) -> None:
        path, s = machine.path, subpixels(machine)
        if not self.pixels:
            return
        start, across, depth = (machine.poly(self.ends[0], name) for name in ("along", "across", "z"))
        end, to_across, to_depth = (machine.poly(self.ends[1], name) for name in ("along", "across", "z"))
        ((edge, asked),) = self.edges.made
        first = self.pixels[0][0]
        wanted = (across - s // 2, start, to_across - s // 2, end, first)
        for number, exact in zip(asked, wanted, strict=True):
            path.prove(number - exact, "the edge, half a pixel before, from the first row on", zero=True)
        step = machine.locals["draw_run.step_q32"].poly
        crossing = machine.poly(edge, "x_q32") - machine.poly(edge, "step_q32") * len(self.pixels)
        for i, (along, found, z) in enumerate(self.pixels):
            path.prove(along - first - i, "row by row", zero=True)
            x_q32 = crossing + machine.poly(edge, "step_q32") * i
            path.prove(found - path.floor(x_q32, WORD), "the pixel that the edge has there", zero=True)
            exact = depth * WORD + step * (along * s + s // 2 - start) + WORD // 2
            path.prove(z - path.floor(exact, WORD), "its depth is that of the row", zero=True)
            near, far = (depth, to_depth) if path.decide(to_depth - depth, depth - to_depth - 1) else (to_depth, depth)
            path.prove(z - near, "not nearer than its ends")
            path.prove(far - z, "nor farther")

    def subject(self) -> Subject:
        contracts = {
            "el_edge_make": self.edges.make,
            "draw_pixel": self.draw_pixel,
            "find_columns": lambda machine, arguments: None,  # what it leaves out is not in the target's rows
            "ratio_q32": self.ratio,
        }
        return Subject(
            WIRES, "draw_run", self.domain, self.check, contracts=contracts, lemmas={"draw_run.begin": self.begin}
        )


@EVERY_PRECISION
@pytest.mark.parametrize("steep", [False, True])
def test_a_wires_pixel_depends_on_its_row_alone(bits: int, steep: bool) -> None:
    Run(steep).subject().prove(bits)


# A wire lies on its triangle's edge, at most half a pixel from the pixel's centre on either axis. So its depth there
# and the surface's at the centre differ by A = (|dz/dx| + |dz/dy|) / 2 at most, and rounded both, by less than A + 2.


def allowance() -> Subject:
    def domain(machine: Machine) -> list[Any]:
        path, guard = machine.path, subpixels(machine) * 2040
        corners = [
            machine.struct(
                "el_corner",
                x=path.atom(f"x{i}", -guard, guard),
                y=path.atom(f"y{i}", -guard, guard),
                z=path.atom(f"z{i}", 0, 65534),
            )
            for i in range(3)
        ]
        return [Pointer(corners)]

    def area(machine: Machine, value: Number) -> Number:
        """Of no area is told apart: there the change is not less than the range's."""
        unknown = as_unknown(machine, value, 0, 2**42)
        machine.path.decide(unknown.poly - 1, -unknown.poly)
        return unknown

    def span(machine: Machine, value: Number) -> Number:
        unknown = as_unknown(machine, value, 0, 65534)
        machine.path.assume_product(65534 - unknown.poly, machine.locals["allowance_of.area"].poly)
        return unknown

    def check(machine: Machine, arguments: list[Any], result: Number) -> None:
        path, s = machine.path, subpixels(machine)
        z = [machine.poly(corner, "z") for corner in arguments[0].cells]
        nearest, farthest, change, whole, most = (
            machine.locals[f"allowance_of.{name}"].poly for name in ("nearest", "farthest", "change", "area", "range")
        )
        for depth in z:
            path.prove(depth - nearest, "the nearest")
            path.prove(farthest - depth, "the farthest")
        path.prove(most - farthest + nearest, "the range", zero=True)
        # More than half a pixel's change and both roundings, or all that there is.
        if not path.decide(result.poly - most - 1, most - result.poly):
            path.prove((result.poly - 2) * whole - change * (s // 2), "it is no less than the change and 2")
            path.prove(change * (s // 2) - (result.poly - 3) * whole - 1, "it is no more than that rounded up")
        else:
            path.prove(most + 1 - result.poly, "it is no more than the range and 1")

    lemmas = {
        "allowance_of.area": area,
        "allowance_of.change": lambda machine, value: as_unknown(machine, value, 0, 2**62),
        "allowance_of.range": span,
    }
    return Subject(
        WIRES, "allowance_of", domain, check, modular=["el_abs_u64"], contracts={"el_abs_u64": size}, lemmas=lemmas
    )


def size(machine: Machine, arguments: list[Any]) -> Number:
    """el_abs_u64 of what is above -2^63: a number of which no more is needed than that it is not less, either way."""
    value, path = arguments[0].poly, machine.path
    low, high = path.bounds(value)
    path.prove(value + 2**63 - 1, "it has a size")
    found = path.atom("size", 0, max(-low, high))
    path.assume(found - value)
    path.assume(found + value)
    return machine.exactly("uint64_t", found)


@EVERY_PRECISION
def test_a_wires_allowance_is_as_derived(bits: int) -> None:
    allowance().prove(bits)


def test_the_compiler_agrees_on_allowances() -> None:
    allowance().agree()


@pytest.mark.parametrize(
    ("subject", "old", "new"),
    [
        (either_way, "const bool turned = (steep ? dy : dx) > 0;", "const bool turned = dy > 0;"),
        (either_way, "el_abs_u64(dy) > el_abs_u64(dx)", "el_abs_u64(dy) + 1U > el_abs_u64(dx) + (dy > 0)"),
        (lambda: Run(False).subject(), "to->across - half, to->along, first);", "to->across, to->along, first);"),
        (lambda: Run(False).subject(), "begin = first * EL_SUBPIXELS", "begin = 0 * EL_SUBPIXELS"),
        (lambda: Run(True).subject(), "z_q32 += step_q32 * EL_SUBPIXELS;", "z_q32 += step_q32 * (EL_SUBPIXELS - 1);"),
        (lambda: Run(True).subject(), "+ (1LL << 31) +", "+ (3LL << 30) +"),
        (lambda: Run(True).subject(), "el_edge_next_row(&edge);\n", ""),
        (allowance, "+ 2, (int32_t)range + 1);", "+ 1, (int32_t)range + 1);"),
        (allowance, "(half_a_pixel + area - 1U) / area", "half_a_pixel / area"),
        (allowance, "return (int32_t)range + 1;", "return (int32_t)range + 3;"),
        (allowance, "if (half_a_pixel >= range * area) {", "if (half_a_pixel > range * area) {"),
    ],
)
def test_the_proof_of_wires_can_fail(subject: Any, old: str, new: str) -> None:
    subject().fails_with(Fault(WIRES, old, new))
