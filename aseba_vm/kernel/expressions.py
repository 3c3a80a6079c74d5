"""Expressions of kernels as WebAssembly text, with their types."""

from __future__ import annotations

import ast
import inspect
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from aseba_vm.kernel.integers import instruction_of
from aseba_vm.kernel.record import Record, fields
from aseba_vm.kernel.signatures import ARRAYS, SCALARS, KernelError, parameters
from aseba_vm.kernel.types import Kernel, is_kernel

__all__ = ["Expressions", "Place", "Scope", "Tables", "Typed"]

_ARITHMETIC = {ast.Add: "add", ast.Sub: "sub", ast.Mult: "mul"}
_BITS = {ast.LShift: "shl", ast.RShift: "shr_s", ast.BitAnd: "and", ast.BitOr: "or", ast.BitXor: "xor"}
_COMPARISONS = {ast.Lt: "lt", ast.LtE: "le", ast.Gt: "gt", ast.GtE: "ge", ast.Eq: "eq", ast.NotEq: "ne"}

Typed = tuple[str, str]
"""Text and type of an expression."""


@dataclass(frozen=True, slots=True)
class Place:
    """The place of an array that all kernels of a module share: address in bytes and number of elements."""

    address: int
    count: int


class Tables:
    """The tuples of signed 16-bit integers that kernels read, and their addresses from `start` on."""

    def __init__(self, start: int | None) -> None:
        self._start = start
        self._placed: dict[tuple[int, ...], int] = {}

    def address(self, table: tuple[int, ...]) -> int | None:
        """The address of a table; None if the module has no room for tables."""
        if self._start is None:
            return None
        return self._placed.setdefault(table, self._start + 2 * sum(map(len, self._placed)))

    @property
    def text(self) -> str:
        """The data segments of all tables."""
        lines = []
        for table, address in self._placed.items():
            words = "".join(f"\\{byte:02x}" for word in table for byte in (word & 0xFFFF).to_bytes(2, "little"))
            lines.append(f'(data (i32.const {address}) "{words}")')
        return "\n".join(lines)


@dataclass(slots=True)
class Scope:
    """The names that the text of a kernel knows.

    `arrays` has the type of each array, those of a record as `record.field`; `places` the arrays at a fixed
    place; `types` the types of scalar parameters and local variables. `prefix` makes the names of local variables
    unique where the text becomes a part of another function.
    """

    kernel: Kernel
    tables: Tables
    places: Mapping[str, Place]
    prefix: str = ""
    arrays: dict[str, str] = field(default_factory=dict)
    types: dict[str, str] = field(default_factory=dict)
    records: dict[str, type[Record]] = field(default_factory=dict)

    @property
    def globals(self) -> dict[str, Any]:
        """The names of the kernel's module."""
        return getattr(self.kernel, "__globals__", {})


class Expressions:
    """Translates the expressions of one kernel."""

    def __init__(self, scope: Scope) -> None:
        self.scope = scope

    def name(self, node: ast.expr) -> str:
        """The name of a variable, or of a field of a record as `record.field`; empty for anything else."""
        match node:
            case ast.Name(id=name):
                return name
            case ast.Attribute(value=ast.Name(id=record), attr=field) if record in self.scope.records:
                return f"{record}.{field}"
        return ""

    def local(self, name: str) -> str:
        """The name of a local variable or parameter in the text."""
        return f"${self.scope.prefix}{name}"

    def address(self, array: str, index: ast.expr, shift: int) -> str:
        """The address of an element, as the immediate offset and the operand of an instruction."""
        place = self.scope.places.get(array)
        if place is not None and isinstance(index, ast.Constant):
            return f"offset={place.address + (self._whole(index) << shift)} (i32.const 0)"
        offset = f"(i32.shl {self.integer(index)} (i32.const {shift}))"
        if place is None:
            return f"(i32.add (local.get {self.local(array)}) {offset})"
        return offset if place.address == 0 else f"(i32.add {offset} (i32.const {place.address}))"

    def _whole(self, node: ast.Constant) -> int:
        if not isinstance(node.value, int) or node.value < 0:
            raise self.refuse(node)
        return node.value

    def integer(self, node: ast.expr) -> str:
        """The text of an expression that must be an integer."""
        text, kind = self.value(node)
        if kind != "i32":
            raise self.refuse(node)
        return text

    def convert(self, value: Typed, kind: str, node: ast.AST) -> str:
        """A value as a type; an integer may become a float, as in Python."""
        text, found = value
        if found == kind:
            return text
        if (found, kind) == ("i32", "f64"):
            return f"(f64.convert_i32_s {text})"
        raise self.refuse(node)

    def condition(self, node: ast.expr) -> str:
        """The text of a condition: not 0 if it is true."""
        match node:
            case ast.Compare(left=left, ops=[op], comparators=[right]) if type(op) in _COMPARISONS:
                (a, b), kind = self._alike(left, right)
                sign = "_s" if kind == "i32" and not isinstance(op, ast.Eq | ast.NotEq) else ""
                return f"({kind}.{_COMPARISONS[type(op)]}{sign} {a} {b})"
            case ast.Compare(left=left, ops=[first, *ops], comparators=[right, *others]) if ops:
                # a < b < c is a < b and b < c; b is evaluated twice, which has no effect as expressions have none.
                one = ast.copy_location(ast.Compare(left, [first], [right]), node)
                rest = ast.copy_location(ast.Compare(right, ops, others), node)
                return self.condition(ast.copy_location(ast.BoolOp(ast.And(), [one, rest]), node))
            case ast.BoolOp(op=op, values=[*values, last]):
                text = self.condition(last)
                for value in reversed(values):
                    yes, no = (text, "(i32.const 0)") if isinstance(op, ast.And) else ("(i32.const 1)", text)
                    text = f"(if (result i32) {self.condition(value)} (then {yes}) (else {no}))"
                return text
            case ast.UnaryOp(op=ast.Not(), operand=operand):
                return f"(i32.eqz {self.condition(operand)})"
        raise self.refuse(node)

    def _alike(self, left: ast.expr, right: ast.expr) -> tuple[tuple[str, str], str]:
        """Two values as one type, and this type: a float if one of them is."""
        a, b = self.value(left), self.value(right)
        kind = "f64" if "f64" in (a[1], b[1]) else "i32"
        return (self.convert(a, kind, left), self.convert(b, kind, right)), kind

    def value(self, node: ast.expr) -> Typed:
        """The text and the type of an expression."""
        scope = self.scope
        match node:
            case ast.Constant(value=int() | float() as number) if not isinstance(number, bool):
                return _constant(number)
            case ast.Name() | ast.Attribute() if (name := self.name(node)) in scope.types:
                return f"(local.get {self.local(name)})", scope.types[name]
            case ast.Name(id=name) if isinstance(scope.globals.get(name), int | float) and name not in scope.arrays:
                return _constant(scope.globals[name])
            case ast.Subscript(value=value, slice=index) if (name := self.name(value)) in scope.arrays:
                kind, load, _, shift = ARRAYS[scope.arrays[name]]
                return f"({load} {self.address(name, index, shift)})", kind
            case ast.Subscript(value=ast.Name(id=name), slice=index) if isinstance(scope.globals.get(name), tuple):
                table = scope.tables.address(scope.globals[name])
                if table is not None:
                    return f"(i32.load16_s offset={table} (i32.shl {self.integer(index)} (i32.const 1)))", "i32"
            case ast.UnaryOp(op=ast.USub(), operand=ast.Constant(value=int() | float() as number)):
                return _constant(-number)
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                text, kind = self.value(operand)
                return (f"(f64.neg {text})" if kind == "f64" else f"(i32.sub (i32.const 0) {text})"), kind
            case ast.BinOp(left=left, op=op, right=right):
                return self._operation(node, left, op, right)
            case ast.IfExp(test=test, body=body, orelse=orelse):
                (a, b), kind = self._alike(body, orelse)
                if kind == "i32" and _is_simple(body) and _is_simple(orelse):
                    return f"(select {a} {b} {self.condition(test)})", kind
                return f"(if (result {kind}) {self.condition(test)} (then {a}) (else {b}))", kind
            case ast.Call():
                text, kind = self.call(node)
                if kind:
                    return text, kind
        raise self.refuse(node)

    def _operation(self, node: ast.expr, left: ast.expr, op: ast.operator, right: ast.expr) -> Typed:
        (a, b), kind = self._alike(left, right)
        if type(op) in _ARITHMETIC:
            return f"({kind}.{_ARITHMETIC[type(op)]} {a} {b})", kind
        if isinstance(op, ast.Div) and kind == "f64":
            return f"(f64.div {a} {b})", kind
        if type(op) in _BITS and kind == "i32":
            return f"(i32.{_BITS[type(op)]} {a} {b})", kind
        raise self.refuse(node)

    def call(self, node: ast.Call) -> Typed:
        """The text of a call and the type of its result, empty if it has none."""
        match node.func, node.args:
            case ast.Name(id="min" | "max" as name), [left, right]:
                (a, b), kind = self._alike(left, right)
                if kind == "f64":
                    return f"(f64.{name} {a} {b})", kind
                # Python returns the first of equal values, too.
                return f"(select {b} {a} (i32.{'lt_s' if name == 'min' else 'gt_s'} {b} {a}))", kind
            case ast.Name(id="abs"), [value]:
                text, kind = self.value(value)
                if kind == "f64":
                    return f"(f64.abs {text})", kind
                return f"(select (i32.sub (i32.const 0) {text}) {text} (i32.lt_s {text} (i32.const 0)))", kind
            case ast.Name(id="len"), [ast.Name(id=name)] if name in self.scope.places:
                return _constant(self.scope.places[name].count)
            case ast.Name(id="float"), [value]:
                return self._float(value, node), "f64"
            case ast.Name(id="int"), [value]:
                return f"(i32.trunc_sat_f64_s {self._float(value, node)})", "i32"
            case ast.Name(id="round"), [value]:
                return f"(i32.trunc_sat_f64_s (f64.nearest {self._float(value, node)}))", "i32"
            case ast.Attribute(value=ast.Name(id="math"), attr="sqrt"), [value]:
                return f"(f64.sqrt {self._float(value, node)})", "f64"
            case ast.Attribute(value=ast.Name(id="math"), attr="floor"), [value]:
                return f"(i32.trunc_sat_f64_s (f64.floor {self._float(value, node)}))", "i32"
            case ast.Name(id=name), values if is_kernel(self.scope.globals.get(name)):
                return self._kernel_call(node, self.scope.globals[name], values)
            case ast.Name(id=name), values:
                instruction = instruction_of(self.scope.globals.get(name))
                if instruction is not None and len(values) == instruction.count("{}"):
                    return instruction.format(*map(self.integer, values)), "i32"
        raise self.refuse(node)

    def _float(self, value: ast.expr, node: ast.AST) -> str:
        return self.convert(self.value(value), "f64", node)

    def _kernel_call(self, node: ast.Call, called: Kernel, values: Sequence[ast.expr]) -> Typed:
        given, result = parameters(called)
        if len(given) != len(values):
            raise self.refuse(node)
        arguments = []
        for (name, kind), value in zip(given.items(), values, strict=True):
            if name not in self.scope.places:
                arguments.append(self._argument(value, kind))
            elif self.name(value) != name:  # an array at a fixed place has one name in all kernels
                raise self.refuse(value)
        return f"(call ${called.__name__} {' '.join(arguments)})", SCALARS[result]

    def _argument(self, node: ast.expr, kind: str | type[Record]) -> str:
        name = self.name(node)
        if not isinstance(kind, str):
            if self.scope.records.get(name) is kind:
                names = (f"{name}.{field}" for field in ("count", *fields(kind)))
                return " ".join(f"(local.get {self.local(field)})" for field in names)
        elif kind in SCALARS:
            return self.convert(self.value(node), SCALARS[kind], node)
        elif self.scope.arrays.get(name) == kind:
            return f"(local.get {self.local(name)})"
        raise self.refuse(node)

    def refuse(self, node: ast.AST) -> KernelError:
        """The error for what the language lacks; it names the line."""
        first = inspect.getsourcelines(self.scope.kernel)[1]
        line = first + getattr(node, "lineno", 1) - 1
        found = ast.unparse(node).splitlines()[0]
        return KernelError(f"{self.scope.kernel.__module__}, line {line}: kernels have no `{found}`")


def _is_simple(node: ast.expr) -> bool:
    """Whether an integer may be computed without need: it reads no array and neither calls nor divides."""
    allowed = ast.Name | ast.Constant | ast.BinOp | ast.UnaryOp | ast.operator | ast.unaryop | ast.expr_context
    match node:
        case ast.Call(func=ast.Name(id="min" | "max"), args=arguments):
            return all(map(_is_simple, arguments))
    return all(isinstance(part, allowed) for part in ast.walk(node))


def _constant(number: float) -> Typed:
    if isinstance(number, int):
        return f"(i32.const {number})", "i32"
    return f"(f64.const {number.hex() if abs(number) != float('inf') else number})", "f64"
