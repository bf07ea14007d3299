"""geometry/vector, quaternion, animation: no product and no sum leaves 64 bits, for any numbers that callers may give;
rows are applied exactly, and what has components within 1 keeps them there.

That lengths stay 1 and angles right is for tests/unit/test_quaternion.c, against doubles.
"""

from __future__ import annotations

from typing import Any

import pytest

from proof import Fault, Machine, Number, Pointer, Subject

VECTOR, QUATERNION, ANIMATION = "geometry/vector.c", "geometry/quaternion.c", "geometry/animation.c"
HEADER = "geometry/vector.h"
WORD, UNIT, PLACE = 2**31, 2**30, 2**32 - 1
PART = 2**31  # animation.c: all of a way


def shift_i64(machine: Machine, arguments: list[Any]) -> Number:
    """el_shift_i64 by a positive number: rounded to nearest, ties up (test_scaling_rounds_to_nearest)."""
    value, shift = arguments[0].poly, arguments[1].poly.known
    return machine.exactly("int64_t", machine.path.floor(value + (1 << shift >> 1), 1 << shift))


def scale_i64(machine: Machine, arguments: list[Any]) -> Number:
    """el_scale_i64: the same of value * factor. Pre: it fits 63 bits."""
    value, factor, shift = (argument.poly for argument in arguments)
    path, by = machine.path, 1 << shift.known
    low, high = path.bounds(value)
    most = max(abs(low), abs(high))
    assert path.bounds(factor)[1] <= by, "a part of the whole"
    scaled = path.atom("scaled", -most, most)
    rest = value * factor * 2 + by - scaled * (2 * by)
    path.assume(rest)
    path.assume(2 * by - 1 - rest)
    return machine.exactly("int64_t", scaled)


def along_domain(machine: Machine) -> list[Any]:
    path = machine.path
    row = [path.atom(f"r{i}", -WORD, WORD - 1) for i in range(3)]
    v = [path.atom(f"v{i}", -PLACE, PLACE) for i in range(3)]
    return [machine.array("int32_t", row), machine.array("int64_t", v)]


def along_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    """Half a unit, and less than a quarter of one for each of three products that lost two bits of 30."""
    row, v = ([machine.poly(cell) for cell in pointer.cells] for pointer in arguments)
    exact = row[0] * v[0] + row[1] * v[1] + row[2] * v[2]
    machine.path.prove(exact - result.poly * UNIT + UNIT // 2, "not above")
    machine.path.prove(result.poly * UNIT + UNIT // 2 + 12 - exact, "not below")


def quaternion(machine: Machine, name: str, most: int) -> Any:
    cell = machine.struct("el_quaternion")
    machine.put(cell.content["q30"], [machine.path.atom(f"{name}{i}", -most, min(most, WORD - 1)) for i in range(4)])
    return cell


def within_1(machine: Machine, cell: Any) -> None:
    for component in cell.content["q30"].content:
        machine.path.prove(UNIT - machine.poly(component), "at most 1")
        machine.path.prove(UNIT + machine.poly(component), "at least -1")


def polished(machine: Machine, arguments: list[Any]) -> Any:
    """polish, proven here: of components within 1, others within 1."""
    within_1(machine, arguments[0])
    return quaternion(machine, "polished", UNIT)


def clamped(machine: Machine, arguments: list[Any]) -> Number:
    """el_clamp_unit: within 1."""
    return machine.exactly("int32_t", machine.path.atom("clamped", -UNIT, UNIT))


def mix_domain(smooth: int) -> Any:
    def domain(machine: Machine) -> list[Any]:
        path = machine.path
        place = machine.struct(
            "place",
            part=path.atom("part", 1, PART - 1),
            has_before=path.choose(path.atom("has_before", 0, 1)),
            has_after=path.choose(path.atom("has_after", 0, 1)),
            slope_before=path.atom("slope_before", 0, PART - 1),
            slope_after=path.atom("slope_after", 0, PART - 1),
        )
        values = [path.atom(f"value{i}", -(2**32), 2**32) for i in range(4)]
        return [Pointer([place]), machine.exactly("int32_t", smooth), machine.array("int64_t", values)]

    return domain


SHIFT = {"el_shift_i64": shift_i64}
SCALE = {"el_scale_i64": scale_i64}
CLAMP = {**SHIFT, "el_clamp_unit": clamped}

SUBJECTS = {
    "along": Subject(VECTOR, "el_vector_along", along_domain, along_check, contracts=SHIFT),
    "polish": Subject(
        QUATERNION,
        "polish",
        lambda machine: [quaternion(machine, "q", UNIT)],
        lambda machine, _, result: within_1(machine, result),
        contracts=CLAMP,
    ),
    "multiply": Subject(
        QUATERNION,
        "el_quaternion_multiply",
        lambda machine: [Pointer([quaternion(machine, name, WORD)]) for name in "pq"],
        lambda machine, _, result: within_1(machine, result),
        contracts={**CLAMP, "polish": polished},
    ),
    "smooth": Subject(ANIMATION, "mix", mix_domain(1), modular=["el_scale_i64"], contracts=SCALE),
    "linear": Subject(ANIMATION, "mix", mix_domain(0), modular=["el_scale_i64"], contracts=SCALE),
}


@pytest.mark.parametrize("name", SUBJECTS)
def test_all_values(name: str) -> None:
    SUBJECTS[name].prove()


@pytest.mark.parametrize(
    ("name", "file", "old", "new"),
    [
        ("along", VECTOR, "v[i] * row_q30[i] >> 2;", "v[i] * row_q30[i] >> 1;"),
        ("along", VECTOR, "el_shift_i64(sum_q28, 28)", "el_shift_i64(sum_q28, 27)"),
        ("polish", QUATERNION, "q.q30[i] * excess_q30, 31", "q.q30[i] * excess_q30 * 8, 34"),
        ("multiply", HEADER, "(a_q30, b_q30) >> 2", "(a_q30, b_q30)"),
        ("smooth", ANIMATION, "3 * way - 2 * leaving", "(3 * way - 2 * leaving) * (1 << 30)"),
        ("linear", ANIMATION, "values[1] + times(way", "(values[1] << 30) + times(way"),
    ],
)
def test_the_proof_can_fail(name: str, file: str, old: str, new: str) -> None:
    SUBJECTS[name].fails_with(Fault(file, old, new))


@pytest.mark.parametrize("name", SUBJECTS)
def test_the_compiler_agrees(name: str) -> None:
    SUBJECTS[name].agree(count=100)
