"""base/fixed, raster/plane: products that are written twice, for most cores and for Armv6-M, are the plain product.

A factor is given as its half words, so that the C's own splitting of it leaves no unknown behind: what it adds up is
then the plain product as a polynomial, or differs from it by multiples of 2^64 where it is meant modulo that.
"""

from __future__ import annotations

from typing import Any

import pytest

from proof import ARMV6M, Fault, Machine, Number, Poly, Subject, congruent

FIXED, FIXED_H, PLANE = "base/fixed.c", "base/fixed.h", "raster/plane.c"
RING = 1 << 64
MOST_PIXELS = 1 << 22  # el_plane_times


def word(machine: Machine, name: str) -> Poly:
    """uint32_t, as its half words."""
    return machine.path.atom(f"{name}_high", 0, 65535) * 65536 + machine.path.atom(f"{name}_low", 0, 65535)


def signed_word(machine: Machine, name: str) -> Poly:
    """int32_t, as its half words, of which the upper one has the sign."""
    upper = machine.path.atom(f"{name}.high", -(2**15), 2**15 - 1)
    return upper * 2**16 + machine.path.atom(f"{name}.low", 0, 2**16 - 1)


def double_word(machine: Machine, name: str) -> Poly:
    """uint64_t, as its upper word and the lower one's half words."""
    return machine.path.atom(name, 0, 2**32 - 1) * 2**32 + word(machine, name)


def whole(low: int, high: int) -> Any:
    """Any number of these, in one piece."""
    return lambda machine, name: machine.path.atom(name, low, high)


def times_domain(machine: Machine) -> list[Any]:
    """Counts within 16 bits, and beyond them on either side."""
    a, count = double_word(machine, "a"), machine.number("int32_t", "count", 1 - MOST_PIXELS, MOST_PIXELS - 1)
    within(machine, count.poly, -65535, 65535)
    return [machine.exactly("uint64_t", a), count]


def within(machine: Machine, number: Poly, low: int, high: int) -> None:
    """Splits the path: below, between, above; the number's bounds are those of its part then."""
    if machine.path.decide(number - low, low - 1 - number):
        machine.path.decide(high - number, number - high - 1)


def factors(a: tuple[str, Any], b: tuple[str, Any]) -> Any:
    """Two factors, each by its type and what makes it."""
    return lambda machine: [
        machine.exactly(c_type, make(machine, name)) for (c_type, make), name in ((a, "a"), (b, "b"))
    ]


def down_domain(machine: Machine) -> list[Any]:
    """el_product_down_11: |a b| < 2^42, and 2^41 where b < 0."""
    path = machine.path
    a, b_high = path.atom("a", 1 - 2**15, 2**15 - 1), path.atom("b_high", -(2**15), 2**15 - 1)
    b = b_high * 2**16 + path.atom("b_low", 0, 65535)
    path.decide(a, -a - 1)
    most = 2**42 if path.decide(b_high, -b_high - 1) else 2**41
    path.assume(most - 1 - a * b)
    path.assume(most + a * b)
    return [machine.exactly("int32_t", a), machine.exactly("int32_t", b)]


def down_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    """floor(a b / 2^11)."""
    a, b = (argument.poly for argument in arguments)
    rest = a * b - result.poly * 2**11
    machine.path.prove(rest, "not above")
    machine.path.prove(2**11 - 1 - rest, "not below")


def modulo_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    a, b = (argument.poly for argument in arguments)
    congruent(result.poly, a * b, RING, "a b modulo 2^64")


def exact_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    a, b = (argument.poly for argument in arguments)
    machine.path.prove(result.poly - a * b, "a b", zero=True)


def high_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    """floor(a b / 2^32)."""
    a, b = (argument.poly for argument in arguments)
    rest = a * b - result.poly * 2**32
    machine.path.prove(rest, "not above")
    machine.path.prove(2**32 - 1 - rest, "not below")


def near_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    """a b / 2^32, too low by less than EL_PRODUCT_ERROR."""
    a, b = (argument.poly for argument in arguments)
    rest = a * b - result.poly * 2**32
    machine.path.prove(rest, "not too high")
    machine.path.prove(machine.constant(machine.unit.constants["EL_PRODUCT_ERROR"]) * 2**32 - 1 - rest, "not too low")


def upper_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    """floor(a b / 2^16)."""
    a, b = (argument.poly for argument in arguments)
    rest = a * b - result.poly * 2**16
    machine.path.prove(rest, "not above")
    machine.path.prove(2**16 - 1 - rest, "not below")


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


WORDS = ("uint64_t", double_word)
HALVES, SIGNED_HALVES = ("uint32_t", word), ("int32_t", signed_word)
UNSIGNED = ("uint32_t", whole(0, 2**32 - 1))
SHORT, SHORT_SIGNED = ("uint32_t", whole(0, 65535)), ("int32_t", whole(-65535, 65535))


def product_u64(machine: Machine, arguments: list[Any]) -> Number:
    """el_product_u64, proven here too."""
    a, b = (argument.poly for argument in arguments)
    return machine.exactly("uint64_t", a * b)


def subjects(core: str) -> dict[str, Subject]:
    def product(name: str, domain: Any, check: Any, *modular: str, file: str = FIXED) -> Subject:
        return Subject(file, name, domain, check, modular, core=core)

    def of_product(name: str, domain: Any, check: Any) -> Subject:
        return Subject(FIXED, name, domain, check, [name], {"el_product_u64": product_u64}, core=core)

    made = [
        product("el_multiply_u16", factors(WORDS, SHORT), modulo_check, "el_multiply_u16"),
        product("el_multiply_u64", factors(WORDS, SHORT_SIGNED), modulo_check, "el_multiply_u64", "el_multiply_u16"),
        product("el_product_u64", factors(HALVES, HALVES), exact_check),
        product("el_product_u32_u16", factors(HALVES, SHORT), exact_check),
        product("el_product_near_u32", factors(HALVES, HALVES), near_check),
        product("el_product_near_i32", factors(SIGNED_HALVES, SIGNED_HALVES), near_check),
        product("el_product_high_u16", factors(HALVES, SHORT), upper_check),
        of_product("el_product_high_u32", factors(UNSIGNED, UNSIGNED), high_check),
        product("el_product_down_11", down_domain, down_check),
        product("el_product_i32", factors(SIGNED_HALVES, SIGNED_HALVES), exact_check),
        product("el_product_i32_u32", factors(SIGNED_HALVES, HALVES), exact_check, "el_product_i32_u32"),
        product("el_multiply_high_i32_u32", factors(SIGNED_HALVES, HALVES), high_check),
        product(
            "el_plane_times",
            times_domain,
            modulo_check,
            *("el_plane_times", "el_multiply_u64", "el_multiply_u16"),
            file=PLANE,
        ),
        product("el_doubled_area", area_domain, area_check, "el_doubled_area", file=PLANE),
    ]
    return {subject.function: subject for subject in made}


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
        ("el_multiply_u16", FIXED_H, "(uint64_t)middle << 16", "(uint64_t)middle << 17"),
        ("el_multiply_u64", FIXED_H, "b < 0 ? 0 - product", "b < -1 ? 0 - product"),
        ("el_product_u64", FIXED_H, "a_low * b_high + (first & 0xFFFFU)", "a_low * b_high + first"),
        (
            "el_product_u64",
            FIXED_H,
            "uint32_t high = a_high * b_high + (first >> 16)",
            "uint32_t high = a_high * b_high",
        ),
        ("el_product_u32_u16", FIXED_H, "(a >> 16) * b + (low >> 16)", "(a >> 16) * b"),
        ("el_product_near_u32", FIXED_H, "((a_high * (b & 0xFFFFU)) >> 16) + ", ""),
        ("el_product_near_u32", FIXED_H, "(((a & 0xFFFFU) * b_high) >> 16)", "(((a & 0xFFFFU) * b_high) >> 15)"),
        ("el_product_near_i32", FIXED_H, "((a_high * b_low) >> 16) + ", ""),
        ("el_product_near_i32", FIXED_H, "((a_low * b_high) >> 16)", "((a_low * b_high) >> 17)"),
        ("el_product_high_u16", FIXED_H, "(a >> 16) * b + (((a & 0xFFFFU) * b) >> 16)", "(a >> 16) * b"),
        ("el_product_high_u32", FIXED_H, "(el_product_u64(a, b) >> 32)", "(el_product_u64(a, b) >> 33)"),
        ("el_product_down_11", FIXED_H, "a * (b >> 16) * (1 << 5)", "a * (b >> 16) * (1 << 4)"),
        ("el_product_i32", FIXED_H, "a_low * b_high + (int32_t)((uint32_t)first & 0xFFFFU)", "a_low * b_high + first"),
        ("el_product_i32_u32", FIXED_H, "(a, b) << 32 | (uint32_t)a * b", "(a, b) << 32 | (uint32_t)a * (b + 1U)"),
        ("el_multiply_high_i32_u32", FIXED_H, "(first >> 16) + (int32_t)(second >> 16)", "(first >> 16)"),
        ("el_plane_times", "raster/plane.h", "(count + 0xFFFF) <= 2U * 0xFFFFU", "(count + 0xFFFF) <= 2U * 0x1FFFFU"),
        ("el_doubled_area", "raster/plane.h", "bias = 1U << 14", "bias = 1U << 15"),
    ],
)
def test_the_proof_can_fail(name: str, file: str, old: str, new: str) -> None:
    subjects(ARMV6M)[name].fails_with(Fault(file, old, new))
