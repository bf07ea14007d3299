"""base/fixed, raster/plane: products that are written twice, for most cores and for Armv6-M, are the plain product.

A factor is given as its half words, so that the C's own splitting of it leaves no unknown behind: what it adds up is
then the plain product as a polynomial, or differs from it by multiples of 2^64 where it is meant modulo that.
"""

from __future__ import annotations

from typing import Any

import pytest

from proof import ARMV6M, Fault, Machine, Number, Poly, Subject, congruent

FIXED, PLANE = "base/fixed.c", "raster/plane.c"
RING = 1 << 64
MOST_PIXELS = 1 << 22  # el_plane_times


def word(machine: Machine, name: str) -> Poly:
    """uint32_t, as its half words."""
    return machine.path.atom(f"{name}_high", 0, 65535) * 65536 + machine.path.atom(f"{name}_low", 0, 65535)


def double_word(machine: Machine) -> Number:
    """uint64_t, as its upper word and the lower one's half words."""
    return machine.exactly("uint64_t", machine.path.atom("a", 0, 2**32 - 1) * 2**32 + word(machine, "a"))


def multiply_domain(machine: Machine) -> list[Any]:
    return [double_word(machine), machine.number("int32_t", "b", -65535, 65535)]


def times_domain(machine: Machine) -> list[Any]:
    """Counts within 16 bits, and beyond them on either side."""
    a, count = double_word(machine), machine.number("int32_t", "count", 1 - MOST_PIXELS, MOST_PIXELS - 1)
    within(machine, count.poly, -65535, 65535)
    return [a, count]


def within(machine: Machine, number: Poly, low: int, high: int) -> None:
    """Splits the path: below, between, above; the number's bounds are those of its part then."""
    if machine.path.decide(number - low, low - 1 - number):
        machine.path.decide(high - number, number - high - 1)


def product_domain(machine: Machine) -> list[Any]:
    return [machine.exactly("uint32_t", word(machine, name)) for name in "ab"]


def signed_domain(machine: Machine) -> list[Any]:
    a = machine.path.atom("a_high", -32768, 32767) * 65536 + machine.path.atom("a_low", 0, 65535)
    return [machine.exactly("int32_t", a), machine.number("int16_t", "b")]


def modulo_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    a, b = (argument.poly for argument in arguments)
    congruent(result.poly, a * b, RING, "a b modulo 2^64")


def exact_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    a, b = (argument.poly for argument in arguments)
    machine.path.prove(result.poly - a * b, "a b", zero=True)


def area_domain(machine: Machine) -> list[Any]:
    """Of the differences alone: the first corner is the origin. Each difference is small, or too large on one side."""
    path = machine.path
    most = 2 * machine.constant(machine.unit.constants["EL_GUARD_SUB"])
    differences = [path.atom(name, -most, most) for name in ("dx1", "dx2", "dy1", "dy2")]
    for d in differences:
        within(machine, d, -(2**14), 2**14 - 1)
    return [machine.array("int32_t", [Poly.of(0), *differences[i : i + 2]]) for i in (0, 2)]


def area_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    (_, x1, x2), (_, y1, y2) = ([machine.poly(cell) for cell in pointer.cells] for pointer in arguments)
    machine.path.prove(result.poly - (x1 * y2 - x2 * y1), "the doubled area", zero=True)


def subjects(core: str) -> dict[str, Subject]:
    return {
        "el_multiply_u64": Subject(
            FIXED, "el_multiply_u64", multiply_domain, modulo_check, ["el_multiply_u64"], core=core
        ),
        "el_product_u64": Subject(FIXED, "el_product_u64", product_domain, exact_check, core=core),
        "el_product_i32_i16": Subject(FIXED, "el_product_i32_i16", signed_domain, exact_check, core=core),
        "el_plane_times": Subject(
            PLANE, "el_plane_times", times_domain, modulo_check, ["el_plane_times", "el_multiply_u64"], core=core
        ),
        "el_doubled_area": Subject(PLANE, "el_doubled_area", area_domain, area_check, ["el_doubled_area"], core=core),
    }


CORES = pytest.mark.parametrize("core", ["", ARMV6M], ids=["any", "armv6m"])
NAMES = pytest.mark.parametrize("name", subjects(""))


@CORES
@NAMES
def test_every_product(name: str, core: str) -> None:
    subjects(core)[name].prove()


@CORES
@NAMES
def test_the_compiler_agrees(name: str, core: str) -> None:
    subjects(core)[name].agree(count=200)


@pytest.mark.parametrize("bits", [6, 8])
def test_areas_with_more_bits(bits: int) -> None:
    for core in ("", ARMV6M):
        subjects(core)["el_doubled_area"].prove(bits)


@pytest.mark.parametrize(
    ("name", "file", "old", "new"),
    [
        ("el_multiply_u64", "base/fixed.h", "factor + (middle >> 16)", "factor + (middle >> 17)"),
        ("el_multiply_u64", "base/fixed.h", "b < 0 ? 0 - product", "b < -1 ? 0 - product"),
        ("el_product_u64", "base/fixed.h", "a_low * b_high + (first & 0xFFFFU)", "a_low * b_high + first"),
        ("el_product_u64", "base/fixed.h", "(first >> 16) + (second >> 16)", "(first >> 16)"),
        ("el_product_i32_i16", "base/fixed.h", "(a & 0xFFFF) * b;", "(a & 0x7FFF) * b;"),
        ("el_plane_times", "raster/plane.h", "(count + 0xFFFF) <= 2U * 0xFFFFU", "(count + 0xFFFF) <= 2U * 0x1FFFFU"),
        ("el_doubled_area", "raster/plane.h", "bias = 1U << 14", "bias = 1U << 15"),
    ],
)
def test_the_proof_can_fail(name: str, file: str, old: str, new: str) -> None:
    subjects(ARMV6M)[name].fails_with(Fault(file, old, new))
