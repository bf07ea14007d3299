"""base/divide: the reciprocal, the quotient of two words by one, and all that is built on them.

The reciprocal of d is v = floor((2^64 - 1) / d) - 2^32. With B = 2^32 that says: k = B^2 - (B + v) d is in 1..d. It is
checked for each of the 2^31 normalised divisors; so are el_reciprocal_near, 1 <= 2^63 - r d < EL_RECIPROCAL_ERROR d,
and el_reciprocal_beside, -EL_RECIPROCAL_HIGH d < 2^61 - r d < EL_RECIPROCAL_LOW d. On cores without a divider all begin
with a table, whose every entry is checked against the division.

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
from proof import Fact, Fault, Lemma, Machine, Number, Pointer, Poly, Subject, compile_c

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

EVERY_BESIDE = """
#include "base/divide.c"
#include "base/reciprocals.c"
#include <stdio.h>

int main(void)
{
    for (uint32_t d = 1U << 30; d != 1U << 31; d++) {
        /* Too high a one is below 0 by EL_RECIPROCAL_HIGH d at most; all else that is wrong wraps, or is too much. */
        const uint64_t high = (uint64_t)EL_RECIPROCAL_HIGH * d - 1U;
        const uint64_t rest = (1ULL << 61) - (uint64_t)el_reciprocal_beside(d) * d;
        if (rest + high >= (uint64_t)EL_RECIPROCAL_LOW * d + high) {
            printf("the reciprocal of %u is beside %u\\n", d, el_reciprocal_beside(d));
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
        wrong |= differ(d, (uint32_t)el_reciprocal_of_short((int32_t)d), 0x7FFFFFFFU / d);
    }
    for (uint32_t d = 1; d < 1U << 16; d++) {
        /* 2^31 - r normalised is in [0, 2 normalised). */
        const el_small_divisor made = el_small_divisor_make((int32_t)d);
        const uint32_t rest = 0x80000000U - made.reciprocal * made.normalised;
        const int right = made.normalised == d << made.shift && made.normalised >> 15 == 1 && made.limit == d;
        wrong |= differ(d, rest < 2U * made.normalised && right, 1);
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
    [(EVERY_DIVISOR, ""), (EVERY_NEAR, ""), (EVERY_BESIDE, ""), (EVERY_BESIDE, ARMV6M), (EVERY_ENTRY, ARMV6M)],
    ids=["exact", "near", "beside", "beside, by table", "tables"],
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
        (EVERY_BESIDE, "", Fault(HEADER, "EL_RECIPROCAL_LOW = 4", "EL_RECIPROCAL_LOW = 3")),
        (EVERY_BESIDE, ARMV6M, Fault(HEADER, "EL_RECIPROCAL_HIGH = 3", "EL_RECIPROCAL_HIGH = 2")),
        (EVERY_BESIDE, ARMV6M, Fault(HEADER, "(guess * (off >> 15)) >> 24", "(guess * (off >> 15)) >> 23")),
        (
            EVERY_ENTRY,
            ARMV6M,
            Fault(HEADER, "const uint32_t quotient = 2U * guess +", "const uint32_t quotient = guess +"),
        ),
        (EVERY_ENTRY, ARMV6M, Fault(HEADER, ".reciprocal = 2U * guess", ".reciprocal = guess")),
        (EVERY_ENTRY, ARMV6M, Fault(TABLE, "0x7FE1, 0x7FA1", "0x7FE1, 0x7FA2")),
        (EVERY_ENTRY, ARMV6M, Fault(TABLE, "0x00402010", "0x00402011")),
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


def short_domain(machine: Machine) -> list[Any]:
    return [machine.number("int32_t", "d", 1, machine.constant(machine.unit.constants["EL_SHORT_DIVISOR"]))]


def short_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    rest = B // 2 - 1 - result.poly * arguments[0].poly
    machine.path.prove(rest, "r d <= 2^31 - 1")
    machine.path.prove(arguments[0].poly - 1 - rest, "2^31 - 1 < (r + 1) d")


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


CHAIN = Quotients(3)


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
SUBJECTS = {subject.function: subject for subject in (WORDS, U64, FLOOR, Q32, WIDE, MAKE, SHORT, RATIO, WIDE_RATIO)}


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
        ("el_reciprocal_of_short", "INT32_MAX / d", "INT32_MAX / (d + 1)"),
        ("el_ratio_q32", "d - 1U - rest", "d - rest"),
        ("el_wide_ratio_q32", "rest < 0 ? quotient - 1", "rest < 0 ? quotient"),
    ],
)
def test_the_proof_can_fail(name: str, old: str, new: str) -> None:
    SUBJECTS[name].fails_with(Fault(HEADER, old, new))


def test_the_proof_can_fail_on_the_wide_division() -> None:
    WIDE.fails_with(Fault(FILE, "shift = 16; shift >= 0; shift -= 16", "shift = 15; shift >= 0; shift -= 15"))
    Q32.fails_with(Fault(FILE, "fraction == 0 ? el_abs_u64(n) : ~(uint64_t)n", "~(uint64_t)n"))


# --- by a small divisor -----------------------------------------------------------------------------------------------


def is_by_digits(machine: Machine) -> bool:
    return "el_divide_digit" in machine.unit.functions


def small_divisor(machine: Machine, least: int = 1) -> Pointer:
    """Any small divisor of either sign; on cores without a divider, with what its making is proven to give above."""
    path = machine.path
    most = (1 << machine.constant(machine.unit.constants["EL_SMALL_DIVISOR_BITS"])) - 1
    magnitude = path.atom("magnitude", least, most)
    sign = path.choose(path.atom("half", 0, 1)) * 2 - 1
    divisor = machine.struct("el_small_divisor", d=magnitude * sign)
    divisor.stands_for = magnitude
    if not is_by_digits(machine):
        return Pointer([divisor])
    known = magnitude.constant
    if known is not None:
        shift = max(0, 16 - known.bit_length())
        normalised = Poly.of(known << shift)
        reciprocal = Poly.of((B // 2) // (known << shift))
        limit = Poly.of(known if known < 1 << 16 else 0)
    elif path.decide((1 << 16) - 1 - magnitude, magnitude - (1 << 16)):
        shift = path.choose(path.atom("shift", 0, 15))
        normalised, limit = magnitude * (1 << shift), magnitude
        path.assume(normalised - (1 << 15))
        path.assume((1 << 16) - 1 - normalised)
        reciprocal = path.atom("reciprocal", 0, 1 << 16)
    else:
        shift, limit = 0, Poly.of(0)
        normalised, reciprocal = path.atom("normalised", 0, B - 1), path.atom("reciprocal", 0, B - 1)
    for name, value in (("limit", limit), ("normalised", normalised), ("reciprocal", reciprocal), ("shift", shift)):
        machine.put(divisor.content[name], value)
    return Pointer([divisor])


def digit_domain(bits: int) -> Any:
    """Digits of 16 bits; or of 11, by a divisor of 19 bits and the reciprocal of its upper 16, rounded up."""
    size = 16 if bits == 16 else 19

    def domain(machine: Machine) -> list[Any]:
        path = machine.path
        normalised = path.atom("normalised", 1 << (size - 1), (1 << size) - 1)
        high, low = path.atom("high", 0, (1 << size) - 2), machine.number("uint32_t", "low", 0, (1 << bits) - 1)
        path.assume(normalised - 1 - high)
        of = normalised if bits == 16 else path.floor(normalised, 8) + 1
        if normalised.constant is not None:
            reciprocal = Poly.of((B // 2) // of.known)
        else:
            reciprocal = path.atom("reciprocal", 0, 1 << 16)
            path.assume(B // 2 - reciprocal * of)
            path.assume((2 if bits == 16 else 1) * of - 1 - B // 2 + reciprocal * of)
        divisor = machine.struct(
            "el_small_divisor", d=1, limit=1, normalised=normalised, reciprocal=reciprocal, shift=0
        )
        numbers = [machine.exactly("uint32_t", high), low, machine.exactly("uint32_t", bits)]
        return [*numbers, Pointer([divisor]), machine.array("uint32_t", [0])]

    return domain


def first_digit_lemma(machine: Machine, quotient: Number) -> Number:
    """q = floor(h r / 2^(31 - bits)), times what r is the reciprocal of: not above high 2^bits, and not far below."""
    path, scope, q = machine.path, machine.scopes[0], quotient.poly
    if q.constant is not None or "el_divide_digit.quotient" in machine.locals:
        return quotient
    bits = scope["bits"].content.poly.known
    divisor = scope["divisor"].content.cell
    h, normalised = scope["high"].content.poly, machine.poly(divisor, "normalised")
    of = normalised
    if bits == 11:
        h, upper = path.floor(h, 8), path.floor(normalised, 8)
        of = upper + 1
        path.assume_product(q, normalised - upper * 8)
        path.assume_product(q, upper * 8 + 7 - normalised)
        path.assume_product((1 << 16) - h, upper)
    reciprocal = machine.poly(divisor, "reciprocal")
    rest, cut_off = B // 2 - reciprocal * of, h * reciprocal - q * (1 << (31 - bits))
    path.assume_product(h, rest)
    path.assume_product(h, (2 if bits == 16 else 1) * of - 1 - rest)
    path.assume_product(cut_off, of)
    path.assume_product((1 << (31 - bits)) - 1 - cut_off, of)
    return quotient


def digit_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    high, low, bits, divisor, remainder = arguments
    normalised, rest = machine.poly(divisor.cell, "normalised"), machine.poly(remainder.cell)
    machine.path.prove(rest, "0 <= remainder")
    machine.path.prove(normalised - 1 - rest, "remainder < normalised")
    exact = high.poly * (1 << bits.poly.known) + low.poly - result.poly * normalised - rest
    machine.path.prove(exact, "n = q normalised + remainder", zero=True)


def digit_subject(bits: int) -> Subject:
    lemmas = {"el_divide_digit.quotient": first_digit_lemma}
    return Subject(
        FILE, "el_divide_digit", digit_domain(bits), digit_check, ["el_divide_digit"], lemmas=lemmas, core=ARMV6M
    )


def digit(machine: Machine, arguments: list[Any]) -> Number:
    """The contract of el_divide_digit."""
    high, low, bits, divisor, remainder = arguments
    path, normalised, base = machine.path, machine.poly(divisor.cell, "normalised"), 1 << bits.poly.known
    path.prove(normalised - 1 - high.poly, "el_divide_digit: high < normalised")
    path.prove(base - 1 - low.poly, "el_divide_digit: low < 2^bits")
    n = high.poly * base + low.poly
    quotient = path.atom("digit", 0, base - 1)
    path.assume(n - quotient * normalised)
    path.assume(normalised - 1 - n + quotient * normalised)
    machine.put(remainder.cell, n - quotient * normalised)
    DIGITS.append(quotient)
    return machine.exactly("uint32_t", quotient)


DIGITS: list[Poly] = []


def asked_for(machine: Machine, arguments: list[Any]) -> Number:
    """el_divide_small_apart_q32, proven below: what is divided by what, and some quotient."""
    n, d = (argument.poly for argument in arguments)
    scope = machine.scopes[0]
    machine.path.prove(n - scope["n"].content.poly, "the dividend is handed on", zero=True)
    machine.path.prove(d - machine.poly(scope["divisor"].content.cell, "d"), "and the divisor", zero=True)
    return machine.number("uint64_t", "handed on")


def small_domain(machine: Machine) -> list[Any]:
    DIGITS.clear()
    n = machine.number("int32_t", "n", -(2**27) + 1, 2**27 - 1)
    return [n, small_divisor(machine)]


def small_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    """The digits make Q = floor(2^32 |n| / |d|), and the result is Q or -Q modulo 2^64."""
    path = machine.path
    n, divisor = arguments[0].poly, arguments[1]
    d = divisor.cell.stands_for
    if is_by_digits(machine):
        if not DIGITS:
            return  # handed on
        low, high = DIGITS[-1], DIGITS[-2]
        whole = DIGITS[-3] if len(DIGITS) == 3 else Poly.of(0)
        quotient, scale = whole * B + high * (1 << 16) + low, 1 << path.choose(machine.poly(divisor.cell, "shift"))
    else:
        parts = [machine.locals[f"el_divide_small_q32.{name}"].poly for name in ("whole", "high", "middle", "low")]
        quotient = parts[0] * B + parts[1] * (1 << 20) + parts[2] * (1 << 10) + parts[3]
        scale = 1
    negative = not path.decide(n, -n - 1)
    backwards = machine.poly(divisor.cell, "d").interval()[1] < 0
    if is_by_digits(machine):
        signed = -quotient if negative != backwards else quotient
    else:
        signed, quotient = quotient, -quotient if negative != backwards else quotient
    rest = ((-n if negative else n) * B - quotient * d) * scale
    path.prove(rest, "Q |d| <= 2^32 |n|")
    path.prove(d * scale - 1 - rest, "2^32 |n| < (Q + 1) |d|")
    difference = result.poly - signed
    path.prove(difference - path.floor(difference, B * B) * (B * B), "the result is Q modulo 2^64", zero=True)


def digit_of(bits: int) -> Lemma:
    """|digit| < 2^bits, of either sign."""

    def lemma(machine: Machine, value: Number) -> Number:
        machine.path.decide(value.poly, -value.poly - 1)
        for bound in (2**bits - 1 - value.poly, value.poly + 2**bits - 1):
            machine.path.prove(bound, f"a digit of {bits} bits")
        return value

    return lemma


SMALL_LEMMAS = {
    f"el_divide_small_q32.{name}": digit_of(bits) for name, bits in (("high", 12), ("middle", 10), ("low", 10))
}


def small(core: str) -> Subject:
    function, own = "el_divide_small_q32", ["el_divide_small_q32"]
    if core:
        contracts_of = {"el_divide_digit": digit, "el_divide_small_apart_q32": asked_for}
        return Subject(FILE, function, small_domain, small_check, own, contracts_of, core=core)
    return Subject(FILE, function, small_domain, small_check, own, lemmas=SMALL_LEMMAS)


def handed_on(machine: Machine, arguments: list[Any]) -> Number:
    """el_divide_small_q32, proven above: what is divided by what, and some quotient, below 2^27 * 2^32."""
    scope = machine.scopes[0]
    machine.path.prove(arguments[0].poly - scope["n"].content.poly, "the dividend is handed on", zero=True)
    given, asked = (machine.poly(pointer.cell, "d") for pointer in (scope["divisor"].content, arguments[1]))
    machine.path.prove(asked - given, "and the divisor", zero=True)
    quotient = machine.path.atom("handed on", -(2**59) + 1, 2**59 - 1)
    HANDED_ON.append(quotient)
    return machine.exactly("uint64_t", quotient if machine.path.decide(quotient, -quotient - 1) else quotient + B * B)


HANDED_ON: list[Poly] = []


def digits_domain(machine: Machine) -> list[Any]:
    HANDED_ON.clear()
    return small_domain(machine)


def digits_check(machine: Machine, arguments: list[Any], result: Any) -> None:
    """The three digits' sum is the truncated quotient, and the lower ones are no larger than it says."""
    path = machine.path
    n, divisor = arguments[0].poly, arguments[1]
    whole_bit, high_bit = (machine.constant(machine.unit.constants[f"EL_{name}_BIT"]) for name in ("WHOLE", "HIGH"))
    whole, high, low = (machine.poly(result, name) for name in ("whole", "high", "low"))
    for digit in (high, low):
        path.prove(2**high_bit - digit, "a digit")
        path.prove(2**high_bit + digit, "a digit")
    total = whole * 2**whole_bit + high * 2**high_bit + low
    if HANDED_ON:
        path.prove(total - HANDED_ON[0], "the same", zero=True)
        return
    scale = 1 << path.choose(machine.poly(divisor.cell, "shift")) if is_by_digits(machine) else 1
    negative = not path.decide(n, -n - 1)
    d = divisor.cell.stands_for
    backwards = machine.poly(divisor.cell, "d").interval()[1] < 0
    quotient = -total if negative != backwards else total
    rest = ((-n if negative else n) * B - quotient * d) * scale
    path.prove(rest, "Q |d| <= 2^32 |n|")
    path.prove(d * scale - 1 - rest, "2^32 |n| < (Q + 1) |d|")


def digits(core: str) -> Subject:
    own, contracts_of = ["el_divide_small"], {"el_divide_small_q32": handed_on}
    if core:
        contracts_of["el_divide_digit"] = digit
        return Subject(FILE, "el_divide_small", digits_domain, digits_check, own, contracts_of, core=core)
    lemmas = {"el_divide_small.high": digit_of(14)}
    return Subject(FILE, "el_divide_small", digits_domain, digits_check, own, contracts_of, lemmas=lemmas)


def apart_domain(machine: Machine) -> list[Any]:
    path = machine.path
    sign = path.choose(path.atom("half", 0, 1)) * 2 - 1
    d = path.atom("d", 1, (1 << machine.constant(machine.unit.constants["EL_SMALL_DIVISOR_BITS"])) - 1) * sign
    return [machine.number("int32_t", "n", -(2**27) + 1, 2**27 - 1), machine.exactly("int32_t", d)]


def divided_alike(machine: Machine, n: Poly, d: Poly) -> Poly:
    """What is proven of n / d elsewhere is asked for |n| / |d|; some quotient."""
    for asked, name in ((n, "n"), (d, "d")):
        given = machine.scopes[0][name].content.poly
        machine.path.prove(asked, "a magnitude")
        if not machine.path.holds(given):
            given = -given
        machine.path.prove(asked - given, f"|{name}|", zero=True)
    quotient = machine.path.atom("quotient", 0, 2**62)
    ASKED[id(machine.path)] = quotient
    return quotient


ASKED: dict[int, Poly] = {}


def apart_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    n, d = (argument.poly for argument in arguments)
    negative = not machine.path.decide(n, -n - 1)
    quotient = ASKED.pop(id(machine.path))
    signed = -quotient if negative != (d.interval()[1] < 0) else quotient
    difference = result.poly - signed
    machine.path.prove(difference - machine.path.floor(difference, B * B) * (B * B), "Q with its sign", zero=True)


APART = Subject(
    FILE,
    "el_divide_small_apart_q32",
    apart_domain,
    apart_check,
    ["el_divide_small_apart_q32"],
    {
        "divide_by_large": lambda machine, arguments: machine.exactly(
            "uint64_t", divided_alike(machine, arguments[0].poly, arguments[1].poly)
        ),
        "el_divide_q32": lambda machine, arguments: machine.exactly(
            "int64_t", divided_alike(machine, arguments[0].poly, contracts.divisor_of(arguments[2]))
        ),
        "el_divisor_make": contracts.divisor_make,
    },
    core=ARMV6M,
)


def large_domain(machine: Machine) -> list[Any]:
    DIGITS.clear()
    return [
        machine.number("uint32_t", "n", 0, 2**27 - 1),
        machine.number("uint32_t", "d", 2**16, 2**19 - 1),
    ]


def reciprocal_of_upper(machine: Machine, arguments: list[Any]) -> Number:
    """el_reciprocal_u16, proven above for each."""
    upper = arguments[0].poly
    machine.path.prove(upper - (1 << 15) - 1, "el_reciprocal_u16: above 2^15")
    machine.path.prove((1 << 16) - upper, "el_reciprocal_u16: at most 2^16")
    return machine.exactly("uint32_t", machine.path.new_quotient(Poly.of(B // 2), upper, 1 << 15, (1 << 16) - 1))


def large_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    """Of the last digit only the upper ten bits."""
    n, d = (argument.poly for argument in arguments)
    rest = n * B - result.poly * d
    machine.path.prove(rest, "Q d <= 2^32 n")
    machine.path.prove(d - 1 - rest, "2^32 n < (Q + 1) d")


def last_digit_lemma(machine: Machine, low: Number) -> Number:
    """A bit less, times the divisor."""
    d = machine.scopes[0]["d"].content.poly
    if low.poly.constant is None:
        machine.path.assume_product(DIGITS[-1] - low.poly * 2, d)
        machine.path.assume_product(low.poly * 2 + 1 - DIGITS[-1], d)
    return low


LARGE = Subject(
    FILE,
    "divide_by_large",
    large_domain,
    large_check,
    contracts={"el_divide_digit": digit, "el_reciprocal_u16": reciprocal_of_upper},
    lemmas={"divide_by_large.low": last_digit_lemma},
    core=ARMV6M,
)

CORES = pytest.mark.parametrize("core", ["", ARMV6M], ids=["divider", "digits"])
DIGIT_BITS = pytest.mark.parametrize("bits", [16, 11])


@CORES
def test_quotients_by_small_divisors_are_exact(core: str) -> None:
    small(core).prove()


@CORES
def test_quotients_in_digits_are_exact(core: str) -> None:
    digits(core).prove()


@DIGIT_BITS
def test_digits_are_exact(bits: int) -> None:
    digit_subject(bits).prove()


def test_quotients_apart_are_exact() -> None:
    APART.prove()
    LARGE.prove()


@CORES
def test_the_compiler_agrees_on_small_divisors(core: str) -> None:
    def domain(machine: Machine) -> list[Any]:
        """What is handed on would begin with a table."""
        n, divisor = small_domain(machine)
        if core:
            machine.path.assume(machine.poly(divisor.cell, "limit") * (1 << 16) - 1 - n.poly)
            machine.path.assume(machine.poly(divisor.cell, "limit") * (1 << 16) - 1 + n.poly)
        return [n, divisor]

    for function in ("el_divide_small_q32", "el_divide_small"):
        Subject(FILE, function, domain, modular=["el_divide_small_q32", "el_divide_small"], core=core).agree(count=100)


@DIGIT_BITS
def test_the_compiler_agrees_on_digits(bits: int) -> None:
    digit_subject(bits).agree()


def test_the_proof_of_small_divisors_can_fail() -> None:
    small("").fails_with(Fault(HEADER, "(rest - high * d) * (1 << 10)", "(rest - high * d) * (1 << 11)"))
    small("").fails_with(Fault(HEADER, "EL_SMALL_DIVISOR_BITS = 19", "EL_SMALL_DIVISOR_BITS = 20"))
    small(ARMV6M).fails_with(Fault(HEADER, "magnitude >> 16 >= divisor->limit", "magnitude >> 16 > divisor->limit"))
    small(ARMV6M).fails_with(Fault(HEADER, "(n < 0) != (divisor->d < 0)", "n < 0"))
    digits(ARMV6M).fails_with(Fault(HEADER, "(n < 0) == (divisor->d < 0)", "n >= 0"))
    digits("").fails_with(Fault(HEADER, "(rest - high * d) * (1 << 14)", "(rest - high * d) * (1 << 13)"))
    digits("").fails_with(Fault(HEADER, "(1U << 17) < 1U << 18", "(1U << 18) < 1U << 19"))
    digits(ARMV6M).fails_with(Fault(HEADER, "magnitude >> 16 < divisor->limit", "magnitude >> 16 <= divisor->limit"))
    text = "while (rest >= divisor->normalised)"
    digit_subject(16).fails_with(Fault(HEADER, text, text.replace(">=", ">")))
    digit_subject(11).fails_with(Fault(HEADER, "high : high >> 3", "high : high >> 2"))
    LARGE.fails_with(Fault(TABLE, "normalised >> 3) + 1U", "normalised >> 3)"))
    LARGE.fails_with(Fault(TABLE, "middle << 10 | low", "middle << 10"))
    APART.fails_with(Fault(TABLE, "(n < 0) != (d < 0)", "n < 0"))
