"""C's arithmetic on symbolic numbers.

What C leaves undefined is an error here, with the line: signed overflow, a shift by the width or more, a left shift of
a negative number or out of its type, division by what may be zero. So is a conversion that may lose: a narrowing one to
a signed type, or to an unsigned one of fewer than 32 bits. Two kinds are exact by definition and allowed: unsigned 64
to 32 bits (the low word is taken), and signed from unsigned of the same width and back (two's complement, as gcc and
clang define it). Unsigned arithmetic that wraps is an error too, unless the function's name is in `modular`: then it is
meant.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Collection
from typing import Any

from pycparser import c_ast

from c_values import BOOL, I64, INT, IntType, Number, Pointer
from symbolic import Path, Poly, ProofError


def _have_no_bit_in_common(a: Poly, b: Poly) -> bool:
    """Whether each is a sum of terms >= 0 in bits of their own: from what it is a multiple of to what it is at most."""
    fields = []
    for poly in (a, b):
        for monomial, factor in poly.terms.items():
            low, high = Poly({monomial: factor}).interval()
            if low < 0:
                return False
            fields.append((factor & -factor, high))
    fields.sort()
    return all(high < unit for (_, high), (unit, _) in itertools.pairwise(fields))


class Arithmetic:
    """What a machine computes with; the path learns what is decided on the way."""

    path: Path
    modular: Collection[str]
    packs: bool  # | puts fields together: they must not overlap
    rough: bool  # quotients are known within one unit only: no path for each sign of a dividend
    functions: list[str]  # the ones being executed, the innermost last

    def _fail(self, what: str, poly: Poly, of: IntType, where: c_ast.Node | None) -> ProofError:
        low, high = self.path.bounds(poly)
        wrong = poly - of.low if not self.path.holds(poly - of.low) else of.high - poly
        return ProofError(
            f"{where.coord if where is not None else '?'}: {what} in {self.functions[-1]}: a value in [{low}, {high}]"
            f" does not fit {of}; {self.path.example(wrong)}"
        )

    def fit(self, poly: Poly, of: IntType, where: c_ast.Node | None) -> Number:
        """The result of arithmetic in type `of`."""
        if self.path.within(poly, of.low, of.high):
            return Number(of, poly)
        if of.signed:
            raise self._fail("signed overflow", poly, of, where)
        if self.functions[-1] not in self.modular:
            raise self._fail("unsigned arithmetic wraps", poly, of, where)
        return Number(of, self.reduce(poly, of))

    def reduce(self, poly: Poly, of: IntType) -> Poly:
        """The number of type `of` that is congruent to poly."""
        shifted = poly - of.low
        return poly - self.path.floor(shifted, 1 << of.bits) * (1 << of.bits)

    def convert(self, value: Number, to: Any, where: c_ast.Node | None) -> Any:
        if not isinstance(to, IntType) or value.type == to:
            return value
        if to == BOOL:
            return self.boolean(not self.is_zero(value))
        if self.path.within(value.poly, to.low, to.high):
            return Number(to, value.poly)
        reinterprets = value.type.bits == to.bits
        takes_low_word = not to.signed and to.bits >= 32
        if not (reinterprets or takes_low_word):
            raise self._fail("lossy conversion", value.poly, to, where)
        if not value.type.signed and to.signed and value.type.bits == to.bits:
            # One bit decides: two paths, each without a fraction.
            half = 1 << (to.bits - 1)
            below = self.path.decide(half - 1 - value.poly, value.poly - half)
            return Number(to, value.poly if below else value.poly - 2 * half)
        return Number(to, self.reduce(value.poly, to))

    @staticmethod
    def promoted(of: IntType) -> IntType:
        return INT if of.bits < 32 else of

    def common(self, a: IntType, b: IntType) -> IntType:
        a, b = self.promoted(a), self.promoted(b)
        if a.bits != b.bits:
            return a if a.bits > b.bits else b
        return a if not a.signed else b

    def boolean(self, value: bool) -> Number:
        return Number(INT, Poly.of(1 if value else 0))

    def is_zero(self, value: Any) -> bool:
        if isinstance(value, Pointer):
            return False
        poly = value.poly
        if poly.constant is not None:
            return bool(poly.constant == 0)
        if self.path.holds(poly):
            return self.path.decide(-poly, poly - 1)
        if self.path.decide(poly, -poly - 1):
            return self.path.decide(-poly, poly - 1)
        return False

    def compare(self, operator: str, a: Poly, b: Poly) -> bool:
        difference = a - b
        match operator:
            case "<":
                return self.path.decide(-difference - 1, difference)
            case "<=":
                return self.path.decide(-difference, difference - 1)
            case ">":
                return self.path.decide(difference - 1, -difference)
            case ">=":
                return self.path.decide(difference, -difference - 1)
        zero = self.is_zero(Number(I64, difference))
        return zero if operator == "==" else not zero

    def divide(self, a: Poly, b: Poly, where: c_ast.Node) -> Poly:
        """a / b, truncated, b > 0 or bounded below 0."""
        if self.path.bounds(b)[1] < 0:
            return -self.divide(a, -b, where)
        if not self.path.holds(b - 1):
            raise ProofError(f"{where.coord}: division by what may be zero or less; {self.path.example(b - 1)}")
        if self.rough:
            most = max(map(abs, self.path.bounds(a))) // max(1, b.interval()[0])
            rough = self.path.atom("q", -most, most)
            self.path.assume(a - rough * b + b - 1)
            self.path.assume(rough * b + b - 1 - a)
            return rough
        negative = not self.path.decide(a, -a - 1)
        magnitude = -a if negative else a
        constant = b.constant
        quotient = self.path.floor(magnitude, constant) if constant is not None else self.path.quotient(magnitude, b)
        return -quotient if negative else quotient

    def binary(self, operator: str, a: Number, b: Number, where: c_ast.Node) -> Number:
        if operator in ("<<", ">>"):
            return self.shift(operator, a, b, where)
        of = self.common(a.type, b.type)
        a, b = self.convert(a, of, where), self.convert(b, of, where)
        if operator in ("<", "<=", ">", ">=", "==", "!="):
            return self.boolean(self.compare(operator, a.poly, b.poly))
        if operator == "+":
            return self.fit(a.poly + b.poly, of, where)
        if operator == "-":
            return self.fit(a.poly - b.poly, of, where)
        if operator == "*":
            return self.fit(a.poly * b.poly, of, where)
        if operator == "/":
            return self.fit(self.divide(a.poly, b.poly, where), of, where)
        if operator == "%":
            return self.fit(a.poly - self.divide(a.poly, b.poly, where) * b.poly, of, where)
        return Number(of, self.bitwise(operator, a.poly, b.poly, of, where))

    def bitwise(self, operator: str, a: Poly, b: Poly, of: IntType, where: c_ast.Node) -> Poly:
        if a.constant is not None and b.constant is not None:
            x, y = a.constant, b.constant
            return Poly.of(x & y if operator == "&" else x | y if operator == "|" else x ^ y)
        if a.constant is not None:
            a, b = b, a
        if b.constant == 0:
            return b if operator == "&" else a
        if operator == "&" and b.constant is not None and b.constant > 0:
            return self._masked(a, b.constant)
        if operator == "^" and b.constant == (-1 if of.signed else of.high):
            return b - a
        if operator == "|":
            return self._or(a, b)
        raise NotImplementedError(f"{where.coord}: {operator}")

    def _masked(self, a: Poly, mask: int) -> Poly:
        """a & mask, mask > 0: the sum of the fields that the mask's ones are, from the lowest on."""
        unit = mask & -mask
        end = (mask + unit) & -(mask + unit)  # the first bit above the lowest field
        upper = self.path.floor(a, unit)
        field = (upper - self.path.floor(upper, end // unit) * (end // unit)) * unit
        rest = mask & -end
        return field + self._masked(a, rest) if rest else field

    def _or(self, a: Poly, b: Poly) -> Poly:
        for upper, lower in ((a, b), (b, a)):
            unit = math.gcd(*upper.terms.values())
            if self.path.within(lower, 0, (unit & -unit) - 1):
                return upper + lower
        if _have_no_bit_in_common(a, b):
            return a + b
        if self.packs:
            raise ProofError(f"{self.functions[-1]}: fields that are put together by | overlap")
        negative = [part for part in (a, b) if not self.path.decide(part, -part - 1)]
        if negative:
            # Bits that are set bring a negative number nearer to -1.
            result = self.path.atom("or", max(self.path.bounds(part)[0] for part in negative), -1)
            for part in negative:
                self.path.assume(result - part)
            return result
        high = max(self.path.bounds(a)[1], self.path.bounds(b)[1])
        result = self.path.atom("or", 0, (1 << high.bit_length()) - 1)
        self.path.assume(result - a)
        self.path.assume(result - b)
        self.path.assume(a + b - result)
        return result

    def shift(self, operator: str, a: Number, b: Number, where: c_ast.Node) -> Number:
        of = self.promoted(a.type)
        low, high = self.path.bounds(b.poly)
        if low < 0 or high >= of.bits:
            self.path.prove(b.poly, f"{where.coord}: shift by less than 0")
            self.path.prove(of.bits - 1 - b.poly, f"{where.coord}: shift by the width or more")
        count = self.path.choose(b.poly)
        if operator == ">>":
            return Number(of, self.path.floor(a.poly, 1 << count))
        if of.signed and not self.path.holds(a.poly):
            raise ProofError(f"{where.coord}: left shift of a negative number")
        shifted = a.poly * (1 << count)
        if of.signed or self.path.within(shifted, of.low, of.high):
            return self.fit(shifted, of, where)
        # Bits shifted out of an unsigned number are lost on purpose, wherever that is written.
        return Number(of, self.reduce(shifted, of))

    def leading_zeros(self, value: Number, width: int, where: c_ast.Node) -> Number:
        if not self.path.holds(value.poly - 1):
            raise ProofError(f"{where.coord}: leading zeros of what may be 0; {self.path.example(value.poly - 1)}")
        if value.type.bits < width:
            value = self.convert(value, IntType(width, False), where)
        low, high = self.path.bounds(value.poly)
        least, most = max(low, 1).bit_length(), high.bit_length()
        while least < most:
            middle = (least + most) // 2
            if self.path.decide((1 << middle) - 1 - value.poly, value.poly - (1 << middle)):
                most = middle
            else:
                least = middle + 1
        return Number(INT, Poly.of(width - least))
