"""raster/rows, raster/gather: what is stepped along a span and down the rows, light, and the packing of a pixel.

A plane is followed along the left edge: at the row's first pixel, X = floor(x), it has V = V0 + dx X + dy j, modulo
2^64. A row further, x grows by the step, X by the step's whole part and by 1 where the fraction runs over, and so does
V. Where the left edge bends, V and what is added per row change as X and its step do. Channels do the same modulo 2^32.

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

ROWS, GATHER = "raster/rows.c", "raster/gather.c"
COLOUR_ERROR = 4080  # units of 2^-24, and less
HALF_Q24 = 128 << 16
LEAST_COLOUR, MOST_COLOUR = HALF_Q24 - COLOUR_ERROR, (255 << 24) + HALF_Q24 + COLOUR_ERROR
RING = 1 << 64
WORD = 1 << 32


def test_colours_do_not_wrap() -> None:
    assert contracts.PLANE_ERROR <= 1 << 13, "HALF_Q32's little more"
    assert LEAST_COLOUR >= 0 and MOST_COLOUR < 1 << 32


# --- along a span -----------------------------------------------------------------------------------------------------

PLANES = ("z", "perspective.w", "perspective.u", "perspective.v")
CHANNELS = ("rgb.0", "rgb.1", "rgb.2")


def member(triangle: Any, way: str) -> Any:
    cell = triangle
    for step in way.split("."):
        cell = cell.content[int(step) if step.isdigit() else step]
    return cell


def any_triangle(machine: Machine) -> Any:
    """With any planes and channels, each of its own."""
    triangle = machine.struct("el_triangle")
    for names, most in ((PLANES, RING - 1), (CHANNELS, WORD - 1)):
        for name in names:
            for part in ("value", "dx", "down"):
                machine.put(member(triangle, name).content[part], machine.path.atom(f"{name}.{part}", 0, most))
    return triangle


def parts(machine: Machine, triangle: Any) -> dict[str, tuple[Poly, Poly, Poly]]:
    """value, dx and down of each plane and channel."""
    return {
        name: (
            machine.poly(member(triangle, name), "value"),
            machine.poly(member(triangle, name), "dx"),
            machine.poly(member(triangle, name), "down"),
        )
        for name in (*PLANES, *CHANNELS)
    }


def modulus(name: str) -> int:
    return WORD if name in CHANNELS else RING


def kind(machine: Machine, *names: str) -> Number:
    return machine.exactly("uint32_t", sum(machine.constant(machine.unit.constants[name]) for name in names))


def span_domain(machine: Machine) -> list[Any]:
    skipped = machine.number("int32_t", "skipped", 0, 4080)
    return [Pointer([any_triangle(machine)]), skipped, kind(machine, "DEPTH", "COLOURS")]


def span_check(machine: Machine, arguments: list[Any], result: Any) -> None:
    """The start is the value there, of depth and 1/2 and more than its error; a step of the loop adds dx."""
    triangle, skipped, of = arguments
    names = {"z": "z", "rgb.0": "red", "rgb.1": "green", "rgb.2": "blue"}
    numbers = parts(machine, triangle.cell)
    before = {}
    for name, stepped in names.items():
        value, dx, _ = numbers[name]
        before[name] = machine.poly(result, stepped)
        added = before[name] - value
        # Depth has a path of its own for no pixel.
        if name != "z" or machine.path.bounds(skipped.poly)[1] > 0:
            added -= dx * skipped.poly
        half = added.terms.get((), 0) % modulus(name)
        congruent(added, Poly.of(half), modulus(name), "the value at the first pixel of the screen, and")
        if name == "z":
            require(
                (1 << 31) + contracts.PLANE_ERROR <= half <= (1 << 32) - contracts.PLANE_ERROR,
                "a half and the plane's error",
            )
        else:
            require(half == 0, "nothing: its half is in it")
    machine.call("span_step", Pointer([result]), of)
    for name, stepped in names.items():
        congruent(machine.poly(result, stepped), before[name] + numbers[name][1], modulus(name), "a step adds it")


SPAN_MODULAR = ["span_begin", "span_step"]
SPAN = Subject(
    ROWS,
    "span_begin",
    span_domain,
    span_check,
    modular=SPAN_MODULAR,
    contracts={"el_plane_times": contracts.plane_times},
)

# --- down the rows ----------------------------------------------------------------------------------------------------

Edge = tuple[Poly, Poly, Poly, Poly]  # whole and fraction of x, of the step
WALKS: dict[int, tuple[dict[str, Edge], dict[str, tuple[Poly, Poly, Poly]]]] = {}


def walk_domain(machine: Machine) -> list[Any]:
    """Edges anywhere that a row of theirs or the row after can be, with any step."""
    path = machine.path
    guard = machine.constant(machine.unit.constants["EL_GUARD_SUB"])
    triangle = any_triangle(machine)
    edges = {}
    for name in ("left", "right", "lower"):
        x = path.atom(f"{name}.x", -2041 - 2 * guard, 2041 + 2 * guard)
        step = path.atom(f"{name}.step", -2 * guard, 2 * guard)
        fraction, part = path.atom(f"{name}.fraction", 0, WORD - 1), path.atom(f"{name}.part", 0, WORD - 1)
        machine.put(triangle.content[name].content["x_q32"], x * WORD + fraction)
        machine.put(triangle.content[name].content["step_q32"], step * WORD + part)
        edges[name] = (x, fraction, step, part)
    machine.put(triangle.content["short_is_left"], path.choose(path.atom("short_is_left", 0, 1)))
    WALKS[id(path)] = (edges, parts(machine, triangle))
    return [Pointer([triangle]), kind(machine, "DEPTH", "COLOURS", "TEXTURE")]


def row_check(machine: Machine, arguments: list[Any], _: Any) -> None:
    path = machine.path
    edges, before = WALKS.pop(id(path))
    triangle = arguments[0].cell
    for name in ("left", "right"):
        x, fraction, step, part = edges[name]
        moved = machine.poly(triangle, name, "x_q32") - (x + step) * WORD - fraction - part
        path.prove(moved, "a step further", zero=True)
    _, fraction, step, part = edges["left"]
    carry = path.choose(path.floor(fraction + part, WORD))
    for name, (value, dx, down) in parts(machine, triangle).items():
        # V0 + dx X + dy j, with dy = down - dx step: X grows by the step and the carry, j by 1.
        dy = before[name][2] - dx * step
        congruent(value, before[name][0] + dx * (step + carry) + dy, modulus(name), "V is that of the new X")
        require((down - before[name][2]).constant == 0, "the rest is as it was")


def bend_check(machine: Machine, arguments: list[Any], _: Any) -> None:
    path = machine.path
    edges, before = WALKS.pop(id(path))
    triangle = arguments[0].cell
    bends = machine.poly(triangle, "short_is_left").known
    side = "left" if bends else "right"
    x, fraction, step, part = edges["lower"]
    path.prove(machine.poly(triangle, side, "x_q32") - x * WORD - fraction, "the lower edge", zero=True)
    path.prove(machine.poly(triangle, side, "step_q32") - step * WORD - part, "the lower edge", zero=True)
    for name, (value, dx, down) in parts(machine, triangle).items():
        aside, steeper = (x - edges["left"][0], step - edges["left"][2]) if bends else (Poly.of(0), Poly.of(0))
        congruent(value, before[name][0] + dx * aside, modulus(name), "V is that of the new X")
        congruent(down - dx * steeper, before[name][2], modulus(name), "dy is as it was")


WALK_MODULAR = ["plane_next_row", "channel_next_row", "next_row", "bend_plane", "bend", "el_plane_times"]
ROW = Subject(ROWS, "next_row", walk_domain, row_check, modular=WALK_MODULAR)
BEND = Subject(
    ROWS, "bend", walk_domain, bend_check, modular=WALK_MODULAR, contracts={"el_plane_times": contracts.plane_times}
)

# --- a pixel ----------------------------------------------------------------------------------------------------------


def light(machine: Machine) -> Pointer:
    channels = {name: machine.path.atom(name, LEAST_COLOUR, MOST_COLOUR) for name in ("red", "green", "blue")}
    return Pointer([machine.struct("span", **channels)])


def kind_of(machine: Machine, dither: bool) -> Number:
    return machine.exactly("uint32_t", machine.constant(machine.unit.constants["DITHER"]) if dither else 0)


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
    modular = ["fraction_q16", "el_dither"] if dither else []
    return Subject(ROWS, "modulate", modulate_domain(dither), modular=modular, packs=True)


def coloured(dither: bool) -> Subject:
    modular = ["fraction_q16", "el_dither"] if dither else []
    return Subject(ROWS, "coloured", coloured_domain(dither), modular=modular, packs=True)


def texel_domain(machine: Machine) -> list[Any]:
    width, height = (machine.path.choose(machine.path.atom(name, 0, 10)) for name in ("width_log2", "height_log2"))
    texture = machine.struct("el_texture", width_log2=width, height_log2=height)
    texture.content["texels"].content = Memory(machine.type_named("uint16_t"), 1 << (width + height))
    source = machine.call("source_of", Pointer([texture]))
    return [Pointer([source]), machine.number("uint32_t", "u_q16"), machine.number("uint32_t", "v_q16")]


TEXEL = Subject(ROWS, "texel_at", texel_domain)

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


FLAT = Subject(
    GATHER, "flat_colour", flat_domain, flat_check, contracts={"light_q8": any_light, "lit_q8": any_light}, packs=True
)


def points_domain(machine: Machine) -> list[Any]:
    """Each w depends on its own shift and on the least; the corners are treated alike. So: all pairs of the two.

    Of a thin record the numbers come from the vertices instead, all others the same: with the least shift of all.
    """
    path = machine.path
    least, own = path.choose(path.atom("least", 0, 31)), path.choose(path.atom("own", 0, 31))
    if own < least:
        raise Infeasible
    shifts = [own, least, least]
    w = [path.atom(f"w{i}", 1 << 15, 65535) for i in range(3)]
    POINTS[id(path)] = (w, shifts)
    thin = least == 0 and path.choose(path.atom("thin", 0, 1))
    draw, record = machine.struct("el_draw_state"), machine.struct("el_record", index=0)
    material = machine.struct("el_material", shading=machine.constant(machine.unit.constants["EL_SHADE_TEXTURED"]))
    draw.content["material"].content = Pointer([material])
    if thin:
        mesh = machine.struct("el_mesh")
        draw.content["mesh"].content = Pointer([mesh])
        mesh.content["triangles"].content = Pointer([_row(machine, "uint16_t", [2, 1, 0])])
        mesh.content["positions"].content = Pointer([_row(machine, "int16_t", [2 - i] * 3) for i in range(3)])
    else:
        # What C takes for the first member of a larger object: here one object has the members of both.
        record.content |= machine.struct(
            "el_record_perspective", w=w, w_shifts=sum(s << (5 * i) for i, s in enumerate(shifts))
        ).content
        for point in record.content["at"].content["points"].content:
            machine.put(point.content["x"], 0)
            machine.put(point.content["y"], 0)
            machine.put(point.content["z"], 0)
    machine.contracts = {"el_transform_vertex": lambda machine, arguments: transformed(machine, arguments, w, shifts)}
    kind = machine.constant(machine.unit.constants["EL_RECORD_THIN" if thin else "EL_RECORD_PERSPECTIVE"])
    corners = Pointer([machine.struct("el_corner") for _ in range(3)])
    return [Pointer([draw]), Pointer([record]), machine.exactly("uint32_t", kind), corners]


POINTS: dict[int, tuple[list[Poly], list[int]]] = {}


def transformed(machine: Machine, arguments: list[Any], w: list[Poly], shifts: list[int]) -> None:
    """el_transform_vertex: the vertex whose number its position is."""
    which = machine.poly(arguments[1].cell).known
    for name, value in {"x": 0, "y": 0, "z": 0, "w": w[which], "w_shift": shifts[which]}.items():
        machine.put(arguments[2].cell.content[name], value)


def points_check(machine: Machine, arguments: list[Any], _: Any) -> None:
    """1 <= w < 2^31 for each, and the largest of them has its top bit; each is what it was, cut off, or 1."""
    path, (w, shifts) = machine.path, POINTS.pop(id(machine.path))
    corners = [machine.poly(cell, "w") for cell in arguments[3].cells]
    for corner, was, shift in zip(corners, w, shifts, strict=True):
        path.prove(corner - 1, "w >= 1")
        path.prove((1 << 31) - 1 - corner, "w < 2^31")
        rest = was * 2**15 - corner * (1 << shift - min(shifts))
        path.prove((1 << shift - min(shifts)) - 1 - rest, "not below what it was")
        if corner.constant != 1:
            path.prove(rest, "not above")
    require(any(path.holds(corner - (1 << 30)) for corner in corners), "the largest w is 2^30 at least")


SUBJECTS = {
    "span": SPAN,
    "row": ROW,
    "bend": BEND,
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
}


@pytest.mark.parametrize("name", SUBJECTS)
def test_all_values(name: str) -> None:
    SUBJECTS[name].prove()


@pytest.mark.parametrize(
    "name", ["span", "row", "bend", "modulate", "modulate, dithered", "coloured", "coloured, dithered", "lit"]
)
def test_the_compiler_agrees(name: str) -> None:
    subject = SUBJECTS[name]
    modular = [*subject.modular, *SPAN_MODULAR, *WALK_MODULAR, "el_multiply_u64"]
    Subject(subject.file, subject.function, subject.domain, modular=modular).agree(count=200)


@pytest.mark.parametrize(
    ("name", "file", "old", "new"),
    [
        ("span", ROWS, "(1U << 13)", "(1U << 12)"),
        ("span", ROWS, "s->z += s->z_step;", "s->z += s->z_step + 1U;"),
        ("span", ROWS, "s->green += s->green_step", "s->green += s->blue_step"),
        ("row", ROWS, "triangle->left.x_q32 < fraction", "triangle->left.x_q32 <= fraction"),
        ("row", ROWS, "(carry ? channel->dx : 0U)", "(carry ? 0U : channel->dx)"),
        ("bend", ROWS, "plane->down += el_plane_times(plane->dx, steeper)", "plane->down += plane->dx"),
        ("bend", ROWS, "bend_plane(&triangle->perspective.v, aside", "bend_plane(&triangle->perspective.u, aside"),
        ("modulate", ROWS, "(light >> 24) + 1U", "(light >> 24) + 10U"),
        ("coloured", ROWS, "s->green >> 26 << 5", "s->green >> 25 << 5"),
        ("coloured, dithered", "base/dither.h", "+ threshold_q16) >> 16", "+ threshold_q16 + 2079U) >> 16"),
        ("texel", ROWS, "((1U << texture->height_log2) - 1U)", "(1U << texture->height_log2)"),
        ("texel", ROWS, "(1U << texture->width_log2) - 1U", "1U << texture->width_log2"),
        ("light", GATHER, "value > 0xFF00U ? 0xFF00U", "value > 0xFF01U ? 0xFF00U"),
        ("lit", GATHER, "light + 127U", "light + 128U"),
        ("lit", GATHER, "rest + 1U + (rest >> 8)", "rest + (rest >> 8)"),
        ("lit, small code", GATHER, "n / 255U", "n / 256U"),
        ("flat", GATHER, "count + 128U", "count + 256U"),
        ("flat", GATHER, "el_rgb565(own[0], own[1], own[2])", "el_rgb565(own[0], own[1], own[1])"),
        ("points", GATHER, "scaled == 0 ? 1U : scaled", "scaled"),
        ("points", GATHER, "w_shifts >> (5 * i)", "w_shifts >> (4 * i)"),
    ],
)
def test_the_proof_can_fail(name: str, file: str, old: str, new: str) -> None:
    SUBJECTS[name].fails_with(Fault(file, old, new))
