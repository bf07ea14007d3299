"""C11 with all integers at once: executes a function of the firmware on symbolic numbers, path by path.

What C leaves undefined is an error: in arithmetic (c_arithmetic), an index outside its array, reading what was never
written.

A lemma is a Python function that is called when a local variable gets a value: it may prove facts about it that the
path then knows, or return the same value written otherwise (and prove that it is the same).

A call may be replaced by a contract: a Python function that proves the callee's precondition and returns its result as
a new unknown with the postcondition. Functions proven that way elsewhere need not be executed again.

Not all of C: what the firmware uses. Anything else raises NotImplementedError.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from pycparser import c_ast

from c_arithmetic import Arithmetic
from c_source import Unit
from c_values import (
    I64,
    INT,
    KEYWORDS,
    U64,
    UINT,
    ArrayType,
    Cell,
    IntType,
    Memory,
    Number,
    Pointer,
    PointerType,
    StructType,
)
from symbolic import Path, Poly, ProofError


class _Return(Exception):
    def __init__(self, value: Any) -> None:
        self.value = value


class _Break(Exception):
    pass


class _Continue(Exception):
    pass


Contract = Callable[["Machine", list[Any]], Any]
Lemma = Callable[["Machine", Number], Number]


@dataclass
class Machine(Arithmetic):
    """Executes functions of one unit on one path."""

    unit: Unit
    path: Path
    modular: Collection[str] = ()
    contracts: Mapping[str, Contract] = field(default_factory=dict)
    lemmas: Mapping[str, Lemma] = field(default_factory=dict)  # by "function.local"
    packs: bool = False  # | puts fields together: they must not overlap
    rough: bool = False  # quotients are known within one unit only: no path for each sign of a dividend
    scopes: list[dict[str, Cell]] = field(default_factory=list)
    functions: list[str] = field(default_factory=list)
    locals: dict[str, Number] = field(default_factory=dict)  # the last value of each local, by "function.name"
    _globals: dict[str, Cell] = field(default_factory=dict)
    _inside: list[str] = field(default_factory=list)  # structs whose members' types are being looked up

    # --- making inputs ---

    def number(self, c_type: str, name: str, low: int | None = None, high: int | None = None) -> Number:
        """An unknown of that type, anywhere in it or in [low, high]."""
        of = self.type_named(c_type)
        return Number(of, self.path.atom(name, of.low if low is None else low, of.high if high is None else high))

    def exactly(self, c_type: str, value: Poly | int) -> Number:
        return Number(self.type_named(c_type), Poly.of(value))

    def struct(self, name: str, **fields: Any) -> Cell:
        """A struct with the given fields (Numbers, ints, polynomials, lists); the others were never written."""
        cell = self.allocate(self.type_named(name))
        for field_name, value in fields.items():
            self.put(cell.content[field_name], value)
        return cell

    def array(self, c_type: str, values: Sequence[Any]) -> Pointer:
        cells = [Cell(self.type_named(c_type)) for _ in values]
        for cell, value in zip(cells, values, strict=True):
            self.put(cell, value)
        return Pointer(cells)

    def put(self, cell: Cell, value: Any) -> None:
        if isinstance(value, (int, Poly)):
            value = Number(cell.type, Poly.of(value))
            if not self.path.within(value.poly, cell.type.low, cell.type.high):
                raise ProofError(f"{value.poly} is no {cell.type}: the domain is wrong")
        if isinstance(value, (list, tuple)):
            for place, item in zip(cell.content, value, strict=True):
                self.put(place, item)
        elif isinstance(value, Cell):
            self.copy(cell, value)
        else:
            cell.content = value

    def poly(self, cell: Cell, *way: str | int) -> Poly:
        """The number at cell.way[0].way[1]..."""
        for step in way:
            cell = cell.content[step]
        content = self.load(cell)
        assert isinstance(content, Number)
        return content.poly

    # --- types ---

    def type_named(self, name: str) -> Any:
        if name in self.unit.typedefs:
            return self.type_of(self.unit.typedefs[name])
        return KEYWORDS[name]

    def type_of(self, node: c_ast.Node) -> Any:
        if isinstance(node, (c_ast.TypeDecl, c_ast.Typename, c_ast.Decl)):
            return self.type_of(node.type)
        if isinstance(node, c_ast.IdentifierType):
            return self.type_named(" ".join(node.names))
        if isinstance(node, (c_ast.Struct, c_ast.Union)):
            # A union's members lie apart here: reading one that was not written is an error.
            decls = node.decls if node.decls is not None else self.unit.structs[node.name].decls
            self._inside.append(node.name)
            fields: list[tuple[str, Any]] = []
            for decl in decls:
                kind = self.type_of(decl.type)
                # What an anonymous member has are the struct's own.
                fields += [(decl.name, kind)] if decl.name is not None else kind.fields
            self._inside.pop()
            return StructType(node.name or "", tuple(fields))
        if isinstance(node, c_ast.Enum):
            return UINT
        if isinstance(node, c_ast.ArrayDecl):
            length = 0 if node.dim is None else self.constant(node.dim)
            return ArrayType(self.type_of(node.type), length)
        if isinstance(node, c_ast.PtrDecl):
            return PointerType(None if self._is_opaque(node.type) else self.type_of(node.type))
        raise NotImplementedError(type(node).__name__)

    def _is_opaque(self, node: c_ast.Node) -> bool:
        if isinstance(node, c_ast.FuncDecl):
            return True
        while isinstance(node, (c_ast.TypeDecl, c_ast.ArrayDecl, c_ast.PtrDecl)):
            node = node.type
        if not isinstance(node, c_ast.Struct) or node.decls is not None:
            return False
        # One that points to itself would have no end.
        return node.name in self._inside or node.name not in self.unit.structs

    def constant(self, node: c_ast.Node) -> int:
        value = self.evaluate(node).poly.constant
        assert value is not None
        return int(value)

    def allocate(self, of: Any) -> Cell:
        if isinstance(of, StructType):
            return Cell(of, {name: self.allocate(kind) for name, kind in of.fields})
        if isinstance(of, ArrayType):
            return Cell(of, [self.allocate(of.element) for _ in range(of.length)])
        return Cell(of)

    # --- memory ---

    def load(self, cell: Cell) -> Any:
        if isinstance(cell.type, ArrayType):
            return cell.content if isinstance(cell.content, Memory) else Pointer(cell.content)
        if isinstance(cell.type, StructType):
            return cell
        if cell.content is None:
            raise ProofError("reads what was never written")
        return cell.content

    def store(self, cell: Cell, value: Any, where: c_ast.Node | None) -> None:
        if isinstance(value, Number):
            cell.content = self.convert(value, cell.type, where)
        elif isinstance(value, Cell):
            self.copy(cell, value)
        else:
            cell.content = value

    def copy(self, to: Cell, source: Cell) -> None:
        to.stands_for = source.stands_for
        if isinstance(source.content, dict):
            for name, cell in source.content.items():
                self.copy(to.content[name], cell)
        elif isinstance(source.content, list):
            for a, b in zip(to.content, source.content, strict=True):
                self.copy(a, b)
        else:
            to.content = source.content

    def note_local(self, name: str, cell: Cell) -> None:
        """A local got a value: keeps it, and lets a lemma learn from it or write it in another way."""
        key = f"{self.functions[-1]}.{name}"
        if isinstance(cell.content, Number):
            if key in self.lemmas:
                cell.content = self.lemmas[key](self, cell.content)
            self.locals[key] = cell.content

    # --- expressions ---

    def evaluate(self, node: c_ast.Node) -> Any:
        return getattr(self, f"_expr_{type(node).__name__}")(node)

    def _expr_Constant(self, node: c_ast.Constant) -> Any:
        if node.type == "char":
            return Number(INT, Poly.of(ord(node.value[1])))
        text = node.value.lower()
        digits = text.rstrip("ul")
        value = int(digits, 0)
        suffix = text[len(digits) :]
        candidates = [INT, UINT, I64, U64] if digits.startswith("0x") else [INT, I64]
        if "u" in suffix:
            candidates = [UINT, U64]
        if "ll" in suffix:
            candidates = [of for of in candidates if of.bits == 64]
        return Number(next(of for of in candidates if value <= of.high), Poly.of(value))

    def _expr_ID(self, node: c_ast.ID) -> Any:
        if node.name in self.unit.constants and not any(node.name in scope for scope in self.scopes):
            return Number(INT, self.evaluate(self.unit.constants[node.name]).poly)
        return self.load(self.lvalue(node))

    def lvalue(self, node: c_ast.Node) -> Cell:
        if isinstance(node, c_ast.ID):
            for scope in reversed(self.scopes):
                if node.name in scope:
                    return scope[node.name]
            if node.name in self.unit.variables:
                if node.name not in self._globals:
                    decl = self.unit.variables[node.name]
                    self._globals[node.name] = self.declared(decl)
                return self._globals[node.name]
            raise NotImplementedError(f"{node.coord}: {node.name}")
        if isinstance(node, c_ast.StructRef):
            base = self.evaluate(node.name).cell if node.type == "->" else self.lvalue(node.name)
            cell: Cell = base.content[node.field.name]
            return cell
        if isinstance(node, c_ast.ArrayRef):
            pointer = self.evaluate(node.name)
            subscript = self.evaluate(node.subscript).poly
            if isinstance(pointer, Memory):
                self.path.prove(subscript, f"{node.coord}: index >= 0")
                self.path.prove(pointer.length - 1 - subscript, f"{node.coord}: index < length")
                return Cell(pointer.type, Number(pointer.type, pointer.element(self.path, subscript)))
            return Pointer(pointer.cells, pointer.index + self.path.choose(subscript)).cell
        if isinstance(node, c_ast.UnaryOp) and node.op == "*":
            target: Cell = self.evaluate(node.expr).cell
            return target
        value = self.evaluate(node)
        assert isinstance(value, Cell), type(node).__name__
        return value

    def _expr_StructRef(self, node: c_ast.StructRef) -> Any:
        return self.load(self.lvalue(node))

    def _expr_ArrayRef(self, node: c_ast.ArrayRef) -> Any:
        return self.load(self.lvalue(node))

    def _expr_Cast(self, node: c_ast.Cast) -> Any:
        value = self.evaluate(node.expr)
        return self.convert(value, self.type_of(node.to_type), node) if isinstance(value, Number) else value

    def _expr_TernaryOp(self, node: c_ast.TernaryOp) -> Any:
        holds = not self.is_zero(self.evaluate(node.cond))
        chosen = self.evaluate(node.iftrue if holds else node.iffalse)
        if not isinstance(chosen, Number):
            return chosen
        of = self.common(chosen.type, self.static_type(node.iffalse if holds else node.iftrue))
        return self.convert(chosen, of, node)

    def static_type(self, node: c_ast.Node) -> IntType:
        """The type of an expression that is not executed."""
        if isinstance(node, c_ast.Constant):
            return self.evaluate(node).type  # type: ignore[no-any-return]
        if isinstance(node, c_ast.Cast):
            return self.type_of(node.to_type)  # type: ignore[no-any-return]
        if isinstance(node, c_ast.UnaryOp):
            return INT if node.op == "!" else self.promoted(self.static_type(node.expr))
        if isinstance(node, c_ast.TernaryOp):
            return self.common(self.static_type(node.iftrue), self.static_type(node.iffalse))
        if isinstance(node, c_ast.BinaryOp):
            if node.op in ("<", "<=", ">", ">=", "==", "!=", "&&", "||"):
                return INT
            left = self.static_type(node.left)
            return self.promoted(left) if node.op in ("<<", ">>") else self.common(left, self.static_type(node.right))
        if isinstance(node, c_ast.FuncCall):
            if node.name.name.startswith("__builtin_clz"):
                return INT
            return self.type_of(self.unit.functions[node.name.name].decl.type.type)  # type: ignore[no-any-return]
        if isinstance(node, c_ast.ID) and node.name in self.unit.constants:
            return INT
        if isinstance(node, c_ast.ArrayRef):
            elements = self.evaluate(node.name)
            element: IntType = elements.type if isinstance(elements, Memory) else elements.cells[0].type
            return element
        return self.lvalue(node).type  # type: ignore[no-any-return]

    def _expr_UnaryOp(self, node: c_ast.UnaryOp) -> Any:
        if node.op == "&":
            target = node.expr
            if isinstance(target, c_ast.ArrayRef):
                pointer = self.evaluate(target.name)
                return Pointer(pointer.cells, pointer.index + self.path.choose(self.evaluate(target.subscript).poly))
            return Pointer([self.lvalue(target)])
        if node.op == "*":
            return self.load(self.lvalue(node))
        if node.op in ("p++", "p--", "++", "--"):
            cell = self.lvalue(node.expr)
            old = self.load(cell)
            up = "+" in node.op
            if isinstance(old, Pointer):
                new: Any = Pointer(old.cells, old.index + (1 if up else -1))
            else:
                new = self.binary("+" if up else "-", old, Number(INT, Poly.of(1)), node)
            self.store(cell, new, node)
            return old if node.op.startswith("p") else self.load(cell)
        if node.op == "!":
            return self.boolean(self.is_zero(self.evaluate(node.expr)))
        value = self.evaluate(node.expr)
        of = self.promoted(value.type)
        if node.op == "-":
            return self.fit(-value.poly, of, node)
        if node.op == "~":
            return Number(of, -1 - value.poly if of.signed else of.high - value.poly)
        if node.op == "+":
            return self.convert(value, of, node)
        raise NotImplementedError(f"{node.coord}: {node.op}")

    def _expr_BinaryOp(self, node: c_ast.BinaryOp) -> Any:
        if node.op in ("&&", "||"):
            left = not self.is_zero(self.evaluate(node.left))
            if left == (node.op == "||"):
                return self.boolean(left)
            return self.boolean(not self.is_zero(self.evaluate(node.right)))
        left, right = self.evaluate(node.left), self.evaluate(node.right)
        if isinstance(left, Pointer) and isinstance(right, Number) and node.op in ("==", "!="):
            return self.boolean(node.op == "!=")  # NULL is the only number that a pointer may be compared with
        if isinstance(left, Pointer) and isinstance(right, Number):
            offset = self.path.choose(right.poly)
            return Pointer(left.cells, left.index + (offset if node.op == "+" else -offset))
        if isinstance(left, Pointer) or isinstance(right, Pointer):
            same = left is right
            if isinstance(left, Pointer) and isinstance(right, Pointer):
                same = same or (left.cells is right.cells and left.index == right.index)
            return self.boolean(same == (node.op == "=="))
        return self.binary(node.op, left, right, node)

    def _expr_Assignment(self, node: c_ast.Assignment) -> Any:
        if node.op == "=":
            value = self.evaluate(node.rvalue)
        else:
            value = self.binary(node.op[:-1], self.load(self.lvalue(node.lvalue)), self.evaluate(node.rvalue), node)
        cell = self.lvalue(node.lvalue)
        self.store(cell, value, node)
        if isinstance(node.lvalue, c_ast.ID):
            self.note_local(node.lvalue.name, cell)
        return self.load(cell)

    def _expr_CompoundLiteral(self, node: c_ast.CompoundLiteral) -> Cell:
        cell = self.allocate(self.type_of(node.type))
        self.initialise(cell, node.init)
        return cell

    def _expr_FuncCall(self, node: c_ast.FuncCall) -> Any:
        name = node.name.name
        arguments = [self.evaluate(argument) for argument in (node.args.exprs if node.args else [])]
        if name in ("__builtin_clz", "__builtin_clzll"):
            return self.leading_zeros(arguments[0], 64 if name.endswith("ll") else 32, node)
        return self.call(name, *arguments)

    # --- functions and statements ---

    def call(self, name: str, *arguments: Any) -> Any:
        """Calls a function, or its contract. A struct goes by value as a cell, by address as Pointer([cell])."""
        if name in self.contracts:
            return self.contracts[name](self, list(arguments))
        function = self.unit.functions[name]
        parameters = function.decl.type.args.params if function.decl.type.args else []
        scope: dict[str, Cell] = {}
        outer, self.scopes = self.scopes, [scope]
        self.functions.append(name)
        for parameter, argument in zip(parameters, arguments, strict=True):
            of = self.type_of(parameter.type)
            if isinstance(of, ArrayType):
                of = PointerType(of.element)
            cell = self.allocate(of)
            self.store(cell, argument, parameter)
            scope[parameter.name] = cell
        returned = self.type_of(function.decl.type.type)
        value = None
        try:
            self.execute(function.body)
        except _Return as result:
            value = result.value
            if isinstance(value, Number):
                value = self.convert(value, returned, function.decl)
        finally:
            self.functions.pop()
            self.scopes = outer
        return value

    def declared(self, node: c_ast.Decl) -> Cell:
        of = self.type_of(node.type)
        cell = self.allocate(of)
        if isinstance(node.init, c_ast.InitList):
            self.initialise(cell, node.init)
        elif node.init is not None:
            self.store(cell, self.evaluate(node.init), node)
        return cell

    def initialise(self, cell: Cell, init: c_ast.Node) -> None:
        """What an initialiser list does not name is zero."""
        if not isinstance(init, c_ast.InitList):
            value = self.evaluate(init)
            if isinstance(value, Number) and not isinstance(cell.type, IntType) and value.poly.constant == 0:
                self.zero(cell)  # {0}, without the braces of what is inside
            else:
                self.store(cell, value, init)
            return
        self.zero(cell)
        names = list(cell.content) if isinstance(cell.content, dict) else range(len(cell.content))
        position = 0
        for item in init.exprs:
            value = item
            if isinstance(item, c_ast.NamedInitializer):
                designator = item.name[0]
                name = designator.name if isinstance(designator, c_ast.ID) else self.constant(designator)
                position = list(names).index(name)
                value = item.expr
            self.initialise(cell.content[list(names)[position]], value)
            position += 1

    def zero(self, cell: Cell) -> None:
        if isinstance(cell.content, (dict, list)):
            for inner in cell.content.values() if isinstance(cell.content, dict) else cell.content:
                self.zero(inner)
        if isinstance(cell.type, IntType):
            cell.content = Number(cell.type, Poly.of(0))

    def execute(self, node: c_ast.Node) -> None:
        getattr(self, f"_stmt_{type(node).__name__}", self._stmt_expression)(node)

    def _stmt_expression(self, node: c_ast.Node) -> None:
        if not isinstance(node, (c_ast.EmptyStatement, c_ast.StaticAssert)):
            self.evaluate(node)

    def _stmt_Compound(self, node: c_ast.Compound) -> None:
        self.scopes.append({})
        try:
            for item in node.block_items or []:
                self.execute(item)
        finally:
            self.scopes.pop()

    def _stmt_Decl(self, node: c_ast.Decl) -> None:
        if node.name is None:
            return
        cell = self.declared(node)
        self.scopes[-1][node.name] = cell
        self.note_local(node.name, cell)

    def _stmt_DeclList(self, node: c_ast.DeclList) -> None:
        for decl in node.decls:
            self.execute(decl)

    def _stmt_Return(self, node: c_ast.Return) -> None:
        value = None if node.expr is None else self.evaluate(node.expr)
        raise _Return(value)

    def _stmt_If(self, node: c_ast.If) -> None:
        if not self.is_zero(self.evaluate(node.cond)):
            self.execute(node.iftrue)
        elif node.iffalse is not None:
            self.execute(node.iffalse)

    def _stmt_For(self, node: c_ast.For) -> None:
        self.scopes.append({})
        try:
            if node.init is not None:
                self.execute(node.init)
            while node.cond is None or not self.is_zero(self.evaluate(node.cond)):
                with contextlib.suppress(_Continue):
                    self.execute(node.stmt)
                if node.next is not None:
                    self.evaluate(node.next)
        except _Break:
            pass
        finally:
            self.scopes.pop()

    def _stmt_While(self, node: c_ast.While) -> None:
        try:
            while not self.is_zero(self.evaluate(node.cond)):
                with contextlib.suppress(_Continue):
                    self.execute(node.stmt)
        except _Break:
            pass

    def _stmt_DoWhile(self, node: c_ast.DoWhile) -> None:
        try:
            while True:
                with contextlib.suppress(_Continue):
                    self.execute(node.stmt)
                if self.is_zero(self.evaluate(node.cond)):
                    break
        except _Break:
            pass

    def _stmt_Switch(self, node: c_ast.Switch) -> None:
        value = self.evaluate(node.cond).poly
        chosen = False
        try:
            for case in node.stmt.block_items:
                if not chosen:
                    chosen = isinstance(case, c_ast.Default) or self.path.choose(value) == self.constant(case.expr)
                if chosen:
                    for statement in case.stmts or []:
                        self.execute(statement)
        except _Break:
            pass

    def _stmt_Break(self, node: c_ast.Break) -> None:
        raise _Break

    def _stmt_Continue(self, node: c_ast.Continue) -> None:
        raise _Continue
