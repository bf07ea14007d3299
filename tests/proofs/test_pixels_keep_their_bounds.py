"""raster/rows, raster/gather: what is stepped along a span, light, and the packing of a pixel.

Depth is stepped as its plane is, in Q32 modulo 2^64: after n steps it is the plane's value there, and 1/2 and a little
more than the plane's own error of less than 8161 units of 2^-32 (see test_planes_are_exact_modulo_2_64). So it is never
below the true value and 1/2, and above by less than 2^-18: floored, it is between the corners' depths, as that is.

A colour is 32 bits out of the middle of its plane, and a rounded step. In units of 2^-24, modulo 2^32, it is the
plane's at that pixel but for at most 1 for the start's floor, +- n / 2 for the step's rounding, and
+- 1/8 for the plane's error.
That is below 1021 for n <= 2039, 2^-14 of a unit of colour; half a unit was added, so it stays within 0..255.
"""

from __future__ import annotations

from typing import Any

import pytest

from c_values import ArrayType, Cell, Memory
from proof import Fault, Machine, Number, Pointer, Poly, Subject
from symbolic import Infeasible, require

ROWS, GATHER = "raster/rows.c", "raster/gather.c"
SCREEN = 2040
STEPS = SCREEN - 1
PLANE_ERROR = 1 + 2 * (2 * SCREEN)  # units of 2^-32, and less
COLOUR_ERROR = 1 + STEPS // 2 + 1  # floor, steps, and the plane's error, rounded up
HALF_Q24 = 128 << 16
LEAST_COLOUR, MOST_COLOUR = HALF_Q24 - COLOUR_ERROR, (255 << 24) + HALF_Q24 + COLOUR_ERROR
RING = 1 << 64


def test_colours_do_not_wrap() -> None:
    assert 8 + 4 * STEPS + 1 <= 8 * COLOUR_ERROR, "1 + n / 2 + 1/8 <= COLOUR_ERROR"
    assert PLANE_ERROR <= 1 << 13, "the plane's error is an eighth of 2^-16"
    assert LEAST_COLOUR >= 0 and MOST_COLOUR < 1 << 32


def any_plane(machine: Machine) -> Any:
    row, dx = machine.path.atom("row", 0, RING - 1), machine.path.atom("dx", 0, RING - 1)
    return machine.struct("el_plane", row=row, dx=dx, dy=0)


def colour_domain(machine: Machine) -> list[Any]:
    return [Pointer([any_plane(machine)]), machine.number("int32_t", "x", 0, SCREEN - 1)]


def colour_check(machine: Machine, arguments: list[Any], result: Any) -> None:
    path = machine.path
    plane, x = arguments
    row, dx = machine.poly(plane.cell, "row"), machine.poly(plane.cell, "dx")

    def modulo_2_48(poly: Poly) -> Poly:
        return poly - path.floor(poly, 1 << 48) * (1 << 48)

    cut_off = modulo_2_48(row + dx * x.poly - (machine.poly(result, "value") - HALF_Q24) * (1 << 16))
    path.prove((1 << 16) - 1 - cut_off, "the start is the plane's, less than 2^-16 cut off")
    rounding = modulo_2_48(machine.poly(result, "step") * (1 << 16) - dx + (1 << 15))
    path.prove((1 << 16) - rounding, "the step is the plane's, within half of 2^-16")


COLOUR = Subject(ROWS, "colour_at", colour_domain, colour_check, modular=["colour_at", "value_at"])


def depth_domain(machine: Machine) -> list[Any]:
    triangle = machine.struct("el_triangle")
    machine.put(triangle.content["planes"].content[0], any_plane(machine))
    kind = machine.exactly("uint32_t", machine.constant(machine.unit.constants["DEPTH"]))
    return [Pointer([triangle]), machine.number("int32_t", "x", 0, SCREEN - 1), kind]


def depth_check(machine: Machine, arguments: list[Any], result: Any) -> None:
    """The start is the plane's and 1/2 and more than its error, the step the plane's; so is each step of the loop."""
    triangle, x, kind = arguments
    plane = triangle.cell.content["planes"].content[0]
    row, dx = machine.poly(plane, "row"), machine.poly(plane, "dx")
    added = machine.poly(result, "z", "value") - row - dx * x.poly
    half = added.terms.get((), 0) % RING
    require(all(factor % RING == 0 for unknowns, factor in added.terms.items() if unknowns), "the plane's value, and")
    require((1 << 31) + PLANE_ERROR <= half <= (1 << 32) - PLANE_ERROR, "a half and the plane's error")
    path = machine.path
    path.prove(machine.poly(result, "z", "step") - dx, "the step is the plane's", zero=True)
    before = machine.poly(result, "z", "value")
    machine.call("span_step", Pointer([result]), kind)
    change = machine.poly(result, "z", "value") - before - dx
    require(all(factor % RING == 0 for factor in change.terms.values()), "a step adds it")


DEPTH = Subject(
    ROWS, "span_begin", depth_domain, depth_check, modular=["span_begin", "value_at", "colour_at", "span_step"]
)


def light(machine: Machine, values: list[Poly]) -> Pointer:
    cells = [machine.struct("stepped", value=value, step=0) for value in values]
    return Pointer(cells)


def kind_of(machine: Machine, dither: bool) -> Number:
    return machine.exactly("uint32_t", machine.constant(machine.unit.constants["DITHER"]) if dither else 0)


def threshold(machine: Machine) -> Number:
    """el_dither_threshold_q16: (2 k + 1) / 32."""
    k = machine.path.atom("k", 0, 15)
    return machine.exactly("uint32_t", k * 4096 + 2048)


def colours(machine: Machine) -> list[Poly]:
    return [machine.path.atom(f"light{i}", LEAST_COLOUR, MOST_COLOUR) for i in range(3)]


def modulate_domain(dither: bool) -> Any:
    def domain(machine: Machine) -> list[Any]:
        red, green, blue = (machine.path.atom(n, 0, most) for n, most in (("red", 31), ("green", 63), ("blue", 31)))
        texel = machine.exactly("uint16_t", red * 2048 + green * 32 + blue)
        return [texel, light(machine, colours(machine)), threshold(machine), kind_of(machine, dither)]

    return domain


def coloured_domain(dither: bool) -> Any:
    def domain(machine: Machine) -> list[Any]:
        return [light(machine, colours(machine)), threshold(machine), kind_of(machine, dither)]

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
    return [Pointer([texture]), machine.number("uint32_t", "u_q16"), machine.number("uint32_t", "v_q16")]


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


def flat_domain(machine: Machine) -> list[Any]:
    """One draw of one triangle, with the mean of its vertices or with the first; the light is proven above."""
    path = machine.path
    material, mesh, draw = (machine.struct(name) for name in ("el_material", "el_mesh", "el_draw_state"))
    flags = machine.constant(machine.unit.constants["EL_MATERIAL_FLAT_MEAN"]) * path.choose(path.atom("mean", 0, 1))
    machine.put(material.content["flags"], flags)
    draw.content["material"].content, draw.content["mesh"].content = Pointer([material]), Pointer([mesh])
    index = machine.exactly("uint16_t", 0)
    mesh.content["triangles"].content = Pointer([_row(machine, "uint16_t", [0, 0, 0])])
    mesh.content["normals"].content = Pointer([_row(machine, "int8_t", [0, 0, 127])])
    colours_of = _row(machine, "uint8_t", [path.atom(f"colour{i}", 0, 255) for i in range(3)])
    mesh.content["triangle_colours"].content = Pointer([colours_of])
    material.content["light"].content = Pointer([machine.struct("el_light")])
    return [Pointer([draw]), index, machine.exactly("_Bool", 0)]


def _row(machine: Machine, c_type: str, values: list[Any]) -> Any:
    return Cell(ArrayType(machine.type_named(c_type), 3), machine.array(c_type, values).cells)


FLAT = Subject(
    GATHER,
    "flat_colour",
    flat_domain,
    contracts={"light_q8": lambda machine, _: machine.number("uint32_t", "light", 0, 255 * 256)},
    packs=True,
)


def gather_w_domain(machine: Machine) -> list[Any]:
    """Each w depends on its own shift and on the least; the corners are treated alike. So: all pairs of the two."""
    path = machine.path
    least, own = path.choose(path.atom("least", 0, 31)), path.choose(path.atom("own", 0, 31))
    if own < least:
        raise Infeasible
    shifts = [own, least, least]
    record = machine.struct("el_record_perspective", w_shifts=sum(s << (5 * i) for i, s in enumerate(shifts)))
    machine.put(record.content["w"], [path.atom(f"w{i}", 1 << 15, 65535) for i in range(3)])
    return [Pointer([record]), Pointer([machine.struct("el_corner") for _ in range(3)])]


def gather_w_check(machine: Machine, arguments: list[Any], _: Any) -> None:
    """1 <= w < 2^31 for each, and the largest of them has its top bit."""
    corners = [machine.poly(cell, "w") for cell in arguments[1].cells]
    for w in corners:
        machine.path.prove(w - 1, "w >= 1")
        machine.path.prove((1 << 31) - 1 - w, "w < 2^31")
    require(any(machine.path.holds(w - (1 << 30)) for w in corners), "the largest w is 2^30 at least")


SUBJECTS = {
    "colour": COLOUR,
    "depth": DEPTH,
    "modulate": modulate(False),
    "modulate, dithered": modulate(True),
    "coloured": coloured(False),
    "coloured, dithered": coloured(True),
    "texel": TEXEL,
    "light": LIGHT,
    "lit": LIT,
    "flat": FLAT,
    "gather_w": Subject(GATHER, "gather_w", gather_w_domain, gather_w_check),
}


@pytest.mark.parametrize("name", SUBJECTS)
def test_all_values(name: str) -> None:
    SUBJECTS[name].prove()


@pytest.mark.parametrize("name", ["colour", "modulate", "modulate, dithered", "coloured", "coloured, dithered", "lit"])
def test_the_compiler_agrees(name: str) -> None:
    SUBJECTS[name].agree(count=200)


@pytest.mark.parametrize(
    ("name", "file", "old", "new"),
    [
        ("depth", ROWS, "(1U << 13)", "(1U << 12)"),
        ("depth", ROWS, "s->z.value += s->z.step", "s->z.value += s->z.step + 1U"),
        ("colour", ROWS, "(plane->dx + 0x8000U) >> 16", "(plane->dx + 0x8001U) >> 16"),
        ("modulate", ROWS, "(light[i].value >> 24) + 1U", "(light[i].value >> 24) + 10U"),
        ("coloured", ROWS, "rgb[1].value >> 26 << 5", "rgb[1].value >> 25 << 5"),
        ("coloured, dithered", "base/dither.h", "+ threshold_q16) >> 16", "+ threshold_q16 + 2079U) >> 16"),
        ("texel", ROWS, "((1U << texture->height_log2) - 1U)", "(1U << texture->height_log2)"),
        ("light", GATHER, "value > 0xFF00U ? 0xFF00U", "value > 0xFF01U ? 0xFF00U"),
        ("lit", GATHER, "light + 127U", "light + 128U"),
        ("flat", GATHER, "count + 128U", "count + 256U"),
        ("gather_w", GATHER, "w == 0 ? 1U : w", "w"),
    ],
)
def test_the_proof_can_fail(name: str, file: str, old: str, new: str) -> None:
    SUBJECTS[name].fails_with(Fault(file, old, new))
