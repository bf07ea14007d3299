"""geometry/sides: the form of a side keeps within 32 bits, for any position and any side as sides.h has them. That they
are so, and that what they call beyond is, is for tests/unit/test_sides.c.
"""

from __future__ import annotations

from typing import Any

from proof import Fault, Machine, Pointer, Subject

SIDES = "geometry/sides.c"


def passed_domain(machine: Machine) -> list[Any]:
    path = machine.path
    side = machine.struct("el_side", offset=path.atom("offset", -(2**28) - 2**18, 2**28 + 2**18))
    machine.put(side.content["elements"], [path.atom(f"e{i}", -(2**13), 2**13) for i in range(3)])
    position = [path.atom(f"p{i}", -(2**15), 2**15 - 1) for i in range(3)]
    return [Pointer([side]), machine.array("int16_t", position)]


PASSED = Subject(SIDES, "el_side_is_passed", passed_domain)


def test_all_values() -> None:
    PASSED.prove()


def test_the_proof_can_fail() -> None:
    PASSED.fails_with(Fault("geometry/sides.h", "side->elements[0] *", "16 * side->elements[0] *"))


def test_the_compiler_agrees() -> None:
    PASSED.agree(count=100)
