"""Translates kernels, functions in restricted Python, to WebAssembly text. Python runs the same functions as they are.

A kernel is a function of numbers, flat arrays and records of arrays. Every parameter has one of the types of
`kernel.types`, `int`, `float`, or is a `Record`; a local variable has the type of its first value. There are
assignments, `if`, `while`, `for … in range(…)`, `break`, `continue`, `return`; the operators of numbers, comparisons,
`and`, `or`, `not`, conditional expressions; `wrap_int`, `min`, `max`, `abs`, `int`, `float`, `round`, `math.sqrt`,
`math.floor`; numbers of the module, and kernels that it defines or imports. Floats are IEEE doubles and every operation
is rounded as Python rounds it, so that both give the same bits; integers have 32 bits. NaN and the sign of 0 are left
open.
"""

from __future__ import annotations

import ast
import inspect
import textwrap
from collections.abc import Iterable
from functools import cache
from typing import Any

from aseba_vm.kernel.record import Record, fields
from aseba_vm.kernel.types import Kernel, is_kernel, wrap_int
from thymio_sim_ros.errors import ThymioSimError

__all__ = ["KernelError", "Signature", "parameters", "translate"]

_ARRAYS = {"Floats": ("f64", "f64.load", "f64.store", 3), "Ints": ("i32", "i32.load", "i32.store", 2),
           "Words": ("i32", "i32.load16_u", "i32.store16", 1)}  # fmt: skip
"""Type of an element, instructions to read and write it, and the shift from its index to its offset."""
_SCALARS = {"int": "i32", "float": "f64", "None": ""}
_ARITHMETIC = {ast.Add: "add", ast.Sub: "sub", ast.Mult: "mul"}
_BITS = {ast.LShift: "shl", ast.RShift: "shr_s", ast.BitAnd: "and", ast.BitOr: "or", ast.BitXor: "xor"}
_COMPARISONS = {ast.Lt: "lt", ast.LtE: "le", ast.Gt: "gt", ast.GtE: "ge", ast.Eq: "eq", ast.NotEq: "ne"}

Signature = tuple[dict[str, "str | type[Record]"], str]
"""The type of each parameter, and that of the result."""
_Typed = tuple[str, str]
"""Text and type of an expression."""


class KernelError(ThymioSimError):
    """A kernel uses what the language of kernels does not have; the message names the line."""


def translate(kernels: Iterable[Kernel]) -> str:
    """The text of a module that exports the kernels by name and imports its memory as "" "memory".

    Raises:
        KernelError: A kernel uses something else than this language has.
    """
    exported = {kernel.__name__: kernel for kernel in kernels}
    functions: dict[str, Kernel] = {}
    pending = list(exported.values())
    while pending:
        kernel = pending.pop()
        if functions.setdefault(kernel.__name__, kernel) is not kernel:
            raise KernelError(f"two kernels have the name {kernel.__name__}")
        pending += [called for called in _called(kernel) if functions.get(called.__name__) is not called]
    text = "\n".join(_Function(kernel, is_exported=name in exported).text for name, kernel in functions.items())
    return f'(module (import "" "memory" (memory 1))\n{text})'


@cache
def parameters(kernel: Kernel) -> Signature:
    """The parameters of a kernel and its result. Raises KernelError for types that kernels do not have."""
    found: dict[str, str | type[Record]] = {}
    annotations = dict(kernel.__annotations__)
    result = str(annotations.pop("return", "missing"))
    for name, kind in annotations.items():
        known = getattr(kernel, "__globals__", {}).get(kind)
        if isinstance(known, type) and issubclass(known, Record):
            found[name] = known
        elif kind in _ARRAYS or kind in ("int", "float"):
            found[name] = str(kind)
        else:
            raise KernelError(f"{kernel.__name__}: parameter {name} is {kind}, expected int, float, array or record")
    if result not in _SCALARS:
        raise KernelError(f"{kernel.__name__}: result is {result}, expected int, float or None")
    return found, result


def _called(kernel: Kernel) -> list[Kernel]:
    """The kernels that a kernel may call."""
    names = {
        node.func.id
        for node in ast.walk(_tree(kernel))
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name)
    }
    found = (getattr(kernel, "__globals__", {}).get(name) for name in sorted(names))
    return [candidate for candidate in found if candidate is not None and is_kernel(candidate)]


@cache
def _tree(kernel: Kernel) -> ast.FunctionDef:
    tree = ast.parse(textwrap.dedent(inspect.getsource(kernel))).body[0]
    assert isinstance(tree, ast.FunctionDef)
    return tree


class _Function:
    """Translates one kernel."""

    def __init__(self, kernel: Kernel, *, is_exported: bool) -> None:
        self._kernel = kernel
        self._globals: dict[str, Any] = getattr(kernel, "__globals__", {})
        self._arrays: dict[str, str] = {}
        """The arrays in sight by name, those of a record as `record.field`, and their types."""
        self._types: dict[str, str] = {}
        """The types of scalar parameters and local variables."""
        self._records: dict[str, type[Record]] = {}
        self._loops = 0
        self._open: list[int] = []
        given, result = parameters(kernel)
        head = []
        for name, kind in given.items():
            if isinstance(kind, str):
                head.append(self._parameter(name, kind))
                continue
            self._records[name] = kind
            head.append(self._parameter(f"{name}.count", "int"))
            head += [self._parameter(f"{name}.{field}", array) for field, array in fields(kind).items()]
        self._result = _SCALARS[result]
        own = set(self._types)
        body = self._block(_tree(kernel).body)
        local = "".join(f"(local ${name} {kind})" for name, kind in self._types.items() if name not in own)
        # A function with a result must end with a value, even if all paths return before.
        if self._result:
            head.append(f"(result {self._result})")
            body += f"\n({self._result}.const 0)"
        name = kernel.__name__
        export = f'(export "{name}") ' if is_exported else ""
        self.text = f"(func ${name} {export}{' '.join(head)} {local}\n{body})"

    def _parameter(self, name: str, kind: str) -> str:
        """Declare a parameter; returns its text."""
        if kind in _ARRAYS:
            self._arrays[name] = kind
            return f"(param ${name} i32)"
        self._types[name] = _SCALARS[kind]
        return f"(param ${name} {_SCALARS[kind]})"

    def _name(self, node: ast.expr) -> str:
        """The name of a variable, or of a field of a record as `record.field`; empty for anything else."""
        match node:
            case ast.Name(id=name):
                return name
            case ast.Attribute(value=ast.Name(id=record), attr=field) if record in self._records:
                return f"{record}.{field}"
        return ""

    def _block(self, body: Iterable[ast.stmt]) -> str:
        return "\n".join(self._statement(statement) for statement in body)

    def _statement(self, node: ast.stmt) -> str:
        match node:
            case ast.Assign(targets=[target], value=value) | ast.AnnAssign(target=target, value=ast.expr() as value):
                return self._store(target, self._value(value))
            case ast.AugAssign(target=target, op=op, value=value):
                left = ast.copy_location(ast.BinOp(_loaded(target), op, value), node)
                return self._store(target, self._value(left))
            case ast.If(test=test, body=body, orelse=orelse):
                otherwise = f"(else {self._block(orelse)})" if orelse else ""
                return f"(if {self._condition(test)} (then {self._block(body)}) {otherwise})"
            case ast.While(test=test, body=body, orelse=[]):
                return self._loop(f"(i32.eqz {self._condition(test)})", "", body, "")
            case ast.For(target=ast.Name(id=name), iter=ast.Call(func=ast.Name(id="range"), args=limits), orelse=[]):
                return self._for(name, limits, node.body)
            case ast.Break() | ast.Continue():
                kind = "out" if isinstance(node, ast.Break) else "next"
                return f"(br ${kind}{self._open[-1]})"
            case ast.Return(value=None):
                return "(return)"
            case ast.Return(value=ast.expr() as value):
                return f"(return {self._as(self._value(value), self._result, node)})"
            case ast.Expr(value=ast.Constant(value=str())):
                return ""
            case ast.Expr(value=ast.Call() as call):
                text, kind = self._call(call)
                return f"(drop {text})" if kind else text
        raise self._refuse(node)

    def _for(self, name: str, limits: list[ast.expr], body: list[ast.stmt]) -> str:
        first, last = (ast.Constant(0), limits[0]) if len(limits) == 1 else limits
        # As in Python: the limits are evaluated once, and an assignment to the variable does not change the iteration,
        # so count and end are locals of their own.
        number = self._loops
        count, end = f"_count{number}", f"_end{number}"
        for own in (count, end, name):
            self._types[own] = "i32"
        begin = f"(local.set ${count} {self._integer(first)})(local.set ${end} {self._integer(last)})"
        loop = self._loop(
            f"(i32.ge_s (local.get ${count}) (local.get ${end}))",
            f"(local.set ${name} (local.get ${count}))",
            body,
            f"(local.set ${count} (i32.add (local.get ${count}) (i32.const 1)))",
        )
        return begin + loop

    def _loop(self, is_over: str, before: str, body: list[ast.stmt], after: str) -> str:
        # A branch to a block continues after it, a branch to a loop repeats it. `break` branches to $out, `continue` to
        # $next, whose end is followed by the step of the loop (`after`).
        number = self._loops
        self._loops += 1
        self._open.append(number)
        inside = self._block(body)
        self._open.pop()
        return (
            f"(block $out{number} (loop $top{number} (br_if $out{number} {is_over}) {before}\n"
            f"(block $next{number} {inside})\n{after} (br $top{number})))"
        )

    def _store(self, target: ast.expr, value: _Typed) -> str:
        match target:
            case ast.Name(id=name) if name not in self._arrays and name not in self._records:
                kind = self._types.setdefault(name, value[1])
                return f"(local.set ${name} {self._as(value, kind, target)})"
            case ast.Subscript(value=value_of, slice=index) if (name := self._name(value_of)) in self._arrays:
                kind, _, store, shift = _ARRAYS[self._arrays[name]]
                return f"({store} {self._address(name, index, shift)} {self._as(value, kind, target)})"
        raise self._refuse(target)

    def _address(self, array: str, index: ast.expr, shift: int) -> str:
        place = f"(i32.shl {self._integer(index)} (i32.const {shift}))"
        return f"(i32.add (local.get ${array}) {place})"

    def _integer(self, node: ast.expr) -> str:
        text, kind = self._value(node)
        if kind != "i32":
            raise self._refuse(node)
        return text

    def _as(self, value: _Typed, kind: str, node: ast.AST) -> str:
        """A value as a type; an integer may become a float, as in Python."""
        text, found = value
        if found == kind:
            return text
        if (found, kind) == ("i32", "f64"):
            return f"(f64.convert_i32_s {text})"
        raise self._refuse(node)

    def _condition(self, node: ast.expr) -> str:
        match node:
            case ast.Compare(left=left, ops=[op], comparators=[right]) if type(op) in _COMPARISONS:
                (a, b), kind = self._alike(left, right)
                sign = "_s" if kind == "i32" and not isinstance(op, ast.Eq | ast.NotEq) else ""
                return f"({kind}.{_COMPARISONS[type(op)]}{sign} {a} {b})"
            case ast.Compare(left=left, ops=[first, *ops], comparators=[right, *others]) if ops:
                # a < b < c is a < b and b < c; b is evaluated twice, which has no effect as expressions have none.
                one = ast.copy_location(ast.Compare(left, [first], [right]), node)
                rest = ast.copy_location(ast.Compare(right, ops, others), node)
                return self._condition(ast.copy_location(ast.BoolOp(ast.And(), [one, rest]), node))
            case ast.BoolOp(op=op, values=[*values, last]):
                text = self._condition(last)
                for value in reversed(values):
                    yes, no = (text, "(i32.const 0)") if isinstance(op, ast.And) else ("(i32.const 1)", text)
                    text = f"(if (result i32) {self._condition(value)} (then {yes}) (else {no}))"
                return text
            case ast.UnaryOp(op=ast.Not(), operand=operand):
                return f"(i32.eqz {self._condition(operand)})"
        raise self._refuse(node)

    def _alike(self, left: ast.expr, right: ast.expr) -> tuple[tuple[str, str], str]:
        """Return two values as one type, and this type: a float if one of them is."""
        a, b = self._value(left), self._value(right)
        kind = "f64" if "f64" in (a[1], b[1]) else "i32"
        return (self._as(a, kind, left), self._as(b, kind, right)), kind

    def _value(self, node: ast.expr) -> _Typed:
        match node:
            case ast.Constant(value=int() | float() as number) if not isinstance(number, bool):
                return _constant(number)
            case ast.Name() | ast.Attribute() if (name := self._name(node)) in self._types:
                return f"(local.get ${name})", self._types[name]
            case ast.Name(id=name) if isinstance(self._globals.get(name), int | float) and name not in self._arrays:
                return _constant(self._globals[name])
            case ast.Subscript(value=value, slice=index) if (name := self._name(value)) in self._arrays:
                kind, load, _, shift = _ARRAYS[self._arrays[name]]
                return f"({load} {self._address(name, index, shift)})", kind
            case ast.UnaryOp(op=ast.USub(), operand=ast.Constant(value=int() | float() as number)):
                return _constant(-number)
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                text, kind = self._value(operand)
                return (f"(f64.neg {text})" if kind == "f64" else f"(i32.sub (i32.const 0) {text})"), kind
            case ast.BinOp(left=left, op=op, right=right):
                return self._operation(node, left, op, right)
            case ast.IfExp(test=test, body=body, orelse=orelse):
                (a, b), kind = self._alike(body, orelse)
                return f"(if (result {kind}) {self._condition(test)} (then {a}) (else {b}))", kind
            case ast.Call():
                text, kind = self._call(node)
                if kind:
                    return text, kind
        raise self._refuse(node)

    def _operation(self, node: ast.expr, left: ast.expr, op: ast.operator, right: ast.expr) -> _Typed:
        (a, b), kind = self._alike(left, right)
        if type(op) in _ARITHMETIC:
            return f"({kind}.{_ARITHMETIC[type(op)]} {a} {b})", kind
        if isinstance(op, ast.Div) and kind == "f64":
            return f"(f64.div {a} {b})", kind
        if type(op) in _BITS and kind == "i32":
            return f"(i32.{_BITS[type(op)]} {a} {b})", kind
        raise self._refuse(node)

    def _call(self, node: ast.Call) -> _Typed:
        match node.func, node.args:
            case ast.Name(id="min" | "max" as name), [left, right]:
                (a, b), kind = self._alike(left, right)
                if kind == "f64":  # WebAssembly has no minimum of integers
                    return f"(f64.{name} {a} {b})", kind
            case ast.Name(id=name), [value] if self._globals.get(name) is wrap_int:
                return self._integer(value), "i32"
            case ast.Name(id="abs"), [value]:
                return f"(f64.abs {self._as(self._value(value), 'f64', node)})", "f64"
            case ast.Name(id="float"), [value]:
                return self._as(self._value(value), "f64", node), "f64"
            case ast.Name(id="int"), [value]:
                return f"(i32.trunc_sat_f64_s {self._as(self._value(value), 'f64', node)})", "i32"
            case ast.Name(id="round"), [value]:
                return f"(i32.trunc_sat_f64_s (f64.nearest {self._as(self._value(value), 'f64', node)}))", "i32"
            case ast.Attribute(value=ast.Name(id="math"), attr="sqrt"), [value]:
                return f"(f64.sqrt {self._as(self._value(value), 'f64', node)})", "f64"
            case ast.Attribute(value=ast.Name(id="math"), attr="floor"), [value]:
                return f"(i32.trunc_sat_f64_s (f64.floor {self._as(self._value(value), 'f64', node)}))", "i32"
            case ast.Name(id=name), values if is_kernel(self._globals.get(name)):
                given, result = parameters(self._globals[name])
                if len(given) == len(values):
                    arguments = " ".join(map(self._argument, values, given.values()))
                    return f"(call ${self._globals[name].__name__} {arguments})", _SCALARS[result]
        raise self._refuse(node)

    def _argument(self, node: ast.expr, kind: str | type[Record]) -> str:
        name = self._name(node)
        if not isinstance(kind, str):
            if self._records.get(name) is kind:
                names = (f"{name}.{field}" for field in ("count", *fields(kind)))
                return " ".join(f"(local.get ${field})" for field in names)
        elif kind in _SCALARS:
            return self._as(self._value(node), _SCALARS[kind], node)
        elif self._arrays.get(name) == kind:
            return f"(local.get ${name})"
        raise self._refuse(node)

    def _refuse(self, node: ast.AST) -> KernelError:
        first = inspect.getsourcelines(self._kernel)[1]
        line = first + getattr(node, "lineno", 1) - 1
        found = ast.unparse(node).splitlines()[0]
        return KernelError(f"{self._kernel.__module__}, line {line}: kernels have no `{found}`")


def _constant(number: float) -> _Typed:
    if isinstance(number, int):
        return f"(i32.const {number})", "i32"
    return f"(f64.const {number.hex() if abs(number) != float('inf') else number})", "f64"


def _loaded(target: ast.expr) -> ast.expr:
    """Return the target of an assignment as an expression that reads it."""
    if isinstance(target, ast.Subscript):
        return ast.copy_location(ast.Subscript(target.value, target.slice, ast.Load()), target)
    return ast.copy_location(ast.Name(getattr(target, "id", ""), ast.Load()), target)
