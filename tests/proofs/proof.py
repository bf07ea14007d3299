"""What all proofs share: run a function on its whole domain, and run the same domain on samples against the compiler.

A domain is a Python function that makes the arguments of a C function on a machine: numbers with bounds, and the facts
that the header states as the precondition. `prove` executes the C on all of it at once. `agree` draws samples of the
same domain, executes the same C with them one by one, and compares with what the compiler makes of it: whatever the
proofs believe about C is checked there.
"""

from __future__ import annotations

import ctypes
import random
import subprocess
import tempfile
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import Any

import pytest

from c_execution import Contract, Lemma, Machine
from c_source import ARMV6M, SMALL_CODE, SOURCES, Fault, companions_of, core_options, parse
from c_values import ArrayType, Cell, IntType, Number, Pointer, PointerType, StructType
from symbolic import Fact, Infeasible, Path, Poly, ProofError, every_path, require

Domain = Callable[[Machine], list[Any]]
Check = Callable[[Machine, list[Any], Any], None]

EVERY_PRECISION = pytest.mark.parametrize("bits", [4, 6, 8])


@dataclass(frozen=True)
class Subject:
    """A function, its domain, and how it may be reasoned about."""

    file: str  # relative to firmware/src
    function: str
    domain: Domain
    check: Check | None = None
    modular: Collection[str] = ()
    contracts: Mapping[str, Contract] | None = None
    lemmas: Mapping[str, Lemma] | None = None
    packs: bool = False
    rough: bool = False
    core: str = ""  # as c_source.parse has it

    def prove(self, bits: int = 4, fault: Fault | None = None) -> int:
        """Executes the function on its whole domain; the number of paths. ProofError if anything is not proven."""
        unit = parse(self.file, bits, fault, self.core)

        def body(path: Path) -> None:
            contracts, lemmas = self.contracts or {}, self.lemmas or {}
            machine = Machine(unit, path, self.modular, contracts, lemmas, self.packs, self.rough)
            arguments = self.domain(machine)
            result = machine.call(self.function, *arguments)
            if self.check is not None:
                self.check(machine, arguments, result)

        return every_path(body)

    def fails_with(self, fault: Fault | None, bits: int = 4) -> None:
        """The proof of the faulty source must fail; or of a domain that is too large."""
        with pytest.raises(ProofError):
            self.prove(bits, fault)

    def agree(self, bits: int = 4, count: int = 200) -> None:
        """The machine and the compiler agree on `count` samples of the domain."""
        _agree(self, bits, count)


# --- samples ----------------------------------------------------------------------------------------------------------


class _Sample(Path):
    """A path on which each input is one value: at an end of its range, near one, or of any size in it."""

    def __init__(self, rng: random.Random) -> None:
        super().__init__([])
        self._rng = rng

    def atom(self, name: str, low: int, high: int) -> Poly:
        if low > high:
            raise Infeasible
        rng = self._rng
        kind = rng.randrange(4)
        if kind == 0:
            value = rng.choice((low, high, low + 1, high - 1, 0, 1, -1))
        elif kind == 1:
            value = rng.randint(low, high)
        else:
            value = rng.getrandbits(rng.randint(1, max(abs(low), abs(high), 1).bit_length()))
            value = -value if low < 0 and rng.random() < 0.5 else value
        return Poly.of(min(max(value, low), high))

    def prove_real(self, poly: Poly, what: str, facts: object = (), timeout_ms: int = 0) -> None:
        """Lemmas are for the whole domain."""


def as_unknown(machine: Machine, value: Number, low: int | None = None, high: int | None = None) -> Number:
    """The same value as one unknown, with bounds that are proven: what is computed from it has fewer terms."""
    path = machine.path
    if value.poly.constant is not None:
        return value
    bounds = path.bounds(value.poly)
    low, high = bounds[0] if low is None else low, bounds[1] if high is None else high
    path.prove(value.poly - low, f"not below {low}")
    path.prove(high - value.poly, f"not above {high}")
    unknown = path.atom("unknown", low, high)
    path.assume(unknown - value.poly, zero=True)
    return Number(value.type, unknown)


def quotient_of(path: Path, poly: Poly, by: Poly, what: str) -> None:
    """poly >= 0, from poly * by > -by, which the path must know already: by >= 1."""
    path.prove(by - 1, f"{what}: the divisor is positive")
    path.prove(poly * by + by - 1, what)
    path.assume(poly)


def congruent(a: Poly, b: Poly, modulus: int, what: str) -> None:
    """a - b is a multiple of the modulus whatever the unknowns are: each of its terms is."""
    require(all(factor % modulus == 0 for factor in (a - b).terms.values()), what)


def _leaves(of: Any, way: str = "") -> list[tuple[str, IntType]]:
    """The numbers in an object of that type, as C designators; pointers within it are left out."""
    if isinstance(of, IntType):
        return [(way, of)]
    if isinstance(of, StructType):
        return [leaf for name, inner in of.fields for leaf in _leaves(inner, f"{way}.{name}")]
    if isinstance(of, ArrayType):
        return [leaf for i in range(of.length) for leaf in _leaves(of.element, f"{way}[{i}]")]
    return []


def _values(cell: Cell) -> list[int | None]:
    """The numbers in an object, in the order of _leaves; None for what was never written."""
    if isinstance(cell.content, dict):
        return [value for inner in cell.content.values() for value in _values(inner)]
    if isinstance(cell.content, list):
        return [value for inner in cell.content for value in _values(inner)]
    if isinstance(cell.type, IntType):
        return [None if cell.content is None else cell.content.poly.constant]
    return []


def _wrapper(machine: Machine, name: str, shapes: list[Any]) -> str:
    """C: takes all numbers of the arguments in one array, calls the function, gives all numbers back in another."""
    declaration = machine.unit.functions[name].decl
    returned = machine.type_of(declaration.type.type)
    lines = [f"void proof_{name}(const long long *in, long long *out)", "{"]
    passed, results = [], []
    for i, (parameter, shape) in enumerate(zip(declaration.type.args.params, shapes, strict=True)):
        of = machine.type_of(parameter.type)
        if isinstance(of, (PointerType, ArrayType)):
            target = of.target if isinstance(of, PointerType) else of.element
            lines.append(f"    {_c_name(target)} a{i}[{shape}] = {{0}};")
            passed.append(f"a{i}")
            leaves = [(f"a{i}[{k}]{way}", kind) for k in range(shape) for way, kind in _leaves(target)]
            results += leaves
        else:
            lines.append(f"    {_c_name(of)} a{i} = {{0}};")
            passed.append(f"a{i}")
            leaves = [(f"a{i}{way}", kind) for way, kind in _leaves(of)]
        lines += [f"    {place} = ({_c_name(kind)})*in++;" for place, kind in leaves]
    call = f"{name}({', '.join(passed)})"
    if returned != "void":
        lines.append(f"    {_c_name(returned)} result = {call};")
        results += [(f"result{way}", kind) for way, kind in _leaves(returned)]
    else:
        lines.append(f"    {call};")
    lines += [f"    *out++ = (long long){place};" for place, _ in results]
    return "\n".join([*lines, "}", ""])


def _c_name(of: Any) -> str:
    if isinstance(of, StructType):
        return of.name
    if of == IntType(1, False):
        return "bool"
    return str(of) if isinstance(of, IntType) else "struct"


def compile_c(text: str, output: FilePath, *options: str, tree: FilePath = SOURCES) -> None:
    """Compiles one C text that may include files of firmware/src, sources too."""
    source = output.with_suffix(".c")
    source.write_text(text, encoding="utf-8")
    command = ["cc", "-std=c11", "-O2", "-w", "-I", str(tree), *options, str(source), "-o", str(output)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def _agree(subject: Subject, bits: int, count: int) -> None:
    unit = parse(subject.file, bits, core=subject.core)
    rng = random.Random(f"{subject.function} {bits}")
    samples: list[tuple[list[Any], list[int | None], list[int | None]]] = []
    tries = 0
    while len(samples) < count:
        tries += 1
        assert tries < 200 * count, f"{subject.function}: too few samples satisfy the precondition"
        machine = Machine(unit, _Sample(rng), subject.modular)
        try:
            arguments = subject.domain(machine)
        except (Infeasible, ProofError):
            continue
        given = [value for argument in arguments for value in _flat(argument)]
        result = machine.call(subject.function, *arguments)
        expected = [value for argument in arguments if isinstance(argument, Pointer) for value in _flat(argument)]
        expected += _flat(result) if result is not None else []
        samples.append((arguments, given, expected))

    shapes = [len(argument.cells) if isinstance(argument, Pointer) else 1 for argument in samples[0][0]]
    text = f'#include "{subject.file}"\n#include <stdbool.h>\n' + _wrapper(machine, subject.function, shapes)
    with tempfile.TemporaryDirectory() as folder:
        library = FilePath(folder) / "subject.so"
        companions = [str(SOURCES / name) for name in companions_of(subject.file)]
        compile_c(
            text, library, "-shared", "-fPIC", f"-DEL_SUBPIXEL_BITS={bits}", *core_options(subject.core), *companions
        )
        function = getattr(ctypes.CDLL(str(library)), f"proof_{subject.function}")
        for _, given, expected in samples:
            words = (ctypes.c_longlong * (len(given) + 1))(*(_signed(value or 0) for value in given))
            out = (ctypes.c_longlong * (len(expected) + 1))()
            function(words, out)
            for i, value in enumerate(expected):
                assert value is None or _signed(value) == out[i], (
                    f"{subject.function}{given}: the machine has {expected}, the compiler {list(out)[:-1]}"
                )


def _signed(value: int) -> int:
    return value - (1 << 64) if value >= 1 << 63 else value


def _flat(value: Any) -> list[int | None]:
    if isinstance(value, Number):
        return [value.poly.constant]
    if isinstance(value, Pointer):
        return [number for cell in value.cells for number in _values(cell)]
    return _values(value)


__all__ = [
    "ARMV6M",
    "EVERY_PRECISION",
    "SMALL_CODE",
    "Fact",
    "Fault",
    "Lemma",
    "Machine",
    "Number",
    "Pointer",
    "Poly",
    "ProofError",
    "Subject",
    "as_unknown",
    "compile_c",
    "congruent",
    "quotient_of",
]
