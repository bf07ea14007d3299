"""The proofs' own machine: a domain that nothing is in proves nothing, and what C computes is never excluded.

Whatever the machine assumes of a result must hold for what C makes of each pair of numbers: else a path would be taken
for impossible, and all that comes after it for proven.
"""

from __future__ import annotations

import itertools
import operator
from collections.abc import Callable
from typing import Any

import pytest

from c_source import parse
from c_values import INT
from proof import Fault, Machine, Number, Poly, ProofError, Subject
from symbolic import Path, every_path

FILE = "base/fixed.c"
NUMBERS = range(-4, 5)
BITWISE: dict[str, Callable[[int, int], int]] = {"|": operator.or_, "&": operator.and_, "^": operator.xor}


def contradiction(machine: Machine) -> list[Any]:
    """a > b and b > a, which no interval tells."""
    a, b = machine.path.atom("a", -(2**31), 2**31 - 1), machine.path.atom("b", -(2**31), 2**31 - 1)
    machine.path.assume(a - b - 1)
    machine.path.assume(b - a - 1)
    return [machine.exactly("int32_t", a), machine.exactly("int32_t", b)]


def any_two(machine: Machine) -> list[Any]:
    return [machine.number("int32_t", "a"), machine.number("int32_t", "b")]


def is_the_largest(machine: Machine, arguments: list[Any], result: Number) -> None:
    for argument in arguments:
        machine.path.prove(result.poly - argument.poly, "not less than either")


def test_a_domain_that_contradicts_itself_is_no_proof() -> None:
    with pytest.raises(ProofError, match="the domain is empty"):
        Subject(FILE, "el_max_i32", contradiction, is_the_largest).prove()


def test_a_fault_is_found_where_something_is_in_the_domain() -> None:
    largest = Subject(FILE, "el_max_i32", any_two, is_the_largest)
    assert largest.prove() == 2
    signature = "el_max_i32(int32_t a, int32_t b)\n{\n    return "
    largest.fails_with(Fault("base/fixed.h", signature + "a > b ?", signature + "a >= 0 ?"))


def excluded(symbol: str, x: int, y: int, masks: bool) -> bool:
    """Whether the machine has a way in which `x symbol y` cannot be what C has; of y a constant, or an unknown too."""
    found = []

    def body(path: Path) -> None:
        machine = Machine(parse(FILE), path)
        a, b = path.atom("a", NUMBERS[0], NUMBERS[-1]), path.atom("b", NUMBERS[0], NUMBERS[-1])
        result = machine.bitwise(symbol, a, Poly.of(y) if masks else b, INT, None)
        path.assume(a - x, zero=True)
        path.assume(b - y, zero=True)
        path.assume(result - BITWISE[symbol](x, y), zero=True)
        found.append(path.is_possible())

    try:
        every_path(body)
    except ProofError:
        return True
    return not any(found)


def test_what_c_has_is_never_excluded() -> None:
    for x, y in itertools.product(NUMBERS, NUMBERS):
        assert not excluded("|", x, y, masks=False), f"{x} | {y}"
        if y in (1, 2, 3, 4):
            assert not excluded("&", x, y, masks=True), f"{x} & {y}"
    for x in NUMBERS:
        assert not excluded("^", x, -1, masks=True), f"{x} ^ -1"


def test_what_c_does_not_have_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(BITWISE, "|", lambda x, y: max(x, y) - 1)
    assert excluded("|", 4, 2, masks=False)
    monkeypatch.setitem(BITWISE, "&", lambda x, y: (x & y) + 1)
    assert excluded("&", 4, 4, masks=True)
