"""base/divide: the reciprocal, the quotient of two words by one, and all that is built on them.

The reciprocal of d is v = floor((2^64 - 1) / d) - 2^32. With B = 2^32 that says: k = B^2 - (B + v) d is in 1..d. It is
checked for each of the 2^31 normalised divisors; so is el_reciprocal_near: 1 <= 2^63 - r d < EL_RECIPROCAL_ERROR d. On
cores without a divider both begin with a table, whose every entry is checked against the division.

el_divide_words takes p = (B + v) high + low, tries q = p div B + 1, and corrects. With q0 = p mod B and
r = high B + low - q d, the definition of k gives B r = high k + low (B - d) + (q0 - B) d, from which

    -d <= r,    q0 + 1 - B <= r,    r < max(B - d, q0)

follow as polynomial inequalities (Möller and Granlund, theorem 3). They make the two comparisons of 32-bit remainders
find the right quotient; the rest is linear.
"""

from __future__ import annotations

import subprocess
from pathlib import Path as FilePath
from typing import Any

import pytest

import contracts
from c_source import ARMV6M, SOURCES, core_options, faulty_tree
from proof import Fact, Fault, Machine, Number, Pointer, Poly, Subject, compile_c

B = 1 << 32
FILE, HEADER = "base/divide.c", "base/divide.h"

EVERY_DIVISOR = """
#include "base/divide.c"
#include <stdio.h>

int main(void)
{
    for (uint32_t d = 1U << 31; d != 0; d++) {
        /* 2^64 - 1 - (2^32 + v) d must be a remainder. It is below d modulo 2^64 only if it is so without the modulus,
         * since (2^32 + v + 1) d <= 2^33 (2^32 - 1) < 2^65 - 1. */
        const uint64_t rest = ~((uint64_t)el_reciprocal_word(d) * d + ((uint64_t)d << 32));
        if (rest >= d) {
            printf("the reciprocal of %u is %u\\n", d, el_reciprocal_word(d));
            return 1;
        }
    }
    return 0;
}
"""

EVERY_NEAR = """
#include "base/divide.c"
#include <stdio.h>

int main(void)
{
    for (uint32_t d = 1U << 31; d != 0; d++) {
        /* Too high a one would wrap to 2^63 at least. */
        const uint64_t rest = (1ULL << 63) - (uint64_t)el_reciprocal_near(d) * d;
        if (rest == 0 || rest >= (uint64_t)EL_RECIPROCAL_ERROR * d) {
            printf("the reciprocal of %u is near %u\\n", d, el_reciprocal_near(d));
            return 1;
        }
    }
    return 0;
}
"""

EVERY_ENTRY = """
#include "base/divide.c"
#include "base/reciprocals.c"
#include <stdio.h>

static int differ(uint32_t d, uint32_t by_table, uint32_t divided)
{
    return by_table != divided && printf("the reciprocal of %u by table is %u\\n", d, by_table);
}

int main(void)
{
    int wrong = 0;
    for (uint32_t d = 1; d <= EL_SHORT_DIVISOR; d++) {
        wrong |= differ(d, el_reciprocal_of_short(d), 0xFFFFFFFFU / d);
    }
    for (uint32_t d = 512; d < 1024; d++) {
        wrong |= differ(d, el_first_guess(d), ((1U << 24) - (1U << 14) + (1U << 9)) / d);
    }
    for (uint32_t d = (1U << 15) + 1U; d <= 1U << 16; d++) {
        wrong |= differ(d, el_reciprocal_u16(d), 0x80000000U / d);
    }
    return wrong;
}
"""


def first_wrong(folder: FilePath, text: str, tree: FilePath = SOURCES, core: str = "") -> str:
    """The first divisor whose reciprocal is wrong, or nothing."""
    program = folder / "every_divisor"
    compile_c(text, program, "-O3", *core_options(core), tree=tree)
    return subprocess.run([str(program)], capture_output=True, text=True, check=False, timeout=300).stdout


EVERY = pytest.mark.parametrize(
    ("text", "core"),
    [(EVERY_DIVISOR, ""), (EVERY_NEAR, ""), (EVERY_ENTRY, ARMV6M)],
    ids=["exact", "near", "tables"],
)


@EVERY
def test_the_reciprocal_of_every_normalised_divisor(tmp_path: FilePath, text: str, core: str) -> None:
    assert first_wrong(tmp_path, text, core=core) == ""


TABLE = "base/reciprocals.c"


@pytest.mark.parametrize(
    ("text", "core", "fault"),
    [
        (EVERY_DIVISOR, "", Fault(HEADER, "(d >> 11) + 1U", "(d >> 11)")),
        (EVERY_DIVISOR, "", Fault(HEADER, "(v1, e) >> 33", "(v1, e) >> 34")),
        (EVERY_NEAR, "", Fault(HEADER, "EL_RECIPROCAL_ERROR = 18", "EL_RECIPROCAL_ERROR = 17")),
        (EVERY_NEAR, "", Fault(HEADER, "0x7FFFFFFFU - product", "0x80000010U - product")),
        (EVERY_ENTRY, ARMV6M, Fault(HEADER, "* (left >> 5)) >> 24", "* (left >> 5)) >> 25")),
        (EVERY_ENTRY, ARMV6M, Fault(TABLE, "0x7FE1, 0x7FA1", "0x7FE1, 0x7FA2")),
        (EVERY_ENTRY, ARMV6M, Fault(TABLE, "0x00804020", "0x00804021")),
    ],
    ids=lambda value: value.new if isinstance(value, Fault) else "",
)
def test_the_check_of_every_divisor_can_fail(tmp_path: FilePath, text: str, core: str, fault: Fault) -> None:
    tree = faulty_tree(tmp_path / "tree", fault)
    assert first_wrong(tmp_path, text, tree, core).startswith("the reciprocal of")


# --- two words by one -------------------------------------------------------------------------------------------------


def words_domain(machine: Machine) -> list[Any]:
    path = machine.path
    d = path.atom("d", B // 2, B - 1)
    high = path.atom("high", 0, B - 2)
    path.assume(d - 1 - high)
    if d.constant is None:
        v = path.atom("v", 0, B - 1)
        k = B * B - (v + B) * d
        path.assume(k - 1)
        path.assume(d - k)
    else:
        v = Poly.of((B * B - 1) // d.constant - B)
    low = machine.number("uint32_t", "low")
    divisor = machine.struct("el_divisor", normalised=d, reciprocal=v, shift=0)
    remainder = machine.array("uint32_t", [0])
    return [machine.exactly("uint32_t", high), low, Pointer([divisor]), remainder]


def _inputs(machine: Machine) -> tuple[Poly, Poly, Poly, Poly]:
    scope = machine.scopes[0]
    divisor = scope["divisor"].content.cell
    high, low = scope["high"].content.poly, scope["low"].content.poly
    return high, low, machine.poly(divisor, "normalised"), machine.poly(divisor, "reciprocal")


def _facts_of_reciprocal(high: Poly, d: Poly, v: Poly) -> list[Fact]:
    k = B * B - (v + B) * d
    return [Fact(k - 1), Fact(d - k), Fact(d - 1 - high)]


def high_word_lemma(machine: Machine, high: Number) -> Number:
    """Before the product: it does not wrap."""
    h, low, d, v = _inputs(machine)
    machine.path.prove_real(B * B - 1 - (v + B) * h - low, "p < 2^64", _facts_of_reciprocal(h, d, v))
    return high


def quotient_lemma(machine: Machine, quotient: Number) -> Number:
    """The three inequalities, once q is there (not for the corrections that follow)."""
    path = machine.path
    high, low, d, v = _inputs(machine)
    p = (v + B) * high + low
    q1 = path.floor(p, B)
    q0 = p - q1 * B
    r = high * B + low - (q1 + 1) * d
    if "el_divide_words.quotient" in machine.locals or r.constant is not None:
        return quotient
    facts = [*_facts_of_reciprocal(high, d, v), Fact(q0), Fact(B - 1 - q0)]
    path.prove_real(r + d, "-d <= r", facts)
    path.prove_real((r - q0 - 1 + B) * B + B - 1, "q0 + 1 - B <= r", facts)
    if path.decide(q0 - 1 - r, r - q0):
        path.assume(B - 2 - r)
    else:
        path.prove_real(B - d - 1 - r, "r < B - d where r >= q0", [*facts, Fact(r - q0)])
    value = q1 + 1
    for largest in (B - 1, B - 2):
        # At the end of the range the products with d decide.
        if path.decide(q1 - largest, largest - 1 - q1):
            path.assume_product(q1 - largest, d)
            path.assume_product(largest - q1, d)
            value = Poly.of((largest + 1) % B)
            break
    path.prove(quotient.poly - value, "q = p div B + 1, or 0 where that wraps", zero=True)
    return machine.exactly("uint32_t", value)


def words_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    high, low, divisor, remainder = arguments
    d = machine.poly(divisor.cell, "normalised")
    rest = machine.poly(remainder.cell)
    path = machine.path
    path.prove(rest, "0 <= remainder")
    path.prove(d - 1 - rest, "remainder < d")
    path.prove(high.poly * B + low.poly - result.poly * d - rest, "n = q d + remainder", zero=True)


WORDS = Subject(
    FILE,
    "el_divide_words",
    words_domain,
    words_check,
    modular=["el_divide_words"],
    lemmas={"el_divide_words.d": high_word_lemma, "el_divide_words.quotient": quotient_lemma},
)

# --- what is built on it ----------------------------------------------------------------------------------------------


def any_divisor(machine: Machine) -> Pointer:
    """d << shift = normalised, for any d; both are known to the path."""
    path = machine.path
    d = path.atom("d", 1, B - 1)
    if d.constant is not None:
        shift = 32 - d.constant.bit_length()
        reciprocal = Poly.of((B * B - 1) // (d.constant << shift) - B)
    else:
        shift = path.choose(path.atom("shift", 0, 31))
        reciprocal = path.atom("reciprocal", 0, B - 1)
        path.assume(d * (1 << shift) - B // 2)
        path.assume(B - 1 - d * (1 << shift))
    divisor = machine.struct("el_divisor", normalised=d * (1 << shift), reciprocal=reciprocal, shift=shift)
    divisor.stands_for = d
    return Pointer([divisor])


def u64_domain(machine: Machine) -> list[Any]:
    divisor = any_divisor(machine)
    n = machine.number("uint64_t", "n")
    machine.path.assume(contracts.divisor_of(divisor) * B - 1 - n.poly)
    return [n, divisor]


def floor_domain(machine: Machine) -> list[Any]:
    divisor = any_divisor(machine)
    n = machine.number("int64_t", "n")
    d = contracts.divisor_of(divisor)
    machine.path.assume(n.poly + d * (B // 2))
    machine.path.assume(d * (B // 2) - 1 - n.poly)
    return [n, divisor]


def floor_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    n, divisor = arguments
    d = contracts.divisor_of(divisor)
    rest = n.poly - result.poly * d
    machine.path.prove(rest, "q d <= n")
    machine.path.prove(d - 1 - rest, "n < (q + 1) d")


def q32_domain(machine: Machine) -> list[Any]:
    n = machine.number("int64_t", "n", -(2**63) + 1)
    return [n, machine.number("uint32_t", "fraction"), any_divisor(machine)]


def wide_domain(machine: Machine) -> list[Any]:
    n = machine.number("int64_t", "n", -(2**63) + 1)
    return [n, machine.number("uint32_t", "fraction"), machine.number("uint64_t", "d", 1, 2**47 - 1)]


def i32_q32_domain(machine: Machine) -> list[Any]:
    return [machine.number("int32_t", "n", -(2**31) + 1), any_divisor(machine)]


def short_domain(machine: Machine) -> list[Any]:
    return [machine.number("uint32_t", "d", 1, machine.constant(machine.unit.constants["EL_SHORT_DIVISOR"]))]


def short_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    rest = B - 1 - result.poly * arguments[0].poly
    machine.path.prove(rest, "r d <= 2^32 - 1")
    machine.path.prove(arguments[0].poly - 1 - rest, "2^32 - 1 < (r + 1) d")


def ratio_domain(c_type: str, most_n: int, most_d: int) -> Any:
    """Numbers of whose ratio the whole part fits 32 bits."""

    def domain(machine: Machine) -> list[Any]:
        n, d = machine.path.atom("n", -most_n, most_n), machine.path.atom("d", 1, most_d)
        machine.path.assume(d * (B // 2) - 1 - n)
        machine.path.assume(n + d * (B // 2) - 1)
        return [machine.exactly(c_type, n), machine.exactly("uint32_t", d)]

    return domain


def whole_lemma(machine: Machine, quotient: Number) -> Number:
    """The whole part of the ratio fits 32 bits; with or without a sign, each is easy by itself."""
    machine.path.decide(quotient.poly, -quotient.poly - 1)
    for bound in (B // 2 - 1 - quotient.poly, quotient.poly + B // 2 - 1):
        machine.path.prove(bound, "|n / d| < 2^31")
    return quotient


def ratio_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    n, d = (argument.poly for argument in arguments)
    rest = n * B - result.poly * d
    machine.path.prove(rest, "q d <= 2^32 n")
    machine.path.prove(d - 1 - rest, "2^32 n < (q + 1) d")


class Quotients:
    """The contract of el_divide_words, remembering the quotients of a chain of them."""

    def __init__(self, length: int) -> None:
        self.length = length
        self.words: list[Poly] = []

    def divide_words(self, machine: Machine, arguments: list[Any]) -> Number:
        if len(self.words) == self.length:
            self.words.clear()
        quotient = contracts.divide_words(machine, arguments)
        self.words.append(quotient.poly)
        return quotient


CHAIN, SHORT_CHAIN = Quotients(3), Quotients(2)


def chain_check(machine: Machine, exact: Poly, divisor: Pointer, chain: Quotients, result: Number) -> None:
    """The words make Q = floor(|exact| / d), and the result is Q or -Q modulo 2^64."""
    path = machine.path
    d = machine.poly(divisor.cell, "normalised")
    scale = 1 << machine.path.choose(machine.poly(divisor.cell, "shift"))
    negative = not path.decide(exact, -exact - 1)
    magnitude = -exact if negative else exact
    *top, middle, low = chain.words
    quotient = sum(top, Poly.of(0)) * B * B + middle * B + low
    rest = magnitude * scale - quotient * d
    path.prove(rest, "Q d <= |n|")
    path.prove(d - 1 - rest, "|n| < (Q + 1) d")
    signed = middle * -B - low if negative else middle * B + low
    difference = result.poly - signed
    path.prove(difference - path.floor(difference, B * B) * (B * B), "the result is Q modulo 2^64", zero=True)


def q32_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    n, fraction, divisor = arguments
    chain_check(machine, n.poly * B + fraction.poly, divisor, CHAIN, result)


def i32_q32_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    n, divisor = arguments
    chain_check(machine, n.poly * B, divisor, SHORT_CHAIN, result)


def wide_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    """The same for the division that takes 16 bits of the fraction at a time."""
    n, fraction, d = arguments
    path = machine.path
    exact = n.poly * B + fraction.poly
    negative = not path.decide(n.poly, -n.poly - 1)
    magnitude = -exact if negative else exact
    parts = [quotient for quotient, (_, by) in path.quotients.items() if by.terms == d.poly.terms]
    whole, high, low = (Poly({(part,): 1}) for part in parts)
    quotient = whole * B + high * (1 << 16) + low
    rest = magnitude - quotient * d.poly
    path.prove(rest, "Q d <= |n|")
    path.prove(d.poly - 1 - rest, "|n| < (Q + 1) d")
    difference = result.poly - (-quotient if negative else quotient)
    path.prove(difference - path.floor(difference, B * B) * (B * B), "the result is Q modulo 2^64", zero=True)


MODULAR = ["el_divide_q32", "el_divide_wide_q32", "magnitude_of", "el_abs_u64"]
U64 = Subject(FILE, "el_divide_u64", u64_domain, floor_check, contracts={"el_divide_words": contracts.divide_words})
FLOOR = Subject(
    FILE, "el_divide_floor_i64", floor_domain, floor_check, contracts={"el_divide_u64": contracts.divide_u64}
)
Q32 = Subject(FILE, "el_divide_q32", q32_domain, q32_check, MODULAR, {"el_divide_words": CHAIN.divide_words})
WIDE = Subject(FILE, "el_divide_wide_q32", wide_domain, wide_check, MODULAR)
MAKE = Subject(
    FILE,
    "el_divisor_make",
    lambda machine: [machine.number("uint32_t", "d", 1)],
    lambda machine, arguments, result: machine.path.prove(
        machine.poly(result, "normalised") - B // 2, "normalised has its top bit"
    ),
    contracts={"el_reciprocal_word": lambda machine, _: machine.number("uint32_t", "reciprocal")},
)
I32_Q32 = Subject(
    FILE,
    "el_divide_i32_q32",
    i32_q32_domain,
    i32_q32_check,
    ["el_divide_i32_q32"],
    {"el_divide_words": SHORT_CHAIN.divide_words},
)
SHORT = Subject(FILE, "el_reciprocal_of_short", short_domain, short_check)
RATIO = Subject(
    FILE,
    "el_ratio_q32",
    ratio_domain("int32_t", 2**31 - 1, 2**16 - 1),
    ratio_check,
    lemmas={"el_ratio_q32.quotient": whole_lemma},
)
WIDE_RATIO = Subject(
    FILE,
    "el_wide_ratio_q32",
    ratio_domain("int64_t", 2**62, 2**31 - 1),
    ratio_check,
    lemmas={"el_wide_ratio_q32.quotient": whole_lemma},
)
SUBJECTS = {
    subject.function: subject for subject in (WORDS, U64, FLOOR, Q32, I32_Q32, WIDE, MAKE, SHORT, RATIO, WIDE_RATIO)
}


@pytest.mark.parametrize("name", SUBJECTS)
def test_quotients_are_exact_for_every_input(name: str) -> None:
    SUBJECTS[name].prove()


@pytest.mark.parametrize("name", SUBJECTS)
def test_the_compiler_agrees(name: str) -> None:
    subject = SUBJECTS[name]
    if name == "el_divisor_make":
        subject = Subject(FILE, name, subject.domain, modular=["el_reciprocal_word"])
    Subject(FILE, name, subject.domain, modular=[*subject.modular, "el_divide_words"]).agree()


@pytest.mark.parametrize(
    ("name", "old", "new"),
    [
        ("el_divide_words", "if (rest >= d) {", "if (rest > d) {"),
        ("el_divide_words", "if (rest > (uint32_t)product) {", "if (rest > (uint32_t)product + 1U) {"),
        ("el_divide_i32_q32", "magnitude >> (32U - shift)", "magnitude >> (31U - shift)"),
        ("el_reciprocal_of_short", "0xFFFFFFFFU / d", "0xFFFFFFFFU / (d + 1U)"),
        ("el_ratio_q32", "d - 1U - rest", "d - rest"),
        ("el_wide_ratio_q32", "rest < 0 ? quotient - 1", "rest < 0 ? quotient"),
    ],
)
def test_the_proof_can_fail(name: str, old: str, new: str) -> None:
    SUBJECTS[name].fails_with(Fault(HEADER, old, new))


def test_the_proof_can_fail_on_the_wide_division() -> None:
    WIDE.fails_with(Fault(FILE, "shift = 16; shift >= 0; shift -= 16", "shift = 15; shift >= 0; shift -= 15"))
    Q32.fails_with(Fault(FILE, "fraction == 0 ? el_abs_u64(n) : ~(uint64_t)n", "~(uint64_t)n"))
