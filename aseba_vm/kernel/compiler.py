"""Translates kernels, functions in restricted Python, to WebAssembly text. Python runs the same functions as they are.

A kernel is a function of numbers, flat arrays and records of arrays. Every parameter has one of the types of
`kernel.types`, `int`, `float`, or is a `Record`; a local variable has the type of its first value. There are
assignments, `if`, `while`, `for … in range(…)`, `break`, `continue`, `return`; the operators of numbers, comparisons,
`and`, `or`, `not`, conditional expressions; `min`, `max`, `abs`, `int`, `float`, `round`, `math.sqrt`, `math.floor`,
the functions of `kernel.integers`; numbers of the module, tuples of 16-bit integers where there is room for tables, and
kernels that the module defines or imports. Floats are IEEE doubles and every operation is rounded as Python rounds it,
so that both give the same bits; integers have 32 bits, and where a kernel may exceed them it uses `wrap32`. NaN and the
sign of 0 are left open.
"""

from __future__ import annotations

import ast
import inspect
import textwrap
from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from typing import NamedTuple

from aseba_vm.kernel.expressions import Expressions, Place, Scope, Tables, Typed
from aseba_vm.kernel.record import fields
from aseba_vm.kernel.signatures import ARRAYS, SCALARS, KernelError, Signature, parameters
from aseba_vm.kernel.specialization import specialize
from aseba_vm.kernel.types import Kernel, is_kernel

__all__ = ["KernelCall", "KernelError", "KernelModule", "Place", "Signature", "parameters", "translate"]


def translate(kernels: Iterable[Kernel]) -> str:
    """The text of a module that exports the kernels by name and imports its memory as "" "memory".

    Raises:
        KernelError: A kernel uses something else than this language has.
    """
    module = KernelModule()
    for kernel in kernels:
        module.use(kernel, is_exported=True)
    return f'(module (import "" "memory" (memory 1))\n{module.text()})'


class KernelCall(NamedTuple):
    """The text of a call, the local variables that it needs, and its result if that is the same in every case."""

    text: str
    locals: Mapping[str, str]
    result: int | None = None


class KernelModule:
    """The kernels that a module uses, with those that they call.

    `places` are arrays at fixed places: parameters of these names are not handed over. `tables` is the address
    from which on the tuples that kernels read are stored.
    """

    def __init__(self, places: Mapping[str, Place] | None = None, tables: int | None = None) -> None:
        self._places = places or {}
        self._tables = Tables(tables)
        self._kernels: dict[str, Kernel] = {}
        self._exported: set[str] = set()
        self._inlined = 0

    def use(self, kernel: Kernel, *, is_exported: bool = False) -> None:
        """Add a kernel, unless it is there. Raises KernelError if another one has its name."""
        pending = [kernel]
        while pending:
            found = pending.pop()
            if self._kernels.setdefault(found.__name__, found) is not found:
                raise KernelError(f"two kernels have the name {found.__name__}")
            pending += [called for called in _called(found) if self._kernels.get(called.__name__) is not called]
        if is_exported:
            self._exported.add(kernel.__name__)

    def call(self, kernel: Kernel, arguments: Sequence[int]) -> KernelCall:
        """Translate a call with these numbers.

        The kernel becomes a part of the caller, unless it has loops that end on a condition. Raises KernelError.
        """
        given, result = parameters(kernel)
        names = [name for name in given if name not in self._places]
        body = specialize(_tree(kernel), dict(zip(names, arguments, strict=True)))
        if body is None:
            self.use(kernel)
            numbers = " ".join(f"(i32.const {number})" for number in arguments)
            return KernelCall(f"(call ${kernel.__name__} {numbers})", {})
        for called in _called(kernel):
            self.use(called)
        self._inlined += 1
        label = f"$inlined{self._inlined}"
        function = _Function(Scope(kernel, self._tables, self._places, f"{label[1:]}."), f"br {label}")
        text = function.body(body)
        types = {function.expressions.local(name): kind for name, kind in function.local_types.items()}
        return KernelCall(f"(block {label} {_result(result)} {text})", types, _constant_result(kernel, body))

    def text(self) -> str:
        """The functions and tables. Raises KernelError for what the language of kernels lacks."""
        functions = [
            _Function(Scope(kernel, self._tables, self._places), "return").text(is_exported=name in self._exported)
            for name, kernel in self._kernels.items()
        ]
        return "\n".join([*functions, self._tables.text])


def _constant_result(kernel: Kernel, body: Sequence[ast.stmt]) -> int | None:
    """The result of a kernel if every `return` names the same number of its module."""
    returns = [node.value for statement in body for node in ast.walk(statement) if isinstance(node, ast.Return)]
    names = {node.id if isinstance(node, ast.Name) else None for node in returns}
    found = getattr(kernel, "__globals__", {}).get(names.pop()) if len(names) == 1 else None
    return found if isinstance(found, int) else None


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


def _result(kind: str) -> str:
    return f"(result {SCALARS[kind]})" if SCALARS[kind] else ""


class _Function:
    """Translates one kernel; `leave` is the instruction of its `return`."""

    def __init__(self, scope: Scope, leave: str) -> None:
        self.scope = scope
        self.expressions = Expressions(scope)
        self._leave = leave
        self._loops = 0
        self._open: list[int] = []
        given, result = parameters(scope.kernel)
        head = []
        for name, kind in given.items():
            if isinstance(kind, str):
                head.append(self._parameter(name, kind))
                continue
            scope.records[name] = kind
            head.append(self._parameter(f"{name}.count", "int"))
            head += [self._parameter(f"{name}.{field}", array) for field, array in fields(kind).items()]
        self._head = [*head, _result(result)]
        self._result = SCALARS[result]
        self._given = set(scope.types)

    @property
    def local_types(self) -> dict[str, str]:
        """The local variables and their types."""
        return {name: kind for name, kind in self.scope.types.items() if name not in self._given}

    def text(self, *, is_exported: bool) -> str:
        """The text of the function."""
        body = self.body(_tree(self.scope.kernel).body)
        local = "".join(f"(local ${name} {kind})" for name, kind in self.local_types.items())
        name = self.scope.kernel.__name__
        export = f'(export "{name}") ' if is_exported else ""
        return f"(func ${name} {export}{' '.join(self._head)} {local}\n{body})"

    def body(self, body: Iterable[ast.stmt]) -> str:
        """The text of the statements."""
        text = self._block(body)
        # A function with a result must end with a value, even if all paths return before.
        return f"{text}\n({self._result}.const 0)" if self._result else text

    def _parameter(self, name: str, kind: str) -> str:
        """Declare a parameter and return its text."""
        if kind in ARRAYS:
            self.scope.arrays[name] = kind
            return "" if name in self.scope.places else f"(param ${name} i32)"
        self.scope.types[name] = SCALARS[kind]
        return f"(param ${name} {SCALARS[kind]})"

    def _block(self, body: Iterable[ast.stmt]) -> str:
        return "\n".join(self._statement(statement) for statement in body)

    def _statement(self, node: ast.stmt) -> str:
        write = self.expressions
        match node:
            case ast.Assign(targets=[target], value=value) | ast.AnnAssign(target=target, value=ast.expr() as value):
                return self._store(target, write.value(value))
            case ast.AugAssign(target=target, op=op, value=value):
                left = ast.copy_location(ast.BinOp(_loaded(target), op, value), node)
                return self._store(target, write.value(left))
            case ast.If(test=test, body=body, orelse=orelse):
                otherwise = f"(else {self._block(orelse)})" if orelse else ""
                return f"(if {write.condition(test)} (then {self._block(body)}) {otherwise})"
            case ast.While(test=test, body=body, orelse=[]):
                return self._loop(f"(i32.eqz {write.condition(test)})", "", body, "")
            case ast.For(target=ast.Name(id=name), iter=ast.Call(func=ast.Name(id="range"), args=limits), orelse=[]):
                return self._for(name, limits, node.body)
            case ast.Break() | ast.Continue():
                kind = "out" if isinstance(node, ast.Break) else "next"
                return f"(br ${kind}{self._open[-1]})"
            case ast.Return(value=None):
                return f"({self._leave})"
            case ast.Return(value=ast.expr() as value):
                return f"({self._leave} {write.convert(write.value(value), self._result, node)})"
            case ast.Expr(value=ast.Constant(value=str())):
                return ""
            case ast.Expr(value=ast.Call() as call):
                text, kind = write.call(call)
                return f"(drop {text})" if kind else text
        raise write.refuse(node)

    def _for(self, name: str, limits: list[ast.expr], body: list[ast.stmt]) -> str:
        first, last = (ast.Constant(0), limits[0]) if len(limits) == 1 else limits
        # As in Python: the limits are evaluated once, and an assignment to the variable does not change the iteration,
        # so count and end are locals of their own.
        number = self._loops
        names = f"_count{number}", f"_end{number}", name
        self.scope.types.update(dict.fromkeys(names, "i32"))
        count, end, variable = map(self.expressions.local, names)
        integer = self.expressions.integer
        begin = f"(local.set {count} {integer(first)})(local.set {end} {integer(last)})"
        loop = self._loop(
            f"(i32.ge_s (local.get {count}) (local.get {end}))",
            f"(local.set {variable} (local.get {count}))",
            body,
            f"(local.set {count} (i32.add (local.get {count}) (i32.const 1)))",
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

    def _store(self, target: ast.expr, value: Typed) -> str:
        scope, write = self.scope, self.expressions
        match target:
            case ast.Name(id=name) if name not in scope.arrays and name not in scope.records:
                kind = scope.types.setdefault(name, value[1])
                return f"(local.set {write.local(name)} {write.convert(value, kind, target)})"
            case ast.Subscript(value=value_of, slice=index) if (name := write.name(value_of)) in scope.arrays:
                kind, _, store, shift = ARRAYS[scope.arrays[name]]
                text = write.convert(value, kind, target)
                if store == "i32.store16":  # it wraps
                    text = _unwrapped(text)
                return f"({store} {write.address(name, index, shift)} {text})"
        raise write.refuse(target)


def _unwrapped(text: str) -> str:
    """The text of a value without a last wrap to 16 bits."""
    wrap = "(i32.extend16_s "
    return text[len(wrap) : -1] if text.startswith(wrap) else text


def _loaded(target: ast.expr) -> ast.expr:
    """The target of an assignment as an expression that reads it."""
    if isinstance(target, ast.Subscript):
        return ast.copy_location(ast.Subscript(target.value, target.slice, ast.Load()), target)
    return ast.copy_location(ast.Name(getattr(target, "id", ""), ast.Load()), target)
