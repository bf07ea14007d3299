"""raster/field: two fields have each line of the screen once; in a field's line a triangle has what its row has.

Rows from y on are lines from el_field_row(y) on, so intervals of rows become intervals of lines without a case. Edges
and planes are stepped twice as far: in each line, those of the row that it is, to the last bit. Where a triangle bends
between two lines of a field, the lower edge has gone on by the row that is left out.
"""

from __future__ import annotations

from typing import Any

import pytest

from proof import Fault, Machine, Number, Pointer, Poly, Subject, congruent
from symbolic import require

FILE, HEADER = "raster/field.c", "raster/field.h"
NONE, EVEN, ODD = range(3)
NO_MIDDLE = 2**15 - 1
RING = 1 << 64


def line_of(machine: Machine, field: int, row: Poly) -> Poly:
    called = machine.call("el_field_row", machine.exactly("unsigned", field), machine.exactly("int32_t", row))
    line: Poly = called.poly
    return line


def row_of(machine: Machine, field: int, line: Poly) -> Poly:
    called = machine.call("el_screen_row", machine.exactly("unsigned", field), machine.exactly("int32_t", line))
    row: Poly = called.poly
    return row


def lines(field: int) -> Subject:
    """el_field_row: the first line that is not above; and each row is a line of one field."""

    def domain(machine: Machine) -> list[Any]:
        return [machine.exactly("unsigned", field), machine.number("int32_t", "row", -(2**20), 2**20)]

    def check(machine: Machine, arguments: list[Any], result: Number) -> None:
        path, row = machine.path, arguments[1].poly
        path.prove(row_of(machine, field, result.poly) - row, "the line is not above")
        path.prove(row - 1 - row_of(machine, field, result.poly - 1), "the line before it is")
        step = machine.call("el_field_step", arguments[0]).poly
        after = row_of(machine, field, result.poly + 1) - row_of(machine, field, result.poly)
        path.prove(after - step, "rows from line to line", zero=True)
        others = [row_of(machine, other, line_of(machine, other, row)) - row for other in (EVEN, ODD)]
        path.prove(others[0] + others[1] - 1, "a line of one field, and not of the other", zero=True)

    return Subject(FILE, "el_field_row", domain, check)


FIELDS = pytest.mark.parametrize("field", [EVEN, ODD])


@pytest.mark.parametrize("field", [NONE, EVEN, ODD])
def test_each_row_is_a_line_of_one_field(field: int) -> None:
    lines(field).prove()
    lines(field).agree()


# --- triangles --------------------------------------------------------------------------------------------------------


def any_edge(machine: Machine, name: str) -> Any:
    x = machine.path.atom(f"{name}.x", -(2**43), 2**43)
    return machine.struct("el_edge", x_q32=x, step_q32=machine.path.atom(f"{name}.step", -(2**45), 2**45))


def edge_at(machine: Machine, edge: Any, steps: Poly) -> Poly:
    return machine.poly(edge, "x_q32") + machine.poly(edge, "step_q32") * steps


def every_other_row(field: int, bends: bool) -> Subject:
    """take_every_other_row: of a triangle that is set up for a row which is the field's, with rows down to any."""
    before: dict[str, Any] = {}

    def domain(machine: Machine) -> list[Any]:
        path = machine.path
        y = path.atom("line", 0, 1019) * 2 + field - 1
        y_end = path.atom("y_end", 1, 2041)
        path.assume(y_end - y - 1)
        middle = path.atom("y_middle", 1, 2040) if bends else Poly.of(NO_MIDDLE)
        if bends:
            path.assume(middle - y - 1)
            path.assume(y_end - middle - 1)
        edges = {name: any_edge(machine, name) for name in ("left", "right", "lower")}
        z = machine.struct("el_plane", value=path.atom("z", 0, RING - 1), dy=path.atom("dy", 0, RING - 1))
        surface = machine.struct("el_surface", shading=0, depth=1)
        triangle = machine.struct(
            "el_triangle", y=y, y_end=y_end, y_middle=middle, edges_are_short=1, z=z, surface=surface, **edges
        )
        before.update(edges, y=y, y_end=y_end, middle=middle, dy=machine.poly(z, "dy"))
        return [Pointer([triangle]), machine.exactly("unsigned", field)]

    def check(machine: Machine, arguments: list[Any], _: Any) -> None:
        path, triangle = machine.path, arguments[0].cell
        y, y_end, middle = (machine.poly(triangle, name) for name in ("y", "y_end", "y_middle"))
        path.prove(row_of(machine, field, y) - before["y"], "it begins in the same row", zero=True)
        path.prove(y_end - line_of(machine, field, before["y_end"]), "it ends before the same row", zero=True)
        # One line on is two rows on.
        for name in ("left", "right"):
            after = edge_at(machine, triangle.content[name], Poly.of(1))
            path.prove(after - edge_at(machine, before[name], Poly.of(2)), f"{name}: two rows", zero=True)
        congruent(machine.poly(triangle, "z", "dy"), before["dy"] * 2, RING, "two rows of a plane")
        require(machine.poly(triangle, "edges_are_short").constant == 0, "doubled steps are not short")
        bend = line_of(machine, field, before["middle"]) if bends else Poly.of(NO_MIDDLE)
        if not bends or path.holds(bend - y_end):
            path.prove(middle - NO_MIDDLE, "no line has the lower part", zero=True)
            return
        path.prove(middle - bend, "the lower part begins in the same row", zero=True)
        path.prove(y_end - 1 - middle, "it has a line")
        rows = row_of(machine, field, middle) - before["middle"]
        gone = path.choose(rows)
        lower = triangle.content["lower"]
        for i in range(2):
            wanted = edge_at(machine, before["lower"], Poly.of(gone + 2 * i))
            path.prove(edge_at(machine, lower, Poly.of(i)) - wanted, "the lower edge, in its rows", zero=True)

    return Subject(FILE, "take_every_other_row", domain, check, modular=["double_plane"])


@FIELDS
@pytest.mark.parametrize("bends", [False, True])
def test_a_line_has_what_its_row_has(field: int, bends: bool) -> None:
    every_other_row(field, bends).prove()


@pytest.mark.parametrize(
    ("subject", "file", "old", "new"),
    [
        (lines(EVEN), HEADER, "(row + 2 - (int32_t)field) >> 1", "(row + 1 - (int32_t)field) >> 1"),
        (lines(ODD), HEADER, "2 * line + (int32_t)field - 1", "2 * line + (int32_t)field"),
        (lines(EVEN), HEADER, "? 1U : 2U", "? 1U : 1U"),
        (every_other_row(EVEN, True), FILE, "!= triangle->y_middle)", "== triangle->y_middle)"),
        (every_other_row(ODD, True), FILE, "        double_edge(&triangle->lower);\n", ""),
        (every_other_row(ODD, True), FILE, "middle < triangle->y_end", "middle <= triangle->y_end"),
        (every_other_row(EVEN, False), FILE, "    double_edge(&triangle->left);\n", ""),
        (every_other_row(EVEN, False), FILE, "plane->dy *= 2U;", "plane->dy *= 3U;"),
        (every_other_row(EVEN, False), FILE, "triangle->edges_are_short = false;", ";"),
    ],
)
def test_the_proof_can_fail(subject: Subject, file: str, old: str, new: str) -> None:
    subject.fails_with(Fault(file, old, new))
