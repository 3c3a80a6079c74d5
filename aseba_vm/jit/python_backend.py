"""Translation to Python source: one function for an event (or any other block), its subroutines inside.

Words that are only loaded and stored are local variables of the function, as are the memories of branches; arrays and
what natives touch stay in the list. Whatever leaves raises :class:`Left` with address, kind, instructions not yet
charged and the words of the stack; then the locals are written back. See :mod:`aseba_vm.jit.structured_ir` for the
budget.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from aseba_vm.jit.basic_blocks import Blocks
from aseba_vm.jit.host import Run
from aseba_vm.jit.ir import Assign, AssignIndex, Branch, Call, Emit, Known, Place, Statement
from aseba_vm.jit.memory_usage import LONGEST_EMIT, Survey, needs_barrier, runs
from aseba_vm.jit.python_expressions import Expressions
from aseba_vm.jit.structured_ir import (
    INTERPRET,
    STOPPED,
    Back,
    Check,
    Cost,
    Exit,
    If,
    Loop,
    Node,
    Routine,
    Structure,
    Visit,
)


class Left(Exception):  # noqa: N818  # not an error: a way out
    """Translated code is left: address, kind, instructions to charge, words on the stack."""


def translate(blocks: Blocks, structure: Structure, natives: Sequence[Known]) -> Callable[..., Run]:
    """Return what makes the function of a structure for one machine, for :meth:`aseba_vm.jit.host.PythonHost.make`."""
    source = _Writer(blocks, structure, natives).source()
    scope: dict[str, Any] = {"Left": Left}
    exec(compile(source, "<aseba>", "exec"), scope)
    make: Callable[..., Run] = scope["make"]
    return make


class _Writer:
    """Writes the source of one function."""

    def __init__(self, blocks: Blocks, structure: Structure, natives: Sequence[Known]) -> None:
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
        survey = Survey(natives)
        survey.visit(structure.main.nodes)
        for sub in structure.subs.values():
            survey.visit(sub.nodes)
        self.locals = survey.scalars - survey.shared
        self.all_branches = survey.branches
        self.all_stored = survey.stored & self.locals
        self.expressions = Expressions(self.say, self.name)

    def source(self) -> str:
        """Return the text of ``make``: a function of variables, memories of branches, callers of natives and emit."""
        subs = [self._sub(sub) for sub in self.structure.subs.values()]
        self.lines = []
        self.indent = 1
        self._load()
        self._runs("B", {self.order[pc]: f"b{pc}" for pc in self.all_branches}, is_store=False)
        self.say("o = ()")
        for sub in subs:
            self.lines += sub
        self.is_sub = False
        self.say("try:")
        self.say(" while 1:")
        self.indent = 3
        self.loops = 0
        self._nodes(self.structure.main.nodes, 0)
        self.indent = 1
        self.say("except Left as way: p, k, a, o = way.args; n -= a")
        self._store()
        self._runs("B", {self.order[pc]: f"b{pc}" for pc in self.all_branches}, is_store=True)
        self.say("return n, p, k, o")
        body = "\n ".join(["def run(n, V=V, B=B, H=H, E=E):", *self.lines])
        return f"def make(V, B, H, E):\n {body}\n return run"

    def _sub(self, sub: Routine) -> list[str]:
        """Return the lines of a subroutine; ``r`` are the addresses to return to, outermost first."""
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

    def say(self, line: str) -> None:
        """Append a line."""
        self.lines.append(" " * self.indent + line)

    def name(self, address: int) -> str:
        """Return the text of a word of memory."""
        return f"v{address}" if address in self.locals else f"V[{address}]"

    # -- memory

    def _load(self) -> None:
        self._runs("V", {address: f"v{address}" for address in self.locals}, is_store=False)

    def _store(self) -> None:
        self._runs("V", {address: f"v{address}" for address in self.all_stored}, is_store=True)

    def _runs(self, memory: str, names: dict[int, str], *, is_store: bool) -> None:
        """Copy between words of a memory and names, neighbours at once."""
        for first, last in runs(names):
            group = ", ".join(names[place] for place in range(first, last + 1))
            place = f"{memory}[{first}]" if first == last else f"{memory}[{first}:{last + 1}]"
            self.say(f"{place} = {group}" if is_store else f"{group} = {place}")

    def _reload(self) -> None:
        self._load()
        self.changed |= {f"v{address}" for address in self.locals}
        self.expressions.known.clear()

    # -- leaving

    def _words(self, place: Place) -> str:
        """Return the words on the stack at a place, as a tuple."""
        pending = "".join(f"{self.expressions.word(atom).text}, " for atom in place.pending)
        if self.is_sub:
            return f"(*r, {pending})" if pending else "r"
        return f"({pending})"

    def _leaving(self, place: Place, kind: int, uncharged: int) -> str:
        return f"raise Left({place.pc}, {kind}, {uncharged}, {self._words(place)})"

    def _charge(self, count: int) -> None:
        if count:
            self.say(f"n -= {count}" if count > 0 else f"n += {-count}")
            self.changed.add("n")

    # -- nodes

    def _nodes(self, nodes: Sequence[Node], uncharged: int) -> int | None:
        """Write nodes; return the instructions not charged at their end, None if it is not reached."""
        for node in nodes:
            match node:
                case Cost(cost):
                    uncharged += cost
                case Exit(place, kind, cost):
                    if kind == STOPPED and not self.is_sub and not self.loops:
                        self._charge(uncharged + cost)
                        self.say(f"p = {place.pc}; k = {STOPPED}; break")
                    else:
                        self.say(self._leaving(place, kind, uncharged + cost))
                    return None
                case Back(cost):
                    self._charge(uncharged + cost)
                    self.say("return")
                    return None
                case Check(pc, need):
                    self.say(f"if n < {need + uncharged}: {self._leaving(Place(pc, ()), INTERPRET, uncharged)}")
                case If():
                    ended = self._if(node, uncharged)
                    if ended is None:
                        return None
                    uncharged = ended
                case Loop():
                    uncharged = self._loop(node, uncharged)
                case Visit(end):
                    self._charge(uncharged + 1)
                    uncharged = 0
                    self.say(f"f{end.target}({f'(*r, {end.back})' if self.is_sub else f'({end.back},)'})")
                    self.expressions.known.clear()
                case _:
                    self._statement(node, uncharged)
                    uncharged += node.cost
        return uncharged

    def _if(self, node: If, uncharged: int) -> int | None:
        """Write a condition. A ``when`` that was true before goes the other way without forgetting it."""
        branch = node.branch
        self.expressions.refuse = self._leaving(branch.place, INTERPRET, uncharged)
        test = self.expressions.condition(branch.operator, branch.left, branch.right)
        start = uncharged + branch.cost
        known = dict(self.expressions.known)
        self.say(f"if {test}:")
        self.indent += 1
        if branch.is_edge:
            self._arm(f"if b{branch.pc}:", node.otherwise, start, None)
            self.expressions.known = dict(known)
            self.say("else:")
            self.indent += 1
        self._remember(branch, 1)
        then = self._nodes(node.then, start)
        then_end, then_indent = len(self.lines), self.indent
        self.indent -= 2 if branch.is_edge else 1
        self.expressions.known = known
        otherwise = self._arm("else:", node.otherwise, start, None if node.is_broken else branch)
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

    def _arm(self, head: str, nodes: Sequence[Node], uncharged: int, forget: Branch | None) -> int | None:
        self.say(head)
        self.indent += 1
        if forget is not None:
            self._remember(forget, 0)
        ended = self._nodes(nodes, uncharged)
        if forget is None:
            self.say("pass")
        self.indent -= 1
        return ended

    def _loop(self, node: Loop, uncharged: int) -> int:
        branch = node.branch
        self.expressions.known.clear()
        self.say(f"while n >= {node.need + uncharged}:")
        self.indent += 1
        self.loops += 1
        before = self._nodes(node.before, uncharged)
        assert before is not None
        self.expressions.refuse = self._leaving(branch.place, INTERPRET, before)
        test = self.expressions.condition(branch.operator, branch.left, branch.right)
        after = before + branch.cost
        self.say(f"if not {test}:")
        self.indent += 1
        self._charge(before - uncharged)
        self._remember(branch, 0)
        self.say("break")
        self.indent -= 1
        self._remember(branch, 1)
        ended = self._nodes(node.body, after)
        if ended is not None:
            self._charge(ended - uncharged)
        self.loops -= 1
        self.indent -= 1
        self.say("else:")
        self.say(f" {self._leaving(Place(node.pc, ()), INTERPRET, uncharged)}")
        self.expressions.known.clear()
        return uncharged + branch.cost

    def _remember(self, branch: Branch, value: int) -> None:
        self.say(f"b{branch.pc} = {value}")
        self.changed.add(f"b{branch.pc}")

    # -- statements

    def _statement(self, node: Statement, uncharged: int) -> None:
        write = self.expressions
        write.refuse = self._leaving(node.place, INTERPRET, uncharged)
        match node:
            case Assign(address=address, value=value):
                text = write.word(value)
                self._keep(node)
                self.say(f"{self.name(address)} = {text.text}")
                if address in self.locals:
                    self.changed.add(f"v{address}")
                    write.known[address] = text.interval
            case AssignIndex(base=base, size=size, element=index, value=value):
                text = write.word(value)
                place = write.index(index, size)
                self._keep(node)
                self.say(f"V[{place} + {base}] = {text.text}")
            case Emit(number=number, address=address, length=count):
                self._keep(node)
                words = f"tuple(V[{address}:{address + count}])"
                if count <= LONGEST_EMIT:
                    words = f"({''.join(f'{self.name(address + place)}, ' for place in range(count))})"
                self.say(f"E({number}, {words})")
            case Call():
                self._call(node, uncharged)

    def _keep(self, node: Statement) -> None:
        for temp, expression in node.keep:
            self.say(f"s{temp.number} = {self.expressions.word(expression).text}")

    def _call(self, node: Call, uncharged: int) -> None:
        popped = ", ".join([*(self.expressions.word(word).text for word in node.popped), ""])
        self._keep(node)
        is_barrier = needs_barrier(node, self.natives)
        if is_barrier:
            self._store()
        self.say(f"h = H({node.number}, {node.pc}, ({popped}))")
        if is_barrier:
            self._reload()
        before = self._leaving(node.place, INTERPRET, uncharged)
        self.say("if h:")
        self.say(f" if h == 2: {before}")
        self.say(f" {self._leaving(node.after, INTERPRET, uncharged + node.cost)}")


__all__ = ["Left", "translate"]
