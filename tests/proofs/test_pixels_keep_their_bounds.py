"""raster/spans, fill, fill_texture and gather: steps along a span and down the rows, light, the packing of a pixel.

A plane is followed down the screen's first column: its value in row j is V = V0 + dy j, and at a span's first pixel x,
V and dx x, modulo 2^64. Channels do the same modulo 2^32.

Depth is its plane's value, in Q32 modulo 2^64, and 1/2 and a little more than the plane's own error of less than 8161
units of 2^-32 (see test_planes_are_exact_modulo_2_64). So it is never below the true value and 1/2, and above by less
than 2^-18: floored, it is between the corners' depths, as that is.

A colour is its channel's value, off by less than 4080 units of 2^-24 there; half a unit of colour was added, so it
stays within 0..255.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

import contracts
from c_values import ArrayType, Cell, Memory
from proof import SMALL_CODE, Fault, Machine, Number, Pointer, Poly, Subject, congruent
from symbolic import Infeasible, require

SPANS, FILL, TEXTURE, GATHER = "raster/spans.c", "raster/fill.c", "raster/fill_texture.c", "raster/gather.c"
FILL_H = "raster/fill.h"
COLOUR_ERROR = 4080  # units of 2^-24, and less
HALF_Q24 = 128 << 16
LEAST_COLOUR, MOST_COLOUR = HALF_Q24 - COLOUR_ERROR, (255 << 24) + HALF_Q24 + COLOUR_ERROR
RING = 1 << 64
WORD = 1 << 32


def test_colours_do_not_wrap() -> None:
    assert contracts.PLANE_ERROR <= 1 << 13, "HALF_Q32's little more"
    assert LEAST_COLOUR >= 0 and MOST_COLOUR < 1 << 32


# --- along a span -----------------------------------------------------------------------------------------------------

NAMES = {"z": "z", "rgb.0": "red", "rgb.1": "green", "rgb.2": "blue"}


def member(triangle: Any, way: str) -> Any:
    cell = triangle
    for step in way.split("."):
        cell = cell.content[int(step) if step.isdigit() else step]
    return cell


def modulus(name: str) -> int:
    return RING if name == "z" else WORD


def any_triangle(machine: Machine) -> Any:
    """With any depth and channels, each of its own."""
    triangle = machine.struct("el_triangle")
    for name in NAMES:
        for part in ("value", "dx", "dy"):
            unknown = machine.path.atom(f"{name}.{part}", 0, modulus(name) - 1)
            machine.put(member(triangle, name).content[part], unknown)
    machine.put(triangle.content["y"], 0)
    machine.put(triangle.content["y_end"], machine.path.choose(machine.path.atom("y_end", 0, 1)))
    return triangle


def kind(machine: Machine, *names: str) -> Number:
    return machine.exactly(
        "uint32_t", sum(machine.constant(machine.unit.constants[f"EL_FILL_{name}"]) for name in names)
    )


ROWS: dict[int, tuple[Any, Any]] = {}  # the triangle, and its slopes


def row_domain(machine: Machine) -> list[Any]:
    triangle = any_triangle(machine)
    of = kind(machine, "DEPTH", "COLOURS")
    slopes = machine.call("el_slopes_of", Pointer([triangle]), of)
    ROWS[id(machine.path)] = triangle, slopes
    return [Pointer([slopes]), machine.number("int32_t", "x", 0, 4080), of]


def row_check(machine: Machine, arguments: list[Any], result: Any) -> None:
    """A span starts with the value there, of depth and 1/2 and more than its error; steps add dx and dy.

    What a row further has is kept if there is one.
    """
    triangle, slopes = ROWS.pop(id(machine.path))
    x, of = arguments[1].poly, arguments[2]
    numbers = {
        name: tuple(machine.poly(member(triangle, name), part) for part in ("value", "dx", "dy")) for name in NAMES
    }
    before = {name: machine.poly(result, stepped) for name, stepped in NAMES.items()}
    for name in NAMES:
        value, dx, _ = numbers[name]
        added = before[name] - value - dx * x
        half = added.terms.get((), 0) % modulus(name)
        congruent(added, Poly.of(half), modulus(name), "the value at that pixel, and")
        if name == "z":
            require(
                (1 << 31) + contracts.PLANE_ERROR <= half <= (1 << 32) - contracts.PLANE_ERROR,
                "a half and the plane's error",
            )
        else:
            require(half == 0, "nothing: its half is in it")
    machine.call("el_values_add", Pointer([result]), Pointer([slopes.content["per_column"]]), of)
    for name, stepped in NAMES.items():
        congruent(machine.poly(result, stepped), before[name] + numbers[name][1], modulus(name), "a pixel further")
    machine.call("el_values_add", Pointer([slopes.content["first"]]), Pointer([slopes.content["per_row"]]), of)
    machine.call("el_slopes_keep", Pointer([slopes]), Pointer([triangle]), of)
    for name in NAMES:
        value, _, dy = numbers[name]
        kept = value + dy if machine.poly(triangle, "y_end").known else value
        congruent(machine.poly(member(triangle, name), "value"), kept, modulus(name), "a row further")


ROW_MODULAR = ["el_slopes_of", "el_slopes_keep", "el_values_at", "el_values_add", "el_multiply_u16"]
ROW = Subject(FILL, "el_values_at", row_domain, row_check, modular=ROW_MODULAR)


def perspective_domain(machine: Machine) -> list[Any]:
    perspective = machine.struct("el_perspective")
    for name in "wuv":
        for part in ("value", "dx", "dy"):
            machine.put(perspective.content[name].content[part], machine.path.atom(f"{name}.{part}", 0, RING - 1))
    BEFORE[id(machine.path)] = {name: machine.poly(perspective, name, "value") for name in "wuv"}
    return [Pointer([perspective])]


def perspective_check(machine: Machine, arguments: list[Any], _: Any) -> None:
    before = BEFORE.pop(id(machine.path))
    for name in "wuv":
        plane = arguments[0].cell.content[name]
        congruent(machine.poly(plane, "value"), before[name] + machine.poly(plane, "dy"), RING, "a row further")


BEFORE: dict[int, dict[str, Poly]] = {}
PERSPECTIVE = Subject(
    TEXTURE,
    "el_perspective_next_row",
    perspective_domain,
    perspective_check,
    modular=["el_perspective_next_row"],
)

# --- down the sides ---------------------------------------------------------------------------------------------------

MOST_ROWS = 3
SIDES: dict[int, dict[str, tuple[Poly, Poly]]] = {}


def side_domain(machine: Machine) -> list[Any]:
    """A side anywhere that a row of its edge's or the row after can be, with any step, and a corner in it or below."""
    path = machine.path
    guard = machine.constant(machine.unit.constants["EL_GUARD_SUB"])
    triangle, edge = machine.struct("el_triangle"), machine.struct("el_edge")
    edges = {"edge": edge, "lower": triangle.content["lower"]}
    for name, cell in edges.items():
        machine.put(cell.content["x_q32"], path.atom(f"{name}.x", -2041 * WORD, 2042 * WORD - 1))
        machine.put(cell.content["step_q32"], path.atom(f"{name}.step", -2 * guard * WORD, 2 * guard * WORD))
    SIDES[id(path)] = {name: numbers_of(machine, cell) for name, cell in edges.items()}
    machine.put(triangle.content["y"], 0)
    machine.put(triangle.content["y_end"], path.choose(path.atom("y_end", 0, 1)))
    rows = path.choose(path.atom("rows", 1, MOST_ROWS))
    upper = path.choose(path.atom("upper", 1, MOST_ROWS + 1))
    columns = machine.array("uint16_t", [0] * MOST_ROWS)
    return [
        Pointer([triangle]),
        Pointer([edge]),
        columns,
        machine.exactly("int32_t", rows),
        machine.exactly("int32_t", upper),
    ]


def numbers_of(machine: Machine, edge: Any) -> tuple[Poly, Poly]:
    return machine.poly(edge, "x_q32"), machine.poly(edge, "step_q32")


def side_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    """Each row has its edge's column; the sum is theirs; what is left is the state of the row after them, if any."""
    path = machine.path
    edges = SIDES.pop(id(path))
    rows, upper = arguments[3].poly.known, arguments[4].poly.known
    x, step = edges["edge"]
    total = Poly.of(0)
    for row in range(rows):
        column = path.floor(x, WORD)
        congruent(machine.poly(arguments[2].cells[row]), column, 1 << 16, "the edge's column")
        total += column
        x += step
        if row + 1 == upper:
            x, step = edges["lower"]
    congruent(result.poly, total, WORD, "their sum")
    triangle = arguments[0].cell
    if rows >= upper and not machine.poly(triangle, "y_end").known:
        return
    after = numbers_of(machine, arguments[1].cell)
    require((after[0] - x).constant == 0 and (after[1] - step).constant == 0, "the edge of the next row")
    if rows >= upper:
        require(machine.poly(triangle, "y_middle").known == 2**15 - 1, "no middle is left")


SIDE = Subject(SPANS, "walk_bent", side_domain, side_check, modular=["walk", "walk_bent"])

# --- a pixel ----------------------------------------------------------------------------------------------------------


def light(machine: Machine) -> Pointer:
    channels = {name: machine.path.atom(name, LEAST_COLOUR, MOST_COLOUR) for name in ("red", "green", "blue")}
    return Pointer([machine.struct("el_values", **channels)])


def kind_of(machine: Machine, dither: bool) -> Number:
    return machine.exactly("uint32_t", machine.constant(machine.unit.constants["EL_FILL_DITHER"]) if dither else 0)


def threshold(machine: Machine) -> Number:
    """el_dither_threshold_q16: (2 k + 1) / 32."""
    k = machine.path.atom("k", 0, 15)
    return machine.exactly("uint32_t", k * 4096 + 2048)


def modulate_domain(dither: bool) -> Any:
    def domain(machine: Machine) -> list[Any]:
        red, green, blue = (machine.path.atom(n, 0, most) for n, most in (("red", 31), ("green", 63), ("blue", 31)))
        texel = machine.exactly("uint16_t", red * 2048 + green * 32 + blue)
        return [texel, light(machine), threshold(machine), kind_of(machine, dither)]

    return domain


def coloured_domain(dither: bool) -> Any:
    def domain(machine: Machine) -> list[Any]:
        return [light(machine), threshold(machine), kind_of(machine, dither)]

    return domain


def modulate(dither: bool) -> Subject:
    modular = ["el_fraction_q16", "el_dither"] if dither else []
    return Subject(TEXTURE, "el_modulate", modulate_domain(dither), modular=modular, packs=True)


def coloured(dither: bool) -> Subject:
    modular = ["el_fraction_q16", "el_dither"] if dither else []
    return Subject(FILL, "coloured", coloured_domain(dither), modular=modular, packs=True)


def texel_domain(machine: Machine) -> list[Any]:
    width, height = (machine.path.choose(machine.path.atom(name, 0, 10)) for name in ("width_log2", "height_log2"))
    texture = machine.struct("el_texture", width_log2=width, height_log2=height)
    texture.content["texels"].content = Memory(machine.type_named("uint16_t"), 1 << (width + height))
    source = machine.call("el_texel_source_of", Pointer([texture]))
    return [Pointer([source]), machine.number("uint32_t", "u_q16"), machine.number("uint32_t", "v_q16")]


TEXEL = Subject(TEXTURE, "el_texel_at", texel_domain)

# --- light and corners ------------------------------------------------------------------------------------------------


def light_domain(machine: Machine) -> list[Any]:
    path = machine.path
    el_light = machine.struct("el_light", ambient=path.atom("ambient", 0, 255), diffuse=path.atom("diffuse", 0, 255))
    material, draw = machine.struct("el_material"), machine.struct("el_draw_state")
    material.content["light"].content = Pointer([el_light])
    draw.content["material"].content = Pointer([material])
    machine.put(draw.content["light_q14"], [path.atom(f"light{i}", -16384, 16384) for i in range(3)])
    normal = machine.array("int8_t", [path.atom(f"normal{i}", -128, 127) for i in range(3)])
    return [Pointer([draw]), normal, machine.exactly("_Bool", path.choose(path.atom("turned", 0, 1)))]


def light_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    machine.path.prove(result.poly, "light >= 0")
    machine.path.prove(255 * 256 - result.poly, "light <= 255 in 8.8")


LIGHT = Subject(GATHER, "light_q8", light_domain, light_check)


def lit_domain(machine: Machine) -> list[Any]:
    return [machine.number("uint32_t", "colour", 0, 255), machine.number("uint32_t", "light", 0, 255 * 256)]


def lit_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    colour, of = (argument.poly for argument in arguments)
    machine.path.prove(255 * 256 - result.poly, "<= 255 in 8.8")
    error = (result.poly * 255 - colour * of) * 2
    machine.path.prove(error + 255, "rounded to nearest")
    machine.path.prove(255 - error, "rounded to nearest")


LIT = Subject(GATHER, "lit_q8", lit_domain, lit_check)
LIT_SMALL = replace(LIT, core=SMALL_CODE)


def flat_domain(machine: Machine) -> list[Any]:
    """One draw of one triangle, lit or not, with the mean of its vertices or with the first, or in a colour of its own.

    The light is proven above.
    """
    path = machine.path
    material, mesh, draw = (machine.struct(name) for name in ("el_material", "el_mesh", "el_draw_state"))
    mean, own, lit = (path.choose(path.atom(name, 0, 1)) for name in ("mean", "own", "lit"))
    machine.put(material.content["flags"], machine.constant(machine.unit.constants["EL_MATERIAL_FLAT_MEAN"]) * mean)
    draw.content["material"].content, draw.content["mesh"].content = Pointer([material]), Pointer([mesh])
    index = machine.exactly("uint16_t", 0)
    mesh.content["triangles"].content = Pointer([_row(machine, "uint16_t", [0, 0, 0])])
    mesh.content["normals"].content = Pointer([_row(machine, "int8_t", [0, 0, 127])])
    colours_of = _row(machine, "uint8_t", [path.atom(f"colour{i}", 0, 255) for i in range(3)])
    null = machine.exactly("int", 0)
    mesh.content["triangle_colours"].content = Pointer([colours_of]) if own else null
    mesh.content["colours"].content = null if own else Pointer([colours_of])
    material.content["light"].content = Pointer([machine.struct("el_light")]) if lit else null
    return [Pointer([draw]), index, machine.exactly("_Bool", 0)]


def flat_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    """What is not lit, and no mean, has the colour as it is."""
    draw = arguments[0].cell.content
    mesh, material = draw["mesh"].content.cell.content, draw["material"].content.cell.content
    own = isinstance(mesh["triangle_colours"].content, Pointer)
    if isinstance(material["light"].content, Pointer) or (not own and machine.poly(material["flags"]).known):
        return
    whose = "triangle_colours" if own else "colours"
    colour = [machine.load(cell) for cell in mesh[whose].content.cell.content]
    machine.path.prove(result.poly - machine.call("el_rgb565", *colour).poly, "the colour itself", zero=True)


def _row(machine: Machine, c_type: str, values: list[Any]) -> Any:
    return Cell(ArrayType(machine.type_named(c_type), 3), machine.array(c_type, values).cells)


def any_light(machine: Machine, _: list[Any]) -> Number:
    """light_q8 and lit_q8, proven above."""
    return machine.number("uint16_t", "light", 0, 255 * 256)


def any_lit(machine: Machine, arguments: list[Any]) -> Number:
    """lit_q8, proven above; in full light the colour itself: colour * 65280 + 127 = 255 * (256 colour) + 127."""
    if arguments[1].poly.constant == 0xFF00:
        return machine.exactly("uint16_t", arguments[0].poly * 256)
    return any_light(machine, arguments)


FLAT = Subject(
    GATHER, "flat_colour", flat_domain, flat_check, contracts={"light_q8": any_light, "lit_q8": any_lit}, packs=True
)


def choose_shifts(machine: Machine, all_pairs: bool) -> list[int]:
    """Each w depends on its own shift and on the least; the corners are treated alike. So: all pairs of the two, or
    those with the least shift of all."""
    path = machine.path
    least = path.choose(path.atom("least", 0, 31)) if all_pairs else 0
    own = path.choose(path.atom("own", 0, 31))
    if own < least:
        raise Infeasible
    shifts = [own, least, least]
    POINTS[id(path)] = ([path.atom(f"w{i}", 1 << 15, 65535) for i in range(3)], shifts)
    return shifts


def points_domain(machine: Machine) -> list[Any]:
    """A record's own reciprocals."""
    shifts = choose_shifts(machine, True)
    w, _ = POINTS[id(machine.path)]
    record = machine.struct("el_record", index=0)
    # What C takes for the first member of a larger object: here one object has the members of both.
    record.content |= machine.struct(
        "el_record_perspective", w=w, w_shifts=sum(s << (5 * i) for i, s in enumerate(shifts))
    ).content
    for point in record.content["at"].content["points"].content:
        machine.put(point.content["x"], 0)
        machine.put(point.content["y"], 0)
        machine.put(point.content["z"], 0)
    kind = machine.constant(machine.unit.constants["EL_RECORD_PERSPECTIVE"])
    corners = Pointer([machine.struct("el_corner") for _ in range(3)])
    return [Pointer([record]), machine.exactly("uint32_t", kind), corners]


def thin_points_domain(machine: Machine) -> list[Any]:
    """Of a thin record the numbers come from the vertices."""
    shifts = choose_shifts(machine, False)
    w, _ = POINTS[id(machine.path)]
    draw, record = machine.struct("el_draw_state"), machine.struct("el_record", index=0)
    material = machine.struct("el_material", shading=machine.constant(machine.unit.constants["EL_SHADE_TEXTURED"]))
    draw.content["material"].content = Pointer([material])
    mesh = machine.struct("el_mesh")
    draw.content["mesh"].content = Pointer([mesh])
    mesh.content["triangles"].content = Pointer([_row(machine, "uint16_t", [2, 1, 0])])
    mesh.content["positions"].content = Pointer([_row(machine, "int16_t", [2 - i] * 3) for i in range(3)])
    machine.contracts = {"el_transform_vertex": lambda machine, arguments: transformed(machine, arguments, w, shifts)}
    corners = Pointer([machine.struct("el_corner") for _ in range(3)])
    return [Pointer([draw]), Pointer([record]), corners]


POINTS: dict[int, tuple[list[Poly], list[int]]] = {}


def transformed(machine: Machine, arguments: list[Any], w: list[Poly], shifts: list[int]) -> None:
    """el_transform_vertex: the vertex whose number its position is."""
    which = machine.poly(arguments[1].cell).known
    for name, value in {"x": 0, "y": 0, "z": 0, "w": w[which], "w_shift": shifts[which]}.items():
        machine.put(arguments[2].cell.content[name], value)


def points_check(machine: Machine, arguments: list[Any], _: Any) -> None:
    """1 <= w < 2^31 for each, and the largest of them has its top bit; each is what it was, cut off, or 1."""
    path, (w, shifts) = machine.path, POINTS.pop(id(machine.path))
    corners = [machine.poly(cell, "w") for cell in arguments[-1].cells]
    for corner, was, shift in zip(corners, w, shifts, strict=True):
        path.prove(corner - 1, "w >= 1")
        path.prove((1 << 31) - 1 - corner, "w < 2^31")
        rest = was * 2**15 - corner * (1 << shift - min(shifts))
        path.prove((1 << shift - min(shifts)) - 1 - rest, "not below what it was")
        if corner.constant != 1:
            path.prove(rest, "not above")
    require(any(path.holds(corner - (1 << 30)) for corner in corners), "the largest w is 2^30 at least")


SUBJECTS = {
    "row": ROW,
    "perspective": PERSPECTIVE,
    "side": SIDE,
    "modulate": modulate(False),
    "modulate, dithered": modulate(True),
    "coloured": coloured(False),
    "coloured, dithered": coloured(True),
    "texel": TEXEL,
    "light": LIGHT,
    "lit": LIT,
    "lit, small code": LIT_SMALL,
    "flat": FLAT,
    "points": Subject(GATHER, "gather_points", points_domain, points_check),
    "points of a thin record": Subject(GATHER, "find_points", thin_points_domain, points_check),
}


@pytest.mark.parametrize("name", SUBJECTS)
def test_all_values(name: str) -> None:
    SUBJECTS[name].prove()


@pytest.mark.parametrize(
    "name", ["row", "perspective", "side", "modulate", "modulate, dithered", "coloured", "coloured, dithered", "lit"]
)
def test_the_compiler_agrees(name: str) -> None:
    subject = SUBJECTS[name]
    Subject(subject.file, subject.function, subject.domain, modular=subject.modular).agree(count=200)


@pytest.mark.parametrize(
    ("name", "file", "old", "new"),
    [
        ("row", FILL_H, "(1U << 13)", "(1U << 12)"),
        ("row", FILL_H, "values->z += step->z;", "values->z += step->z + 1U;"),
        ("row", FILL_H, "values->green += step->green", "values->green += step->blue"),
        ("row", FILL_H, "s->per_column.blue * columns", "s->per_column.red * columns"),
        ("row", FILL_H, "s.per_row.red = rgb[0].dy", "s.per_row.red = rgb[0].dx"),
        ("row", FILL_H, "s->first.z - EL_HALF_Q32", "s->first.z"),
        (
            "perspective",
            FILL_H,
            "perspective->v.value += perspective->v.dy",
            "perspective->v.value += perspective->u.dy",
        ),
        ("side", SPANS, "edge->step_q32 = triangle->lower.step_q32", "edge->step_q32 = edge->x_q32"),
        ("side", SPANS, "triangle->y_middle = INT16_MAX", "triangle->y_middle = 0"),
        ("side", SPANS, "if (rows < upper)", "if (rows <= upper)"),
        ("side", SPANS, "x + upper, rows - upper)", "x, rows - upper)"),
        ("side", "raster/edge.h", "edge->x_q32 += edge->step_q32", "edge->x_q32 += edge->step_q32 + 1"),
        ("modulate", "raster/texel.h", "(light >> 24) + 1U", "(light >> 24) + 10U"),
        ("coloured", FILL_H, "values->red >> 27 << 6", "values->red >> 27 << 5"),
        ("coloured, dithered", "base/dither.h", "+ threshold_q16) >> 16", "+ threshold_q16 + 2079U) >> 16"),
        ("texel", "raster/texel.h", "((1U << texture->height_log2) - 1U)", "(1U << texture->height_log2)"),
        ("texel", "raster/texel.h", "(1U << texture->width_log2) - 1U", "1U << texture->width_log2"),
        ("light", GATHER, "value > 0xFF00U ? 0xFF00U", "value > 0xFF01U ? 0xFF00U"),
        ("lit", GATHER, "light + 127U", "light + 128U"),
        ("lit", GATHER, "rest + 1U + (rest >> 8)", "rest + (rest >> 8)"),
        ("lit, small code", GATHER, "n / 255U", "n / 256U"),
        ("flat", GATHER, "count + 128U", "count + 256U"),
        ("flat", GATHER, "el_rgb565(rgb[0], rgb[1], rgb[2])", "el_rgb565(rgb[0], rgb[1], rgb[1])"),
        ("points", GATHER, "scaled == 0 ? 1U : scaled", "scaled"),
        ("points", GATHER, "w_shifts >> (5 * i)", "w_shifts >> (4 * i)"),
    ],
)
def test_the_proof_can_fail(name: str, file: str, old: str, new: str) -> None:
    SUBJECTS[name].fails_with(Fault(file, old, new))
