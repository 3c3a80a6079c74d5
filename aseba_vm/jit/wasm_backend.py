"""Translation to WebAssembly: one module per event.

Modules work directly on the state of the machine (`aseba_vm.jit.wasm_host`). A subroutine is a function that
takes the budget and the stack depth, and returns the budget left, or -1 if translated code was left inside it. An exit
writes the remaining budget, address, kind and the words of the stack into memory. Standard natives are compiled from
their kernels.

Locals in the generated code: `$n` budget, `$d` stack depth, `$h` scratch, `$t<number>` temporaries of
expressions, `$s<number>` temporaries of statements, `$inlined<number>.<name>` those of natives.
"""

from __future__ import annotations

from collections.abc import Sequence

from aseba_vm.jit.basic_blocks import Blocks
from aseba_vm.jit.ir import (
    Assign,
    AssignIndex,
    Branch,
    Call,
    Const,
    Emit,
    KnownNative,
    ProgramPoint,
    Statement,
    arguments,
)
from aseba_vm.jit.structured_ir import (
    INTERPRET,
    Charge,
    Check,
    Exit,
    If,
    Loop,
    Node,
    Routine,
    StructuredProgram,
    SubCall,
    SubReturn,
)
from aseba_vm.jit.wasm_expressions import WasmExpressions
from aseba_vm.jit.wasm_host import (
    ARGUMENTS,
    COST,
    EDGES,
    EXIT,
    IMPORTS,
    INNER,
    RANDOM,
    STACK,
    TABLES,
    VARIABLES,
    CallSite,
    EmitSite,
    WasmCode,
)
from aseba_vm.kernel.compiler import KernelModule, Place, parameters
from aseba_vm.kernel.wasm_runtime import WasmRuntime
from aseba_vm.machine.native_faults import OK

_TRAPPED = -1
"""Kind of exit before there is one; it remains if the code traps."""


def translate(blocks: Blocks, structure: StructuredProgram, natives: Sequence[KnownNative]) -> WasmCode:
    """The code of a program, for `aseba_vm.jit.wasm_host.WasmHost.instantiate`."""
    writer = _Writer(structure, natives, blocks.memories.variables)
    return WasmCode(WasmRuntime.get().compile(writer.text()), tuple(writer.sites))


class _Writer:
    """Generates the text of a module."""

    def __init__(self, structure: StructuredProgram, natives: Sequence[KnownNative], memory_words: int) -> None:
        self.structure = structure
        self.natives = natives
        self.lines: list[str] = []
        self.is_sub = False
        self.sites: list[CallSite | EmitSite] = []
        self.kernels = KernelModule(
            {"memory": Place(VARIABLES, memory_words), "random": Place(RANDOM, 1), "cost": Place(COST, 1)}, TABLES
        )
        self.locals: dict[str, str] = {}
        self.expressions = WasmExpressions(self.emit_line)

    def emit_line(self, line: str) -> None:
        """Append a line."""
        self.lines.append(line)

    def text(self) -> str:
        """The module; its export `run` reads the budget from memory and writes the exit there."""
        subs = [self._routine(sub, f"$f{sub.pc}") for sub in self.structure.subs.values()]
        main = self._routine(self.structure.main, '$run (export "run")')
        return "\n".join(["(module", IMPORTS, self.kernels.text(), *subs, main, ")"])

    def _routine(self, routine: Routine, name: str) -> str:
        self.lines.clear()
        self.locals.clear()
        self.expressions.temporaries = 0
        self.is_sub = routine.is_sub
        if routine.is_sub:
            head = "(param $n i64) (param $d i32) (result i64)"
        else:
            head = "(local $n i64)"
            self.lines.append(f"(local.set $n (i64.load (i32.const {EXIT})))")
            self.lines.append(f"(i32.store (i32.const {EXIT + 12}) (i32.const {_TRAPPED}))")
        self._nodes(routine.nodes, 0)
        temporaries = {f"$t{number + 1}": "i32" for number in range(self.expressions.temporaries)}
        names = {**temporaries, **self.locals, "$h": "i32"}
        local = "".join(f"(local {name} {kind})" for name, kind in names.items())
        body = "\n".join(self.lines)
        return f"(func {name} {head} {local}\n{body}\n(unreachable))"

    # -- exits

    def _exit(self, place: ProgramPoint, kind: int, uncharged: int) -> str:
        """The code that stores the exit and returns."""
        depth = "(local.get $d)" if self.is_sub else "(i32.const 0)"
        stores = [f"(i32.store (i32.const {EXIT + 8}) (i32.const {place.pc}))"]
        stores.append(f"(i32.store (i32.const {EXIT + 12}) (i32.const {kind}))")
        # Return addresses of active subroutines are already at STACK, one per level; the pending words follow them.
        for number, atom in enumerate(place.pending):
            at = f"(i32.shl {depth} (i32.const 2))"
            stores.append(f"(i32.store offset={STACK + 4 * number} {at} {self.expressions.word(atom)})")
        more = f"(i32.add {depth} (i32.const {len(place.pending)}))" if place.pending else depth
        stores.append(f"(i32.store (i32.const {EXIT + 16}) {more})")
        left = f"(i64.sub (local.get $n) (i64.const {uncharged}))"
        if not self.is_sub:
            return f"{' '.join(stores)} (i64.store (i32.const {EXIT}) {left}) (return)"
        return f"{' '.join(stores)} (i64.store (i32.const {INNER}) {left}) (return (i64.const -1))"

    def _charge(self, count: int) -> None:
        if count:
            self.lines.append(f"(local.set $n (i64.sub (local.get $n) (i64.const {count})))")

    def _check_budget(self, need: int, exit_code: str) -> None:
        self.lines.append(f"(if (i64.lt_s (local.get $n) (i64.const {need})) (then {exit_code}))")

    # -- nodes

    def _nodes(self, nodes: Sequence[Node], uncharged: int) -> int | None:
        """Generate nodes.

        Returns:
            The number of instructions not yet charged at their end; None if the end is unreachable.
        """
        for node in nodes:
            match node:
                case Charge(cost):
                    uncharged += cost
                case Exit(place, kind, cost):
                    self.lines.append(self._exit(place, kind, uncharged + cost))
                    return None
                case SubReturn(cost):
                    self._charge(uncharged + cost)
                    self.lines.append("(return (local.get $n))")
                    return None
                case Check(pc, need):
                    self._check_budget(need + uncharged, self._exit(ProgramPoint(pc, ()), INTERPRET, uncharged))
                case If():
                    ended = self._if(node, uncharged)
                    if ended is None:
                        return None
                    uncharged = ended
                case Loop():
                    uncharged = self._loop(node, uncharged)
                case SubCall(end):
                    self._sub_call(end.target, end.back, uncharged + 1)
                    uncharged = 0
                case _:
                    self._statement(node, uncharged)
                    uncharged += node.cost
        return uncharged

    def _sub_call(self, target: int, back: int, uncharged: int) -> None:
        self._charge(uncharged)
        depth = "(local.get $d)" if self.is_sub else "(i32.const 0)"
        emit_line = self.lines.append
        emit_line(f"(i32.store offset={STACK} (i32.shl {depth} (i32.const 2)) (i32.const {back}))")
        emit_line(f"(local.set $n (call $f{target} (local.get $n) (i32.add {depth} (i32.const 1))))")
        # -1: the callee exited for good. Pass it on; the outermost function moves the remaining budget to EXIT.
        leave = "(return (i64.const -1))"
        if not self.is_sub:
            leave = f"(i64.store (i32.const {EXIT}) (i64.load (i32.const {INNER}))) (return)"
        emit_line(f"(if (i64.lt_s (local.get $n) (i64.const 0)) (then {leave}))")

    def _if(self, node: If, uncharged: int) -> int | None:
        """Generate a condition.

        A `when` whose condition was true before takes the other arm and keeps its edge flag. Both arms must end with
        the same number of uncharged instructions.
        """
        branch = node.branch
        self.expressions.bail_out = self._exit(branch.place, INTERPRET, uncharged)
        test = self.expressions.condition(branch.operator, branch.left, branch.right)
        start = uncharged + branch.cost
        # Generate both arms first: their uncharged instructions are known only afterwards. The then-arm is charged the
        # difference, so that both arms join with those of the else-arm. A `when` (edge) whose condition was already
        # true takes the else-arm, which is therefore generated twice.
        outer, self.lines[:] = list(self.lines), []
        then = self._nodes(node.then, start)
        then_lines, self.lines[:] = list(self.lines), []
        otherwise = self._nodes(node.otherwise, start)
        other_lines, self.lines[:] = list(self.lines), outer
        joined = then if otherwise is None else otherwise
        emit_line = self.lines.append
        emit_line(f"(if {test} (then")
        if branch.is_edge:
            emit_line(f"(if (i32.load16_s (i32.const {self._edge_address(branch)})) (then")
            self.lines += other_lines
            emit_line(") (else")
        self._set_edge(branch, 1)
        self.lines += then_lines
        if then is not None and joined is not None:
            self._charge(then - joined)
        if branch.is_edge:
            emit_line("))")
        emit_line(") (else")
        if not node.is_broken:
            self._set_edge(branch, 0)
        self.lines += other_lines
        emit_line("))")
        return joined

    def _loop(self, node: Loop, uncharged: int) -> int:
        branch = node.branch
        emit_line = self.lines.append
        # (block (loop check before (if test (then body (br 1))) rest-of-charge)): inside the `if`, label 0 is the `if`
        # and label 1 the loop, so `br 1` repeats; falling through ends it. At each head the same number of instructions
        # is uncharged.
        emit_line("(block (loop")
        self._check_budget(node.need + uncharged, self._exit(ProgramPoint(node.pc, ()), INTERPRET, uncharged))
        before = self._nodes(node.before, uncharged)
        assert before is not None
        self.expressions.bail_out = self._exit(branch.place, INTERPRET, before)
        test = self.expressions.condition(branch.operator, branch.left, branch.right)
        emit_line(f"(if {test} (then")
        self._set_edge(branch, 1)
        ended = self._nodes(node.body, before + branch.cost)
        if ended is not None:
            self._charge(ended - uncharged)
        emit_line("(br 1)))")
        self._charge(before - uncharged)
        self._set_edge(branch, 0)
        emit_line("))")
        return uncharged + branch.cost

    def _edge_address(self, branch: Branch) -> int:
        return EDGES + 2 * branch.pc

    def _set_edge(self, branch: Branch, value: int) -> None:
        self.lines.append(f"(i32.store16 (i32.const {self._edge_address(branch)}) (i32.const {value}))")

    # -- statements

    def _statement(self, node: Statement, uncharged: int) -> None:
        write, emit_line = self.expressions, self.lines.append
        write.bail_out = self._exit(node.place, INTERPRET, uncharged)
        match node:
            case Assign(address=address, value=value):
                text = write.low(value)
                self._spill(node)
                emit_line(f"(i32.store16 offset={2 * address} (i32.const 0) {text})")
            case AssignIndex(base=base, size=size, element=element, value=value):
                text = write.low(value)
                place = write.place(base, size, element)
                self._spill(node)
                emit_line(f"(i32.store16 offset={2 * base} {place} {text})")
            case Emit(number=number, address=address, length=length):
                self._spill(node)
                emit_line(f"(drop {self._python(EmitSite(number, address, length))})")
            case Call():
                self._call(node, uncharged)

    def _spill(self, node: Statement) -> None:
        for temp, expression in node.keep:
            self.locals[f"$s{temp.number}"] = "i32"
            text = self.expressions.word(expression)
            self.lines.append(f"(local.set $s{temp.number} {text})")

    def _call(self, node: Call, uncharged: int) -> None:
        """Generate a native call: of its kernel if it has one and its arguments are constant, otherwise of Python."""
        native = self.natives[node.number]
        after = self._exit(node.after, INTERPRET, uncharged + node.cost)
        is_constant = arguments(node.popped, native.signature) is not None
        popped = tuple(word.value & 0xFFFF for word in node.popped if isinstance(word, Const)) if is_constant else None
        site = CallSite(node.number, node.pc, len(node.popped), popped)
        write, emit_line = self.expressions, self.lines.append
        if native.kernel is not None and popped is not None:
            call = self.kernels.call(native.kernel, popped)
            self.locals.update(call.locals)
            self._spill(node)
            if call.result == OK:
                emit_line(f"(drop {call.text})")
                return
            # The kernel runs inside the module. Python is called only for a fault or an additional cost, both rare, and
            # the code then exits behind the call: the kernel has been executed and must not be repeated.
            condition = f"(local.tee $h {call.text})"
            if "cost" in parameters(native.kernel)[0]:
                condition = f"(i32.or {condition} (i32.load (i32.const {COST})))"
            finish = f"(drop {self._python(site, '(i32.add (local.get $h) (i32.const 1))')})"
            emit_line(f"(if {condition} (then {finish} {after}))")
        else:
            words = [] if is_constant else [write.word(word) for word in node.popped]
            self._spill(node)
            for place, text in enumerate(words):
                emit_line(f"(i32.store (i32.const {ARGUMENTS + 4 * place}) {text})")
            emit_line(f"(local.set $h {self._python(site)})")
            # 2: nothing was done. Exit before the call; the interpreter repeats it and reports the invalid argument.
            before = self._exit(node.place, INTERPRET, uncharged)
            emit_line(f"(if (local.get $h) (then (if (i32.eq (local.get $h) (i32.const 2)) (then {before})) {after}))")

    def _python(self, site: CallSite | EmitSite, done: str = "(i32.const 0)") -> str:
        """A call of Python; `done` is 1 plus the result of a translated native."""
        self.sites.append(site)
        return f"(call $python (i32.const {len(self.sites) - 1}) {done})"
