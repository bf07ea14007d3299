"""What callers may rely on about division, products, planes and knots, after the proofs that are named for them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from c_execution import Contract, Machine
from c_values import Cell, Number, Pointer
from symbolic import Poly, require

WORD = 1 << 32

# At a covered pixel a plane is off by less than so many units of 2^-32 (test_planes_are_exact_modulo_2_64).
PLANE_ERROR = 8161

# Texture coordinates are within TEXELS of 0; knots of theirs are off by less than KNOT_ERROR units of 2^-16 texel, and
# within MOST_KNOT of 0 (test_texture_knots_keep_within_3_units).
TEXELS, KNOT_ERROR = 2048, 3
MOST_KNOT = (TEXELS << 16) + 2**27 + 1


def divide_words(machine: Machine, arguments: list[Any]) -> Number:
    """el_divide_words: quotient * normalised + remainder = high * 2^32 + low, 0 <= remainder < normalised."""
    high, low, divisor, remainder = arguments
    d = machine.poly(divisor.cell, "normalised")
    path = machine.path
    path.prove(d - (1 << 31), "el_divide_words: the divisor has its top bit")
    path.prove(d - 1 - high.poly, "el_divide_words: high < normalised")
    n = high.poly * WORD + low.poly
    quotient = path.atom("quotient", 0, WORD - 1)
    rest = n - quotient * d
    path.assume(rest)
    path.assume(d - 1 - rest)
    machine.put(remainder.cell, rest)
    return machine.exactly("uint32_t", quotient)


def divisor_make(machine: Machine, arguments: list[Any]) -> Cell:
    """el_divisor_make: an el_divisor that stands for d; its members are not known."""
    d = arguments[0].poly
    machine.path.prove(d - 1, "el_divisor_make: d >= 1")
    cell = machine.allocate(machine.type_named("el_divisor"))
    cell.stands_for = d
    machine.put(cell.content["reciprocal"], machine.path.atom("reciprocal", 0, WORD - 1))
    machine.put(cell.content["shift"], machine.path.atom("shift", 0, 31))
    return cell


def divisor_of(argument: Pointer) -> Poly:
    d = argument.cell.stands_for
    assert d is not None, "an el_divisor that el_divisor_make has not made"
    return d


def divide_u64(machine: Machine, arguments: list[Any]) -> Number:
    """el_divide_u64: floor(n / d). Pre: below 2^32."""
    n, d = arguments[0].poly, divisor_of(arguments[1])
    machine.path.prove(d * WORD - 1 - n, "el_divide_u64: the quotient fits 32 bits")
    return machine.exactly("uint32_t", _floor(machine, n, d, 0, WORD - 1))


def divide_floor(machine: Machine, arguments: list[Any]) -> Number:
    """el_divide_floor_i64: floor(n / d). Pre: -2^31 <= n / d < 2^31."""
    n, d = arguments[0].poly, divisor_of(arguments[1])
    half = WORD // 2
    machine.path.prove(n + d * half, "el_divide_floor_i64: -2^31 <= n / d")
    machine.path.prove(d * half - 1 - n, "el_divide_floor_i64: n / d < 2^31")
    return machine.exactly("int32_t", _floor(machine, n, d, -half, half - 1))


def _floor(machine: Machine, n: Poly, d: Poly, low: int, high: int) -> Poly:
    path = machine.path
    if path.holds(d * (WORD // 2) - 1 - n):
        high = min(high, WORD // 2 - 1)
    return path.new_quotient(n, d, low, high)


def ratio_q32(machine: Machine, arguments: list[Any]) -> Number:
    """el_ratio_q32, el_wide_ratio_q32: floor(2^32 n / d). Pre: d >= 1, |n / d| < 2^31."""
    n, d = (argument.poly for argument in arguments)
    path = machine.path
    path.prove(d - 1, "the ratio's divisor is positive")
    # A number of pixels on the screen, or any that there may be.
    whole = 1 << (12 if path.holds(d * 4096 - 1 - n) and path.holds(n + d * 4096 - 1) else 31)
    path.prove(d * whole - 1 - n, "n / d < 2^31")
    path.prove(n + d * whole - 1, "-2^31 < n / d")
    ratio = path.atom("ratio", -whole * WORD, whole * WORD - 1)
    path.assume(n * WORD - ratio * d)
    path.assume(ratio * d + d - 1 - n * WORD)
    return machine.exactly("int64_t", ratio)


def reciprocal_of_short(machine: Machine, arguments: list[Any]) -> Number:
    """el_reciprocal_of_short: floor((2^31 - 1) / d). Pre: 1 <= d <= EL_SHORT_DIVISOR."""
    d, path = arguments[0].poly, machine.path
    path.prove(d - 1, "el_reciprocal_of_short: d >= 1")
    path.prove(machine.constant(machine.unit.constants["EL_SHORT_DIVISOR"]) - d, "el_reciprocal_of_short: d is short")
    return machine.exactly("int32_t", path.new_quotient(Poly.of(WORD // 2 - 1), d, 0, WORD // 2 - 1))


def product_down_11(machine: Machine, arguments: list[Any]) -> Number:
    """el_product_down_11: floor(a b / 2^11). Pre: |a| < 2^15, 0 <= b, and it fits 32 bits, which its caller proves."""
    a, b = (argument.poly for argument in arguments)
    machine.path.prove(2**15 - 1 - a, "el_product_down_11: a < 2^15")
    machine.path.prove(2**15 - 1 + a, "el_product_down_11: a > -2^15")
    machine.path.prove(b, "el_product_down_11: b >= 0")
    return machine.exactly("int32_t", machine.path.floor(a * b, 1 << 11))


def reciprocal_near(machine: Machine, arguments: list[Any]) -> Number:
    """el_reciprocal_near: r with 1 <= 2^63 - r d < EL_RECIPROCAL_ERROR d. Pre: d has its top bit.

    So r > 2^63 / d - EL_RECIPROCAL_ERROR > 2^31 - EL_RECIPROCAL_ERROR.
    """
    d, path = arguments[0].poly, machine.path
    path.prove(d - (1 << 31), "el_reciprocal_near: the divisor has its top bit")
    error = machine.constant(machine.unit.constants["EL_RECIPROCAL_ERROR"])
    reciprocal = path.atom("r", (1 << 31) - error, WORD - 1)
    rest = (1 << 63) - reciprocal * d
    path.assume(rest - 1)
    path.assume(d * error - 1 - rest)
    return machine.exactly("uint32_t", reciprocal)


def reciprocal_beside(machine: Machine, arguments: list[Any]) -> Number:
    """el_reciprocal_beside: r with -EL_RECIPROCAL_HIGH d < 2^61 - r d < EL_RECIPROCAL_LOW d. Pre: d has 31 bits.

    So 2^30 - EL_RECIPROCAL_LOW < r < 2^31 + EL_RECIPROCAL_HIGH (test_division_is_exact).
    """
    d, path = arguments[0].poly, machine.path
    path.prove(d - (1 << 30), "el_reciprocal_beside: the divisor has 31 bits")
    path.prove((1 << 31) - 1 - d, "el_reciprocal_beside: and no more")
    low, high = (machine.constant(machine.unit.constants[f"EL_RECIPROCAL_{end}"]) for end in ("LOW", "HIGH"))
    reciprocal = path.atom("r", (1 << 30) - low, (1 << 31) + high)
    rest = (1 << 61) - reciprocal * d
    path.assume(rest + d * high - 1)
    path.assume(d * low - 1 - rest)
    return machine.exactly("uint32_t", reciprocal)


def product_near(machine: Machine, arguments: list[Any]) -> Number:
    """el_product_near_u32: a b / 2^32, too low by less than EL_PRODUCT_ERROR (test_products_are_exact)."""
    a, b = (argument.poly for argument in arguments)
    product = machine.path.atom("product", 0, WORD - 1)
    error = machine.constant(machine.unit.constants["EL_PRODUCT_ERROR"])
    machine.path.assume(a * b - product * WORD)
    machine.path.assume((product + error) * WORD - 1 - a * b)
    return machine.exactly("uint32_t", product)


def product_high_u16(machine: Machine, arguments: list[Any]) -> Number:
    """el_product_high_u16: floor(a b / 2^16). Pre: b < 2^16 (test_products_are_exact)."""
    a, b = (argument.poly for argument in arguments)
    machine.path.prove(65535 - b, "el_product_high_u16: b < 2^16")
    return machine.exactly("uint32_t", machine.path.floor(a * b, 65536))


def weighted(a: Iterable[Poly | int], b: Iterable[Poly]) -> Poly:
    """The sum of a[i] b[i]."""
    return sum((y * x for x, y in zip(a, b, strict=True)), Poly.of(0))


def _times(name: str, most: int) -> Contract:
    """gradient * count modulo 2^64. Pre: |count| < most (test_products_are_exact)."""

    def contract(machine: Machine, arguments: list[Any]) -> Number:
        gradient, count = (argument.poly for argument in arguments)
        require(machine.path.within(count, 1 - most, most - 1), f"{name}: |count| < {most}")
        turns = machine.path.atom("turns", -(2**90), 2**90)
        return machine.exactly("uint64_t", gradient * count - turns * WORD * WORD)

    return contract


plane_times, multiply_u64 = _times("el_plane_times", 1 << 22), _times("el_multiply_u64", 1 << 16)
multiply_u16 = _times("el_multiply_u16", 1 << 16)


DIVISION = {
    "el_divisor_make": divisor_make,
    "el_divide_u64": divide_u64,
    "el_divide_floor_i64": divide_floor,
}
