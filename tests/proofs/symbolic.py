"""Integers that stand for all values of a function's domain, and the facts that are known about them on one path.

A number is a polynomial with integer coefficients over atoms; an atom is an input, or the exact result of a floor
division, a shift or a masked word, which the facts on the path tie to its operands. Facts are polynomials that are zero
or not negative, without "or": where a program decides, the path is split, and each side knows which it is. So a path is
a conjunction, and a question to z3 is one conjunction too.

Three ways answer "is this polynomial never negative here", from the cheapest: interval arithmetic; for polynomials that
are affine in each of their atoms, the corners of the atoms' box, where such a polynomial has its extremes; z3 on the
linear integer problem in which each product of atoms is a variable of its own. Each is sound: what they leave out only
makes fewer things provable. `prove_real` is the fourth, asked for by name: z3's decision procedure for polynomials over
the reals, of which the integers are a part.
"""

from __future__ import annotations

import functools
import itertools
import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

import z3

Monomial = tuple["Atom", ...]

# z3 needs a few seconds for the hardest question; the rest is for machines that have more to do than this.
TIMEOUT_MS = 60_000


class ProofError(AssertionError):
    """What had to hold on every path was not proven: what, where, and an example if there is one."""


def require(condition: bool, what: str) -> None:
    """A step of a derivation that is decided by looking at it."""
    if not condition:
        raise ProofError(f"{what}: does not hold")


class Atom:
    """An unknown integer; its bounds tighten as the path learns more."""

    __slots__ = ("high", "index", "low", "name")

    def __init__(self, name: str, index: int, low: int, high: int) -> None:
        self.name, self.index, self.low, self.high = name, index, low, high

    def __repr__(self) -> str:
        return self.name


def _product_interval(a: tuple[int, int], b: tuple[int, int]) -> tuple[int, int]:
    corners = (a[0] * b[0], a[0] * b[1], a[1] * b[0], a[1] * b[1])
    return min(corners), max(corners)


class Poly:
    """A polynomial over atoms, immutable. Ints mix freely with it."""

    __slots__ = ("terms",)

    def __init__(self, terms: Mapping[Monomial, int]) -> None:
        self.terms = {monomial: factor for monomial, factor in terms.items() if factor != 0}

    @staticmethod
    def of(value: Poly | int) -> Poly:
        return value if isinstance(value, Poly) else Poly({(): value})

    @property
    def constant(self) -> int | None:
        """Its value, if it is the same whatever the atoms are."""
        if not self.terms:
            return 0
        return self.terms.get(()) if len(self.terms) == 1 else None

    @property
    def known(self) -> int:
        """The value of a constant."""
        value = self.constant
        assert value is not None, f"{self} is not constant"
        return value

    def __add__(self, other: Poly | int) -> Poly:
        terms = dict(self.terms)
        for monomial, factor in Poly.of(other).terms.items():
            terms[monomial] = terms.get(monomial, 0) + factor
        return Poly(terms)

    __radd__ = __add__

    def __neg__(self) -> Poly:
        return self * -1

    def __sub__(self, other: Poly | int) -> Poly:
        return self + Poly.of(other) * -1

    def __rsub__(self, other: int) -> Poly:
        return Poly.of(other) - self

    def __mul__(self, other: Poly | int) -> Poly:
        if isinstance(other, int):
            return Poly({monomial: factor * other for monomial, factor in self.terms.items()})
        terms: dict[Monomial, int] = {}
        for (a, x), (b, y) in itertools.product(self.terms.items(), other.terms.items()):
            monomial = tuple(sorted(a + b, key=lambda atom: atom.index))
            terms[monomial] = terms.get(monomial, 0) + x * y
        return Poly(terms)

    __rmul__ = __mul__

    def interval(self) -> tuple[int, int]:
        """Bounds by interval arithmetic, monomial by monomial."""
        low = high = 0
        for monomial, factor in self.terms.items():
            bounds = (factor, factor)
            for atom, group in itertools.groupby(monomial):
                power = len(list(group))
                ends = (atom.low**power, atom.high**power)
                least = 0 if power % 2 == 0 and atom.low < 0 < atom.high else min(ends)
                bounds = _product_interval(bounds, (least, max(ends)))
            low += bounds[0]
            high += bounds[1]
        return low, high

    def corners(self) -> tuple[int, int] | None:
        """Exact bounds over the atoms' box, where each atom occurs to the first power only and there are not many."""
        atoms = sorted({atom for monomial in self.terms for atom in monomial}, key=lambda atom: atom.index)
        if not 0 < len(atoms) <= 8 or any(len(set(monomial)) < len(monomial) for monomial in self.terms):
            return None
        values = [
            self.at(dict(zip(atoms, corner, strict=True)))
            for corner in itertools.product(*((atom.low, atom.high) for atom in atoms))
        ]
        return min(values), max(values)

    def at(self, values: Mapping[Atom, int]) -> int:
        total = 0
        for monomial, factor in self.terms.items():
            total += math.prod((values[atom] for atom in monomial), start=factor)
        return total

    def __repr__(self) -> str:
        return " + ".join(
            f"{factor}*{'*'.join(map(repr, m))}" if m else str(factor) for m, factor in self.terms.items()
        )


@dataclass(frozen=True)
class Fact:
    """poly >= 0, or poly == 0."""

    poly: Poly
    zero: bool = False


class Infeasible(Exception):
    """The path's decisions contradict each other: there is nothing to prove on it."""


class Path:
    """One path through a program: its decisions, and what is known on it."""

    def __init__(self, decisions: list[bool], context: Callable[[], z3.Context] = z3.main_ctx) -> None:
        self._decisions = decisions
        self._context = context
        self._taken = 0
        self.open: list[list[bool]] = []  # the other sides of the decisions that this path took first
        self.facts: list[Fact] = []
        self._atoms: list[Atom] = []
        self._variables: dict[Monomial, z3.ArithRef] = {}
        self.quotients: dict[Atom, tuple[Poly, Poly]] = {}  # what was divided, by what: q * b <= a < q * b + b
        self._floors: dict[tuple[frozenset[tuple[Monomial, int]], int], Poly] = {}
        self._floor_of: dict[Atom, tuple[Poly, Poly, int]] = {}  # itself, what was divided, by what
        self._mentioned: set[Atom] = set()
        self._made: z3.Solver | None = None  # with the facts, from the first question that the cheap ways leave open

    # --- atoms and facts ---

    def atom(self, name: str, low: int, high: int) -> Poly:
        """A new unknown in [low, high]."""
        if low > high:
            raise Infeasible
        atom = Atom(f"{name}.{len(self._atoms)}", len(self._atoms), low, high)
        self._atoms.append(atom)
        if self._made is not None:
            self._declare(atom)
        return Poly({(atom,): 1})

    @property
    def _solver(self) -> z3.Solver:
        if self._made is None:
            self._made = z3.SolverFor("QF_LIA", ctx=self._context())
            self._made.set("timeout", TIMEOUT_MS)
            for atom in self._atoms:
                self._declare(atom)
            for fact in self.facts:
                self._tell(fact)
        return self._made

    def _declare(self, atom: Atom) -> None:
        variable = self._variable((atom,))
        self._solver.add(variable >= atom.low, variable <= atom.high)

    def _tell(self, fact: Fact) -> None:
        expression = self._linear(fact.poly)
        self._solver.add(expression == 0 if fact.zero else expression >= 0)

    def assume(self, poly: Poly, zero: bool = False) -> None:
        """From here on poly >= 0, or == 0."""
        low, high = poly.interval()
        if high < 0 or (zero and low > 0):
            raise Infeasible
        if low >= 0 and not zero and all(len(monomial) < 2 for monomial in poly.terms):
            return  # of a product, z3 may know less than its factors' bounds say by now
        self.facts.append(Fact(poly, zero))
        self._mentioned.update(atom for monomial in poly.terms for atom in monomial)
        self._tighten(poly, zero)
        if self._made is not None:
            self._tell(self.facts[-1])

    @staticmethod
    def _tighten(poly: Poly, zero: bool) -> None:
        rest = dict(poly.terms)
        constant = rest.pop((), 0)
        if len(rest) != 1:
            return
        ((monomial, factor),) = rest.items()
        if len(monomial) != 1:
            return
        atom = monomial[0]
        if factor > 0 or zero:
            atom.low = max(atom.low, -(constant // abs(factor)) if factor > 0 else -((-constant) // abs(factor)))
        if factor < 0 or zero:
            atom.high = min(atom.high, constant // -factor if factor < 0 else (-constant) // factor)
        if atom.low > atom.high:
            raise Infeasible

    # --- questions ---

    def _variable(self, monomial: Monomial) -> z3.ArithRef:
        if monomial not in self._variables:
            self._variables[monomial] = z3.Int("*".join(atom.name for atom in monomial), self._context())
            if len(monomial) > 1:
                low, high = Poly({monomial: 1}).interval()
                self._solver.add(self._variables[monomial] >= low, self._variables[monomial] <= high)
        return self._variables[monomial]

    def _linear(self, poly: Poly) -> z3.ArithRef:
        terms = [
            factor * self._variable(monomial) if monomial else z3.IntVal(factor, self._context())
            for monomial, factor in poly.terms.items()
        ]
        return z3.Sum(terms) if terms else z3.IntVal(0, self._context())

    def bounds(self, poly: Poly) -> tuple[int, int]:
        """Bounds by the cheap ways: intervals, and corners where they are tighter."""
        low, high = poly.interval()
        if len(poly.terms) > 1:
            corners = poly.corners()
            if corners is not None:
                low, high = max(low, corners[0]), min(high, corners[1])
        return low, high

    def holds(self, poly: Poly) -> bool:
        """Whether poly >= 0 is proven."""
        if poly.interval()[0] >= 0 or self.bounds(poly)[0] >= 0:
            return True
        return self._answer(self._linear(poly) < 0) == z3.unsat or self._holds_of_quotient(poly)

    def _holds_of_quotient(self, poly: Poly) -> bool:
        """A bound of a quotient q = floor(a / b), asked of a: q >= c where a >= c b, q <= c where a < (c + 1) b."""
        # A common factor c of all but the constant k: c x + k >= 0 is x + floor(k / c) >= 0.
        common = math.gcd(*(factor for monomial, factor in poly.terms.items() if monomial)) or 1
        poly = Poly({monomial: factor // common for monomial, factor in poly.terms.items()})
        found = [monomial for monomial in poly.terms if len(monomial) == 1 and monomial[0] in self.quotients]
        if len(found) != 1 or abs(poly.terms[found[0]]) != 1:
            return False
        a, b = self.quotients[found[0][0]]
        bound = poly - Poly({found[0]: poly.terms[found[0]]})
        holds = self.holds(a + bound * b if poly.terms[found[0]] > 0 else b * (bound + 1) - 1 - a)
        if holds and bound.constant is not None:
            self.assume(poly)
        return holds

    def _answer(self, *negated: z3.BoolRef) -> z3.CheckSatResult:
        self._solver.push()
        self._solver.add(*negated)
        answer = self._solver.check()
        self._solver.pop()
        return answer

    def is_possible(self) -> bool:
        """Whether z3 finds values of all unknowns, products taken for unknowns, for which what is known holds."""
        return not self.facts or self._answer() == z3.sat

    def within(self, poly: Poly, low: int, high: int) -> bool:
        """Whether low <= poly <= high is proven."""
        return self.holds(poly - low) and self.holds(high - poly)

    def prove(self, poly: Poly, what: str, zero: bool = False) -> None:
        """poly >= 0 (or == 0), or a ProofError."""
        if not self.holds(poly) or (zero and not self.holds(-poly)):
            raise ProofError(f"{what}: not proven; {self.example(poly, zero)}")

    def example(self, poly: Poly, zero: bool = False) -> str:
        """Values of the inputs with which the linear problem lets it fail; products of atoms may be off in it."""
        expression = self._linear(poly)
        self._solver.push()
        self._solver.add(expression != 0 if zero else expression < 0)
        answer = self._solver.check()
        text = "z3 gave up"
        if answer == z3.sat:
            model = self._solver.model()
            values = [f"{atom.name} = {model[self._variable((atom,))]}" for atom in self._atoms[:16]]
            text = "for example " + ", ".join(values)
        self._solver.pop()
        return text

    def prove_real(self, poly: Poly, what: str, facts: Iterable[Fact] = (), timeout_ms: int = 20_000) -> None:
        """poly >= 0 follows from the given facts and the atoms' bounds over the reals; it is known afterwards."""
        chosen = list(facts)
        atoms = {atom for fact in [*chosen, Fact(poly)] for monomial in fact.poly.terms for atom in monomial}
        prove_over_reals(poly, chosen, atoms, what, timeout_ms)
        self.assume(poly)

    # --- what programs do ---

    def quotient(self, a: Poly, b: Poly) -> Poly:
        """floor(a / b), a >= 0, b >= 1, both unknown."""
        for atom, (dividend, divisor) in self.quotients.items():
            if dividend.terms == a.terms and divisor.terms == b.terms:
                return Poly({(atom,): 1})
        return self.new_quotient(a, b, 0, max(0, self.bounds(a)[1] // max(1, b.interval()[0])))

    def new_quotient(self, a: Poly, b: Poly, low: int, high: int) -> Poly:
        """floor(a / b), b >= 1, in [low, high]."""
        quotient = self.atom("quotient", low, high)
        self.assume(a - quotient * b)
        self.assume(quotient * b + b - 1 - a)
        self.quotients[next(iter(quotient.terms))[0]] = (a, b)
        return quotient

    def decide(self, if_true: Poly, if_false: Poly) -> bool:
        """Splits the path: true knows if_true >= 0, false knows if_false >= 0. One of them always holds."""
        low, high = if_true.interval()
        if low >= 0:
            return True
        if high < 0:
            return False
        if self._taken < len(self._decisions):
            choice = self._decisions[self._taken]
        else:
            # Of an unknown that no fact mentions both sides are taken for possible: nothing but its bounds could tell.
            free = any(len(m) == 1 and m[0] not in self._mentioned for m in if_true.terms)
            can_be_true = free or self._answer(self._linear(if_true) >= 0) != z3.unsat
            can_be_false = free or self._answer(self._linear(if_false) >= 0) != z3.unsat
            if not can_be_true and not can_be_false:
                raise Infeasible
            choice = can_be_true
            if can_be_true and can_be_false:
                self.open.append([*self._decisions, False])
            self._decisions.append(choice)
        self._taken += 1
        self.assume(if_true if choice else if_false)
        return choice

    def choose(self, poly: Poly) -> int:
        """Splits the path into one for each value that poly can have."""
        low, high = poly.interval()
        while low < high:
            middle = (low + high) // 2
            if self.decide(middle - poly, poly - middle - 1):
                high = middle
            else:
                low = middle + 1
        if poly.constant is None:
            self.assume(poly - low, zero=True)
        return low

    def floor(self, poly: Poly, divisor: int) -> Poly:
        """floor(poly / divisor), divisor > 0."""
        constant = poly.constant
        if constant is not None:
            return Poly.of(constant // divisor)
        # What is a multiple of the divisor leaves the floor as it is; so does that much of the constant beside it.
        whole = Poly({monomial: factor // divisor for monomial, factor in poly.terms.items() if factor % divisor == 0})
        if whole.terms:
            whole += poly.terms.get((), 0) // divisor if () not in whole.terms else 0
            return whole + self.floor(poly - whole * divisor, divisor)
        # So does a common factor.
        common = math.gcd(divisor, *poly.terms.values())
        if common > 1:
            divisor //= common
            poly = Poly({monomial: factor // common for monomial, factor in poly.terms.items()})
        low, high = self.bounds(poly)
        if low // divisor == high // divisor:
            return Poly.of(low // divisor)
        # So does what factors have beside multiples of a part of the divisor, where all of that is below the part.
        for part in sorted({divisor, *(math.gcd(factor, divisor) for factor in poly.terms.values())} - {1}):
            rest = Poly({monomial: factor % part for monomial, factor in poly.terms.items()})
            least, most = rest.interval()
            if rest.terms and least >= 0 and most < part:
                whole = Poly({monomial: factor // part for monomial, factor in poly.terms.items()})
                return self.floor(whole, divisor // part)
        monomial = next(iter(poly.terms)) if len(poly.terms) == 1 else ()
        inner = self._floor_of.get(monomial[0]) if len(monomial) == 1 else None
        if inner is not None and poly.terms == inner[0].terms:
            # floor(floor(a / b) / c) = floor(a / (b c))
            outer = self.floor(inner[1], inner[2] * divisor)
            self._assume_floor(poly, outer, divisor)
            return outer
        key = (frozenset(poly.terms.items()), divisor)
        if key not in self._floors:
            if low < 0 <= high and self.holds(poly):
                low = 0
            quotient = self.atom("q", low // divisor, high // divisor)
            self._assume_floor(poly, quotient, divisor)
            self._floors[key] = quotient
            self._floor_of[next(iter(quotient.terms))[0]] = (quotient, poly, divisor)
        return self._floors[key]

    def _assume_floor(self, poly: Poly, quotient: Poly, divisor: int) -> None:
        self.assume(poly - quotient * divisor)
        self.assume(quotient * divisor + (divisor - 1) - poly)

    def assume_product(self, a: Poly, b: Poly) -> None:
        """A product of two numbers that are proven not to be negative is not negative."""
        self.prove(a, f"{a} >= 0")
        self.prove(b, f"{b} >= 0")
        self.assume(a * b)


def prove_over_reals(
    poly: Poly, facts: Iterable[Fact], atoms: Iterable[Atom], what: str, timeout_ms: int = 20_000
) -> None:
    """poly >= 0 wherever the facts hold and the atoms are within their bounds, as reals; else a ProofError."""
    variables = {atom: z3.Real(atom.name) for atom in atoms}

    def real(polynomial: Poly) -> z3.ArithRef:
        return z3.Sum(
            [z3.RealVal(0)]
            + [z3.Product([z3.RealVal(factor), *(variables[a] for a in m)]) for m, factor in polynomial.terms.items()]
        )

    solver = z3.SolverFor("QF_NRA")
    solver.set("timeout", timeout_ms)
    for atom, variable in variables.items():
        solver.add(variable >= atom.low, variable <= atom.high)
    for fact in facts:
        solver.add(real(fact.poly) == 0 if fact.zero else real(fact.poly) >= 0)
    solver.add(real(poly) < 0)
    answer = solver.check()
    if answer != z3.unsat:
        raise ProofError(f"{what}: not proven over the reals: {solver.model() if answer == z3.sat else 'z3 gave up'}")


def every_path(body: Callable[[Path], None], limit: int = 20_000) -> int:
    """Runs body on each path; the number of paths that are possible. More than `limit` is an error, not an end."""
    # A context of its own, if any: z3's answers, and the time they take, depend on what else it was asked in one.
    context = functools.cache(z3.Context)
    pending: list[list[bool]] = [[]]
    count = tried = 0
    possible = False
    while pending:
        path = Path(pending.pop(), context)
        tried += 1
        if tried > limit:
            raise ProofError(f"more than {limit} paths")
        try:
            body(path)
            count += 1
            possible = possible or path.is_possible()
        except Infeasible:
            pass
        pending += path.open
    if not possible:
        raise ProofError("no path is possible: the domain is empty, and nothing was proven")
    return count
