"""Translation to WebAssembly with the optional ``wasmtime`` (extra ``[fast]``): one module for an event.

The words that the code touches are copied into the module's memory before a run and back afterwards; a subroutine
is a function that returns the budget left, or -1 if the code was left inside. Leaving writes address, kind and the
words of the stack into memory. Structure and rules are those of :mod:`aseba_vm.engine_python`.
"""

from __future__ import annotations

import atexit
import ctypes
import importlib
import weakref
from array import array
from collections.abc import Callable, Sequence
from typing import Any

from aseba_vm.blocks import Assign, AssignIndex, Blocks, Branch, Call, Emit, Known, Place, Statement, arguments
from aseba_vm.engine_python import Function, Survey, runs
from aseba_vm.structure import INTERPRET, Back, Check, Cost, Exit, If, Loop, Node, Routine, Structure, Visit
from aseba_vm.wasm_expressions import WasmExpressions
from aseba_vm.wasm_natives import inline

# Where things are, in bytes: words of variables from 0 on, then memories of branches, then what was left.
_BRANCHES = 0x20000
_EXIT = 0x40000
_STACK = 0x40010
_ARGUMENTS = 0x60000
_PAGES = 7

_MERGED_GAP = 16


def is_available() -> bool:
    """Tell whether ``wasmtime`` can be imported."""
    try:
        importlib.import_module("wasmtime")
    except (ImportError, OSError):
        return False
    return True


class _Runtime:
    """The compiler, one for the process."""

    instance: _Runtime | None = None

    def __init__(self) -> None:
        self.wasmtime: Any = importlib.import_module("wasmtime")
        self.engine = self.wasmtime.Engine()
        self._made: weakref.WeakSet[Any] = weakref.WeakSet()
        atexit.register(self._close)

    def keep(self, made: Any) -> Any:
        """Return a module or store; it is closed before the interpreter takes wasmtime itself apart."""
        self._made.add(made)
        return made

    def _close(self) -> None:
        for made in [*self._made, self.engine]:
            made.close()

    @classmethod
    def get(cls) -> _Runtime:
        """Return the compiler, started when first asked for."""
        if cls.instance is None:
            cls.instance = cls()
        return cls.instance


def translate(blocks: Blocks, structure: Structure, natives: Sequence[Known]) -> Callable[[], Function]:
    """Return what makes the function of a structure for one machine."""
    survey = Survey(natives)
    survey.visit(structure.main.nodes)
    for sub in structure.subs.values():
        survey.visit(sub.nodes)
    order = {pc: place for place, pc in enumerate(blocks.branches)}
    runtime = _Runtime.get()
    module = runtime.keep(runtime.wasmtime.Module(runtime.engine, _Writer(structure, order, natives).text()))
    words = _merged(runs(survey.scalars | survey.shared))
    memories = _merged(runs(order[pc] for pc in survey.branches))
    return lambda: _Instance(runtime, module, words, memories).run


def _merged(parts: list[tuple[int, int]]) -> list[tuple[int, int]]:
    """Join runs of places with small gaps; return begin and end of each."""
    merged: list[tuple[int, int]] = []
    for first, last in parts:
        if merged and first - merged[-1][1] <= _MERGED_GAP:
            merged[-1] = (merged[-1][0], last + 1)
        else:
            merged.append((first, last + 1))
    return merged


class _Instance:
    """A module with its memory."""

    def __init__(
        self, runtime: _Runtime, module: Any, words: list[tuple[int, int]], memories: list[tuple[int, int]]
    ) -> None:
        wasmtime = runtime.wasmtime
        self._words = words
        self._memories = [(begin, end, begin + _BRANCHES // 2) for begin, end in memories]
        self._failure: BaseException | None = None
        i32 = wasmtime.ValType.i32()
        kind = wasmtime.FuncType([i32, i32, i32], [i32])
        store = runtime.keep(wasmtime.Store(runtime.engine))
        imports = [wasmtime.Func(store, kind, self._native), wasmtime.Func(store, kind, self._emit)]
        exports = wasmtime.Instance(store, module, imports).exports(store)
        memory = exports["memory"]
        address = ctypes.addressof(memory.data_ptr(store).contents)
        self._buffer = (ctypes.c_ubyte * (_PAGES * 0x10000)).from_address(address)
        self._view = memoryview(self._buffer).cast("B").cast("h")
        self._wide = memoryview(self._buffer).cast("B").cast("i")
        self._store = store
        self._run = caller(wasmtime, store, exports["run"])
        self._variables: list[int] = []
        self._host: tuple[Any, Any] = (None, None)

    def run(self, variables: list[int], memory: list[int], budget: int, native: Any, emit: Any) -> Any:
        """Run; see :data:`aseba_vm.engine_python.Function`."""
        view, wide = self._view, self._wide
        self._variables = variables
        self._host = (native, emit)
        for begin, end in self._words:
            view[begin:end] = array("h", variables[begin:end])
        for begin, end, place in self._memories:
            view[place : place + end - begin] = array("h", memory[begin:end])
        left = self._run(budget)
        for begin, end in self._words:
            variables[begin:end] = view[begin:end].tolist()
        for begin, end, place in self._memories:
            memory[begin:end] = view[place : place + end - begin].tolist()
        if self._failure is not None:
            failure, self._failure = self._failure, None
            raise failure
        place = _EXIT // 4
        count = wide[place + 3]
        words = tuple(wide[_STACK // 4 : _STACK // 4 + count]) if count else ()
        return left, wide[place], wide[place + 1], words

    def _native(self, number: int, pc: int, count: int) -> int:
        variables, view = self._variables, self._view
        try:
            for begin, end in self._words:
                variables[begin:end] = view[begin:end].tolist()
            result: int = self._host[0](number, pc, tuple(self._wide[_ARGUMENTS // 4 : _ARGUMENTS // 4 + count]))
            for begin, end in self._words:
                view[begin:end] = array("h", variables[begin:end])
        except BaseException as failure:  # raised again by run: nothing may pass through translated code
            self._failure = failure
            return 1
        return result

    def _emit(self, number: int, address: int, count: int) -> int:
        self._host[1](number, tuple(self._view[address : address + count]))
        return 0


def caller(wasmtime: Any, store: Any, function: Any) -> Callable[[int], int]:
    """Return a quick way to call a function of one i64: unchecked if this version of wasmtime has it."""
    try:
        bindings = wasmtime._bindings
        raw = bindings.dll.wasmtime_func_call_unchecked
        values = (bindings.wasmtime_val_raw_t * 1)()
        trap = ctypes.POINTER(bindings.wasm_trap_t)()
        raw.restype = ctypes.c_void_p
        raw.argtypes = [ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_size_t, ctypes.c_void_p]
        context = ctypes.cast(store._context(), ctypes.c_void_p)
        place, target, failed = ctypes.addressof(values), ctypes.addressof(function._func), ctypes.addressof(trap)
    except AttributeError:
        return lambda budget: int(function(store, budget))
    number = values[0]
    kept = (store, function, values, trap)

    def call(budget: int) -> int:
        number.i64 = budget
        if raw(context, target, place, 1, failed):
            raise RuntimeError(f"translated code failed: {kept[3]}")
        result: int = number.i64
        return result

    return call


class _Writer:
    """Writes the text of a module."""

    def __init__(self, structure: Structure, order: dict[int, int], natives: Sequence[Known]) -> None:
        self.structure = structure
        self.order = order
        self.natives = natives
        self.lines: list[str] = []
        self.is_sub = False
        self.temps: set[int] = set()
        self.expressions = WasmExpressions(self.lines_say)

    def lines_say(self, line: str) -> None:
        """Append a line."""
        self.lines.append(line)

    def text(self) -> str:
        """Return the module: ``run`` takes the budget and returns what is left of it."""
        subs = [self._routine(sub, f"$f{sub.pc}") for sub in self.structure.subs.values()]
        main = self._routine(self.structure.main, '$run (export "run")')
        host = "(param i32 i32 i32) (result i32)"
        return "\n".join(
            [
                "(module",
                f'(import "" "native" (func $native {host})) (import "" "emit" (func $emit {host}))',
                f'(memory (export "memory") {_PAGES})',
                *subs,
                main,
                ")",
            ]
        )

    def _routine(self, routine: Routine, name: str) -> str:
        self.lines.clear()
        self.temps.clear()
        self.expressions.temporaries = 0
        self.is_sub = routine.is_sub
        self._nodes(routine.nodes, 0)
        parameters = "(param $n i64) (param $d i32)" if routine.is_sub else "(param $n i64)"
        names = [f"$t{number + 1}" for number in range(self.expressions.temporaries)]
        names += [f"$s{number}" for number in sorted(self.temps)]
        local = "".join(f"(local {name} i32)" for name in (*names, "$h"))
        body = "\n".join(self.lines)
        return f"(func {name} {parameters} (result i64) {local}\n{body}\n(unreachable))"

    # -- leaving

    def _leaving(self, place: Place, kind: int, uncharged: int) -> str:
        """Return the code that notes where the code is left and returns."""
        depth = "(local.get $d)" if self.is_sub else "(i32.const 0)"
        stores = [f"(i32.store (i32.const {_EXIT}) (i32.const {place.pc}))"]
        stores.append(f"(i32.store (i32.const {_EXIT + 4}) (i32.const {kind}))")
        for number, atom in enumerate(place.pending):
            at = f"(i32.shl {depth} (i32.const 2))"
            stores.append(f"(i32.store offset={_STACK + 4 * number} {at} {self.expressions.word(atom)})")
        count = f"(i32.add {depth} (i32.const {len(place.pending)}))" if place.pending else depth
        stores.append(f"(i32.store (i32.const {_EXIT + 12}) {count})")
        left = f"(i64.sub (local.get $n) (i64.const {uncharged}))"
        if not self.is_sub:
            return f"{' '.join(stores)} (return {left})"
        return f"{' '.join(stores)} (i64.store (i32.const {_EXIT - 8}) {left}) (return (i64.const -1))"

    def _charge(self, count: int) -> None:
        if count:
            self.lines.append(f"(local.set $n (i64.sub (local.get $n) (i64.const {count})))")

    def _unless(self, need: int, leaving: str) -> None:
        self.lines.append(f"(if (i64.lt_s (local.get $n) (i64.const {need})) (then {leaving}))")

    # -- nodes

    def _nodes(self, nodes: Sequence[Node], uncharged: int) -> int | None:
        """Write nodes; return the instructions not charged at their end, None if it is not reached."""
        for node in nodes:
            match node:
                case Cost(cost):
                    uncharged += cost
                case Exit(place, kind, cost):
                    self.lines.append(self._leaving(place, kind, uncharged + cost))
                    return None
                case Back(cost):
                    self._charge(uncharged + cost)
                    self.lines.append("(return (local.get $n))")
                    return None
                case Check(pc, need):
                    self._unless(need + uncharged, self._leaving(Place(pc, ()), INTERPRET, uncharged))
                case If():
                    ended = self._if(node, uncharged)
                    if ended is None:
                        return None
                    uncharged = ended
                case Loop():
                    uncharged = self._loop(node, uncharged)
                case Visit(end):
                    self._visit(end.target, end.back, uncharged + 1)
                    uncharged = 0
                case _:
                    self._statement(node, uncharged)
                    uncharged += node.cost
        return uncharged

    def _visit(self, target: int, back: int, uncharged: int) -> None:
        self._charge(uncharged)
        depth = "(local.get $d)" if self.is_sub else "(i32.const 0)"
        say = self.lines.append
        say(f"(i32.store offset={_STACK} (i32.shl {depth} (i32.const 2)) (i32.const {back}))")
        say(f"(local.set $n (call $f{target} (local.get $n) (i32.add {depth} (i32.const 1))))")
        left = "(i64.const -1)" if self.is_sub else f"(i64.load (i32.const {_EXIT - 8}))"
        say(f"(if (i64.lt_s (local.get $n) (i64.const 0)) (then (return {left})))")

    def _if(self, node: If, uncharged: int) -> int | None:
        """Write a condition; see :class:`aseba_vm.engine_python`."""
        branch = node.branch
        self.expressions.refuse = self._leaving(branch.place, INTERPRET, uncharged)
        test = self.expressions.condition(branch.operator, branch.left, branch.right)
        start = uncharged + branch.cost
        outer, self.lines[:] = list(self.lines), []
        then = self._nodes(node.then, start)
        then_lines, self.lines[:] = list(self.lines), []
        otherwise = self._nodes(node.otherwise, start)
        other_lines, self.lines[:] = list(self.lines), outer
        joined = then if otherwise is None else otherwise
        say = self.lines.append
        say(f"(if {test} (then")
        if branch.is_edge:
            say(f"(if (i32.load16_s (i32.const {self._memory(branch)})) (then")
            self.lines += other_lines
            say(") (else")
        self._remember(branch, 1)
        self.lines += then_lines
        if then is not None and joined is not None:
            self._charge(then - joined)
        if branch.is_edge:
            say("))")
        say(") (else")
        if not node.is_broken:
            self._remember(branch, 0)
        self.lines += other_lines
        say("))")
        return joined

    def _loop(self, node: Loop, uncharged: int) -> int:
        branch = node.branch
        say = self.lines.append
        say("(block (loop")
        self._unless(node.need + uncharged, self._leaving(Place(node.pc, ()), INTERPRET, uncharged))
        before = self._nodes(node.before, uncharged)
        assert before is not None
        self.expressions.refuse = self._leaving(branch.place, INTERPRET, before)
        test = self.expressions.condition(branch.operator, branch.left, branch.right)
        say(f"(if {test} (then")
        self._remember(branch, 1)
        ended = self._nodes(node.body, before + branch.cost)
        if ended is not None:
            self._charge(ended - uncharged)
        say("(br 1)))")
        self._charge(before - uncharged)
        self._remember(branch, 0)
        say("))")
        return uncharged + branch.cost

    def _memory(self, branch: Branch) -> int:
        return _BRANCHES + 2 * self.order[branch.pc]

    def _remember(self, branch: Branch, value: int) -> None:
        self.lines.append(f"(i32.store16 (i32.const {self._memory(branch)}) (i32.const {value}))")

    # -- statements

    def _statement(self, node: Statement, uncharged: int) -> None:
        write, say = self.expressions, self.lines.append
        write.refuse = self._leaving(node.place, INTERPRET, uncharged)
        match node:
            case Assign(address=address, value=value):
                text = write.low(value)
                self._keep(node)
                say(f"(i32.store16 offset={2 * address} (i32.const 0) {text})")
            case AssignIndex(base=base, size=size, element=element, value=value):
                text = write.low(value)
                place = write.place(base, size, element)
                self._keep(node)
                say(f"(i32.store16 offset={2 * base} {place} {text})")
            case Emit(number=number, address=address, length=length):
                self._keep(node)
                say(f"(drop (call $emit (i32.const {number}) (i32.const {address}) (i32.const {length})))")
            case Call():
                self._call(node, uncharged)

    def _keep(self, node: Statement) -> None:
        for temp, expression in node.keep:
            self.temps.add(temp.number)
            text = self.expressions.word(expression)
            self.lines.append(f"(local.set $s{temp.number} {text})")

    def _call(self, node: Call, uncharged: int) -> None:
        native = self.natives[node.number]
        known = arguments(node.popped, native.signature)
        if known is not None and native.is_standard:
            lines = inline(native.signature.native.name, known)
            if lines is not None:
                self._keep(node)
                self.lines += lines
                return
        write, say = self.expressions, self.lines.append
        popped = [write.word(word) for word in node.popped]
        self._keep(node)
        for place, text in enumerate(popped):
            say(f"(i32.store (i32.const {_ARGUMENTS + 4 * place}) {text})")
        head = f"(i32.const {node.number}) (i32.const {node.pc}) (i32.const {len(popped)})"
        say(f"(local.set $h (call $native {head}))")
        before = self._leaving(node.place, INTERPRET, uncharged)
        after = self._leaving(node.after, INTERPRET, uncharged + node.cost)
        say(f"(if (local.get $h) (then (if (i32.eq (local.get $h) (i32.const 2)) (then {before})) {after}))")


__all__ = ["is_available", "translate"]
