"""geometry/cull: the steps of the coarse frustum test keep within 32 bits, for any camera, pose and mesh that
el_view_make and el_transform_make let through. That what it calls outside is outside, and that nothing overflows
between the steps, is for tests/unit/test_far_outside.c, also with sanitizers.
"""

from __future__ import annotations

from typing import Any

import pytest

from proof import Fault, Machine, Number, Pointer, Subject
from symbolic import require

CULL = "geometry/cull.c"
ELEMENT = 2**30 + 16  # of rotations and axes, as check_place has it
ROW = 2**14  # of a row of one, with the upper bits alone; one more below 0


def row_domain(machine: Machine) -> list[Any]:
    elements = [machine.path.atom(f"e{i}", -ELEMENT, ELEMENT) for i in range(3)]
    return [machine.array("int32_t", elements), machine.array("int32_t", [0, 0, 0])]


def row_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    for cell in arguments[1].cells:
        value = machine.poly(cell)
        machine.path.prove(value + ROW + 1, "not below -1")
        machine.path.prove(ROW - value, "not above 1")
    machine.path.prove(3 * (ROW + 1) ** 2 - result.poly, "three squares")


def dot_domain(machine: Machine) -> list[Any]:
    row = [machine.path.atom(f"r{i}", -ROW - 1, ROW) for i in range(3)]
    vector = [machine.path.atom(f"v{i}", -(2**15), 2**15 - 1) for i in range(3)]
    return [machine.array("int32_t", row), machine.array("int32_t", vector)]


def dot_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    """So little above 3 * 2^15 that a mantissa of 14 bits times it stays within 32."""
    machine.path.prove(3 * 2**15 + 6 - result.poly, "not above")
    machine.path.prove(result.poly + 3 * 2**15 + 7, "not below")
    require((3 * 2**15 + 7) * (2**14 - 1) < 2**31, "times the scale")


def reach_domain(machine: Machine) -> list[Any]:
    path = machine.path
    mesh = machine.struct("el_mesh", radius=path.atom("radius", 0, 2**16 - 1))
    machine.put(mesh.content["centre"], [path.atom(f"c{i}", -(2**15), 2**15 - 1) for i in range(3)])
    return [Pointer([mesh])]


def reach_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    radius = machine.poly(arguments[0].cell, "radius")
    machine.path.prove(2**15 + radius + 1 - result.poly, "not above")
    machine.path.prove(result.poly - radius - 1, "not below")


def beside_domain(machine: Machine) -> list[Any]:
    """|x| < 2^15 * 1.74: of a vector below 2^15 along each axis, by a row of length 1."""
    path = machine.path
    most = 2**15 * 174 // 100
    centre = [path.atom(axis, -most, most) for axis in "xyz"]
    sphere = machine.struct(
        "el_cull_sphere", radius=path.atom("radius", 16, 2**15 + 16), unit=(0, 16)[path.choose(path.atom("unit", 0, 1))]
    )
    machine.put(sphere.content["centre"], centre)
    view = machine.struct("el_view", projection=path.choose(path.atom("projection", 0, 1)))
    exponent = (13, 16, 17, 30, 48)[path.choose(path.atom("exponent", 0, 4))]
    focal = view.content["focal"].content[0]
    machine.put(focal.content["mantissa"], path.atom("mantissa", 2**30, 2**31 - 1))
    machine.put(focal.content["exponent"], exponent)
    return [Pointer([view]), Pointer([sphere]), machine.exactly("uint32_t", 0)]


def beside_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    require(2**15 * 174 // 100 * (2**15 - 1) < 2**31, "the product")


SUBJECTS = {
    "row": Subject(CULL, "row_of", row_domain, row_check),
    "dot": Subject(CULL, "dot", dot_domain, dot_check),
    "reach": Subject(CULL, "el_cull_reach", reach_domain, reach_check),
    # Its one product: modular, because nothing knows that x less the radius is positive where it is multiplied.
    "beside": Subject(CULL, "is_beside", beside_domain, beside_check, modular=["is_beside"]),
}


@pytest.mark.parametrize("name", SUBJECTS)
def test_all_values(name: str) -> None:
    SUBJECTS[name].prove()


@pytest.mark.parametrize(
    ("name", "old", "new"),
    [
        ("row", "row_q30[i] >> (30 - UNIT_BITS)", "row_q30[i] >> (29 - UNIT_BITS)"),
        ("dot", ">> UNIT_BITS;", ">> (UNIT_BITS - 1);"),
        ("reach", "mesh->radius + 1U", "mesh->radius"),
        ("beside", "(x < 0 ? -x : x)", "65536 * (x < 0 ? -x : x)"),
    ],
)
def test_the_proof_can_fail(name: str, old: str, new: str) -> None:
    SUBJECTS[name].fails_with(Fault(CULL, old, new))


@pytest.mark.parametrize("name", SUBJECTS)
def test_the_compiler_agrees(name: str) -> None:
    SUBJECTS[name].agree(count=100)
