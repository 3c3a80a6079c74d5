"""Translation to Python source: one function per event (or other entry block), with its subroutines inside.

Words that are only loaded and stored become local variables of the function, and so do the edge flags of branches.
Arrays and the words that natives use stay in the list. Every exit raises :class:`TranslatedExit` with address, kind,
instructions not yet charged, and the words of the stack; the handler then writes the local variables back.
:mod:`aseba_vm.jit.structured_ir` explains the budget.

Names in the generated source: V variables, B edge flags, H caller of natives, E emit; v<address>, b<pc> and s<number>
local copies of words, edge flags and temporaries; n budget, p address, k kind of exit, a charge, o stack words.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from aseba_vm.jit.basic_blocks import Blocks
from aseba_vm.jit.host import Run
from aseba_vm.jit.ir import Assign, AssignIndex, Branch, Call, Emit, KnownNative, ProgramPoint, Statement
from aseba_vm.jit.memory_usage import MAX_SCALAR_EMIT, MemoryUsage, contiguous_ranges, needs_barrier
from aseba_vm.jit.python_expressions import Expressions
from aseba_vm.jit.structured_ir import (
    INTERPRET,
    STOPPED,
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


class TranslatedExit(Exception):  # noqa: N818  # control flow, not an error
    """Exit from translated code: address, kind, instructions to charge, words on the stack."""


def translate(blocks: Blocks, structure: StructuredProgram, natives: Sequence[KnownNative]) -> Callable[..., Run]:
    """Return a factory of the function for one machine, for :meth:`aseba_vm.jit.host.PythonHost.instantiate`."""
    source = _Writer(blocks, structure, natives).source()
    scope: dict[str, Any] = {"TranslatedExit": TranslatedExit}
    exec(compile(source, "<aseba>", "exec"), scope)
    make: Callable[..., Run] = scope["make"]
    return make


class _Writer:
    """Generates the source of one function."""

    def __init__(self, blocks: Blocks, structure: StructuredProgram, natives: Sequence[KnownNative]) -> None:
        self.structure = structure
        self.natives = natives
        self.order = {pc: place for place, pc in enumerate(blocks.branches)}
        self.lines: list[str] = []
        self.indent = 1
        self.loops = 0
        self.is_sub = False
        self.stored: set[int] = set()
        self.branches: set[int] = set()
        self.changed: set[str] = set()
        usage = MemoryUsage(natives)
        usage.visit(structure.main.nodes)
        for sub in structure.subs.values():
            usage.visit(sub.nodes)
        self.locals = usage.scalars - usage.shared
        self.all_branches = usage.branches
        self.all_stored = usage.stored & self.locals
        self.expressions = Expressions(self.emit_line, self.name)

    def source(self) -> str:
        """Return the source of ``make(V, B, H, E)``, which returns the function ``run``."""
        subs = [self._sub(sub) for sub in self.structure.subs.values()]
        self.lines = []
        self.indent = 1
        self._load()
        self._copy_ranges("B", {self.order[pc]: f"b{pc}" for pc in self.all_branches}, is_store=False)
        self.emit_line("o = ()")
        for sub in subs:
            self.lines += sub
        self.is_sub = False
        # The loop is never repeated: it lets the frequent exit at the end of an event be a break, not an exception.
        self.emit_line("try:")
        self.emit_line(" while 1:")
        self.indent = 3
        self.loops = 0
        self._nodes(self.structure.main.nodes, 0)
        self.indent = 1
        self.emit_line("except TranslatedExit as e: p, k, a, o = e.args; n -= a")
        self._store()
        self._copy_ranges("B", {self.order[pc]: f"b{pc}" for pc in self.all_branches}, is_store=True)
        self.emit_line("return n, p, k, o")
        body = "\n ".join(["def run(n, V=V, B=B, H=H, E=E):", *self.lines])
        return f"def make(V, B, H, E):\n {body}\n return run"

    def _sub(self, sub: Routine) -> list[str]:
        """Return the lines of a subroutine; its parameter ``r`` has the return addresses, outermost first."""
        self.lines = []
        self.changed = set()
        self.indent = 2
        self.is_sub = True
        self.loops = 0
        self.expressions.known.clear()
        self._nodes(sub.nodes, 0)
        self.expressions.known.clear()
        names = ", ".join(sorted({"n", *self.changed}))
        return [f" def f{sub.pc}(r):", f"  nonlocal {names}", *self.lines]

    def emit_line(self, line: str) -> None:
        """Append a line."""
        self.lines.append(" " * self.indent + line)

    def name(self, address: int) -> str:
        """Return the expression for a word of memory: a local variable or an element of the list."""
        return f"v{address}" if address in self.locals else f"V[{address}]"

    # -- memory

    def _load(self) -> None:
        self._copy_ranges("V", {address: f"v{address}" for address in self.locals}, is_store=False)

    def _store(self) -> None:
        self._copy_ranges("V", {address: f"v{address}" for address in self.all_stored}, is_store=True)

    def _copy_ranges(self, memory: str, names: dict[int, str], *, is_store: bool) -> None:
        """Copy between a memory and local variables, contiguous words in one assignment."""
        for first, last in contiguous_ranges(names):
            group = ", ".join(names[place] for place in range(first, last + 1))
            place = f"{memory}[{first}]" if first == last else f"{memory}[{first}:{last + 1}]"
            self.emit_line(f"{place} = {group}" if is_store else f"{group} = {place}")

    def _reload(self) -> None:
        self._load()
        self.changed |= {f"v{address}" for address in self.locals}
        self.expressions.known.clear()

    # -- exits

    def _words(self, place: ProgramPoint) -> str:
        """Return the words on the stack at a program point, as a tuple expression."""
        pending = "".join(f"{self.expressions.word(atom).text}, " for atom in place.pending)
        if self.is_sub:
            return f"(*r, {pending})" if pending else "r"
        return f"({pending})"

    def _exit(self, place: ProgramPoint, kind: int, uncharged: int) -> str:
        return f"raise TranslatedExit({place.pc}, {kind}, {uncharged}, {self._words(place)})"

    def _charge(self, count: int) -> None:
        if count:
            self.emit_line(f"n -= {count}" if count > 0 else f"n += {-count}")
            self.changed.add("n")

    # -- nodes

    def _nodes(self, nodes: Sequence[Node], uncharged: int) -> int | None:
        """Generate nodes; return the instructions not yet charged at their end, None if the end is unreachable."""
        for node in nodes:
            match node:
                case Charge(cost):
                    uncharged += cost
                case Exit(place, kind, cost):
                    if kind == STOPPED and not self.is_sub and not self.loops:
                        self._charge(uncharged + cost)
                        self.emit_line(f"p = {place.pc}; k = {STOPPED}; break")
                    else:
                        self.emit_line(self._exit(place, kind, uncharged + cost))
                    return None
                case SubReturn(cost):
                    self._charge(uncharged + cost)
                    self.emit_line("return")
                    return None
                case Check(pc, need):
                    self.emit_line(
                        f"if n < {need + uncharged}: {self._exit(ProgramPoint(pc, ()), INTERPRET, uncharged)}"
                    )
                case If():
                    ended = self._if(node, uncharged)
                    if ended is None:
                        return None
                    uncharged = ended
                case Loop():
                    uncharged = self._loop(node, uncharged)
                case SubCall(end):
                    self._charge(uncharged + 1)
                    uncharged = 0
                    self.emit_line(f"f{end.target}({f'(*r, {end.back})' if self.is_sub else f'({end.back},)'})")
                    self.expressions.known.clear()
                case _:
                    self._statement(node, uncharged)
                    uncharged += node.cost
        return uncharged

    def _if(self, node: If, uncharged: int) -> int | None:
        """Generate a condition; return the instructions not yet charged after it.

        A ``when`` whose condition was true before takes the other arm and keeps its edge flag. Both arms must end with
        the same number of uncharged instructions, so each arm charges its difference from a common number.
        """
        branch = node.branch
        self.expressions.bail_out = self._exit(branch.place, INTERPRET, uncharged)
        test = self.expressions.condition(branch.operator, branch.left, branch.right)
        start = uncharged + branch.cost
        known = dict(self.expressions.known)
        self.emit_line(f"if {test}:")
        self.indent += 1
        if branch.is_edge:
            self._else(f"if b{branch.pc}:", node.otherwise, start, None)
            self.expressions.known = dict(known)
            self.emit_line("else:")
            self.indent += 1
        self._set_edge(branch, 1)
        then = self._nodes(node.then, start)
        then_end, then_indent = len(self.lines), self.indent
        self.indent -= 2 if branch.is_edge else 1
        self.expressions.known = known
        otherwise = self._else("else:", node.otherwise, start, None if node.is_broken else branch)
        # An arm that ends in an exit does not reach the join, so the other arm decides. Otherwise the difference is
        # charged at the end of each arm; the lines of the then-arm are already followed by those of the else-arm.
        if then is None or otherwise is None:
            joined = otherwise if then is None else then
        else:
            joined = min(then, otherwise) if node.otherwise and not branch.is_edge else otherwise
            self.indent += 1
            self._charge(otherwise - joined)
            self.indent, outer = then_indent, self.indent - 1
            rest, self.lines = self.lines[then_end:], self.lines[:then_end]
            self._charge(then - joined)
            self.lines += rest
            self.indent = outer
        self.expressions.known.clear()
        return joined

    def _else(self, head: str, nodes: Sequence[Node], uncharged: int, cleared: Branch | None) -> int | None:
        self.emit_line(head)
        self.indent += 1
        if cleared is not None:
            self._set_edge(cleared, 0)
        ended = self._nodes(nodes, uncharged)
        if cleared is None:
            self.emit_line("pass")
        self.indent -= 1
        return ended

    def _loop(self, node: Loop, uncharged: int) -> int:
        branch = node.branch
        self.expressions.known.clear()
        # The condition of the Python loop is the budget check; its else-clause is the exit for an exhausted budget, so
        # leaving the loop of the program is a break. At each head the same number of instructions is uncharged.
        self.emit_line(f"while n >= {node.need + uncharged}:")
        self.indent += 1
        self.loops += 1
        before = self._nodes(node.before, uncharged)
        assert before is not None
        self.expressions.bail_out = self._exit(branch.place, INTERPRET, before)
        test = self.expressions.condition(branch.operator, branch.left, branch.right)
        after = before + branch.cost
        self.emit_line(f"if not {test}:")
        self.indent += 1
        self._charge(before - uncharged)
        self._set_edge(branch, 0)
        self.emit_line("break")
        self.indent -= 1
        self._set_edge(branch, 1)
        ended = self._nodes(node.body, after)
        if ended is not None:
            self._charge(ended - uncharged)
        self.loops -= 1
        self.indent -= 1
        self.emit_line("else:")
        self.emit_line(f" {self._exit(ProgramPoint(node.pc, ()), INTERPRET, uncharged)}")
        self.expressions.known.clear()
        return uncharged + branch.cost

    def _set_edge(self, branch: Branch, value: int) -> None:
        self.emit_line(f"b{branch.pc} = {value}")
        self.changed.add(f"b{branch.pc}")

    # -- statements

    def _statement(self, node: Statement, uncharged: int) -> None:
        write = self.expressions
        write.bail_out = self._exit(node.place, INTERPRET, uncharged)
        match node:
            case Assign(address=address, value=value):
                text = write.word(value)
                self._spill(node)
                self.emit_line(f"{self.name(address)} = {text.text}")
                if address in self.locals:
                    self.changed.add(f"v{address}")
                    write.known[address] = text.interval
            case AssignIndex(base=base, size=size, element=index, value=value):
                text = write.word(value)
                place = write.index(index, size)
                self._spill(node)
                self.emit_line(f"V[{place} + {base}] = {text.text}")
            case Emit(number=number, address=address, length=count):
                self._spill(node)
                words = f"tuple(V[{address}:{address + count}])"
                if count <= MAX_SCALAR_EMIT:
                    words = f"({''.join(f'{self.name(address + place)}, ' for place in range(count))})"
                self.emit_line(f"E({number}, {words})")
            case Call():
                self._call(node, uncharged)

    def _spill(self, node: Statement) -> None:
        for temp, expression in node.keep:
            self.emit_line(f"s{temp.number} = {self.expressions.word(expression).text}")

    def _call(self, node: Call, uncharged: int) -> None:
        popped = ", ".join([*(self.expressions.word(word).text for word in node.popped), ""])
        self._spill(node)
        is_barrier = needs_barrier(node, self.natives)
        # A native that may access any word sees memory, not local variables: write them back, and read them afterwards.
        if is_barrier:
            self._store()
        self.emit_line(f"h = H({node.number}, {node.pc}, ({popped}))")
        if is_barrier:
            self._reload()
        before = self._exit(node.place, INTERPRET, uncharged)
        self.emit_line("if h:")
        self.emit_line(f" if h == 2: {before}")
        self.emit_line(f" {self._exit(node.after, INTERPRET, uncharged + node.cost)}")


__all__ = ["TranslatedExit", "translate"]
