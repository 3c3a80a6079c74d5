"""Structured control flow from basic blocks: loops and conditions, recovered from the patterns of the compiler.

Source: docs/spec/aseba-bytecode-vm.md section 6.

Any other control flow becomes an `Exit` to an address, where other translated code or the interpreter continues.
So every program can be translated, though some gain less. The instruction budget is checked at each `Check` and
at the head of each loop, for the longest path to the next check.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from aseba_vm.jit.basic_blocks import Blocks
from aseba_vm.jit.ir import BailOut, Branch, EnterSub, Jump, ProgramPoint, Return, Statement, Stop

MAX_NESTING = 14
MAX_NODES = 4000
_MAX_CALLS = 32
_CHECK_EVERY = 250

STOPPED = 0
INTERPRET = 1
CONTINUE = 2


@dataclass(slots=True)
class Exit:
    """Leave translated code.

    `kind` is STOPPED (the event has ended), INTERPRET (the interpreter must continue) or CONTINUE (other translated
    code may continue).
    """

    place: ProgramPoint
    kind: int
    cost: int = 0


@dataclass(slots=True)
class Charge:
    """Instructions without an effect of their own: jumps."""

    cost: int


@dataclass(slots=True)
class Check:
    """Exit unless `need` instructions are left."""

    pc: int
    need: int


@dataclass(slots=True)
class If:
    """A condition with two arms, each a list of nodes."""

    branch: Branch
    then: list[Node]
    otherwise: list[Node]

    @property
    def is_broken(self) -> bool:
        """Whether the target of a false condition does not exist."""
        first = self.otherwise[0] if self.otherwise else None
        return isinstance(first, Exit) and first.cost < 0


@dataclass(slots=True)
class Loop:
    """`before`, the condition and `body`, repeated while true; `need` is the budget of the longest iteration."""

    pc: int
    before: list[Node]
    branch: Branch
    body: list[Node]
    need: int = 0


@dataclass(slots=True)
class SubCall:
    """A call of a subroutine."""

    end: EnterSub


@dataclass(slots=True)
class SubReturn:
    """The end of a subroutine."""

    cost: int


Node = Statement | Exit | Charge | Check | If | Loop | SubCall | SubReturn


@dataclass(slots=True)
class Routine:
    """The code of a subroutine, or of an event (`is_sub` is false), with the budget and stack depth it needs."""

    pc: int
    is_sub: bool
    nodes: list[Node] = field(default_factory=list)
    need: int = 0
    depth: int = 0
    has_checks: bool = False


class StructuredProgram:
    """The routine at `entry` (`main`) and the subroutines it calls (`subs`, by address)."""

    def __init__(self, blocks: Blocks, entry: int) -> None:
        self.blocks = blocks
        self.subs: dict[int, Routine] = {}
        self._open: list[int] = []
        self._nodes = 0
        self.main = self._routine(entry, is_sub=False)

    @property
    def is_too_large(self) -> bool:
        """Whether the code exceeds MAX_NODES, which only artificial programs do."""
        return self._nodes > MAX_NODES

    def _routine(self, pc: int, *, is_sub: bool) -> Routine:
        self._open.append(pc)
        routine = Routine(pc, is_sub)
        routine.nodes, _ = self._sequence(routine, pc, None, None, 0)
        self._open.pop()
        routine.need = self._need(routine, routine.nodes, 0)
        return routine

    def _sequence(
        self, routine: Routine, pc: int, end: int | None, jump: int | None, nesting: int
    ) -> tuple[list[Node], bool]:
        """The nodes from `pc` to `end` (or to the JUMP at `jump`), and whether control reaches it."""
        # `end` is where an arm or a body joins the code behind it; `jump` the JUMP that a then-arm or a loop body ends
        # with, which becomes structure and is only charged. All other jumps leave the structure by an exit.
        nodes: list[Node] = []
        while pc != end:
            block = self.blocks.by_address.get(pc)
            if block is None or nesting > MAX_NESTING or self._nodes > MAX_NODES:
                nodes.append(Exit(ProgramPoint(pc, ()), CONTINUE))
                return nodes, False
            self._nodes += 1 + len(block.statements)
            routine.depth = max(routine.depth, block.depth)
            last = block.end
            if isinstance(last, Branch):
                pc = self._condition(routine, nodes, pc, end, nesting)
                continue
            nodes += block.statements
            match last:
                case Jump(_, cost, at, target):
                    if cost:
                        nodes.append(Charge(cost))
                    if cost and (at == jump or target == end):
                        return nodes, True
                    if cost:
                        nodes.append(Exit(ProgramPoint(target, ()), CONTINUE))
                        return nodes, False
                    pc = target
                case EnterSub(place, _, target, back):
                    if not self._prepare_sub(routine, target):
                        nodes.append(Exit(place, INTERPRET))
                        return nodes, False
                    nodes.append(SubCall(last))
                    pc = back
                case Stop(place, cost):
                    nodes.append(Exit(place, STOPPED, cost))
                    return nodes, False
                case Return(place, cost):
                    nodes.append(SubReturn(cost) if routine.is_sub else Exit(place, INTERPRET))
                    return nodes, False
                case BailOut(place):
                    nodes.append(Exit(place, INTERPRET))
                    return nodes, False
        return nodes, True

    def _prepare_sub(self, routine: Routine, target: int) -> bool:
        """Translate the subroutine at `target` if necessary.

        Returns:
            Whether it can be called; a recursive one cannot.
        """
        # `_open` are the routines that are being built, from the entry to the present one: a target among them calls
        # itself. The stack that recursion needs has no bound, so the interpreter executes it.
        if target in self._open or len(self._open) > _MAX_CALLS:
            return False
        if target not in self.subs:
            self.subs[target] = self._routine(target, is_sub=True)
        routine.depth = max(routine.depth, 1 + self.subs[target].depth)
        return True

    def _condition(self, routine: Routine, nodes: list[Node], pc: int, end: int | None, nesting: int) -> int:
        """Append the block at `pc`, which ends in a branch, and its arms, and return the address after them.

        The compiler emits three patterns (docs/spec/aseba-bytecode-vm.md section 6). The word before the branch target
        distinguishes them: a JUMP back to `pc` closes a loop, a JUMP forward ends a then-arm with an else-arm, anything
        else is an `if` without `else`.
        """
        block = self.blocks.by_address[pc]
        branch = block.end
        assert isinstance(branch, Branch)
        target = branch.otherwise
        # A target behind the branch, outside the enclosing nodes or without code fits none of the patterns: exit to it.
        outside: list[Node] = [Exit(ProgramPoint(target, ()), CONTINUE)]
        if target not in self.blocks.by_address:
            # The interpreter repeats the branch and reports the fault; the negative cost takes the charge back.
            outside = [Exit(branch.place, INTERPRET, -branch.cost)]
        if target < branch.then or (end is not None and target > end) or target not in self.blocks.by_address:
            nodes += block.statements
            nodes.append(If(branch, [], outside))
            return branch.then
        jump = target - 1  # a JUMP has one word
        to = self.blocks.jumps.get(jump)
        if to == pc and not branch.is_edge:
            body, _ = self._sequence(routine, branch.then, target, jump, nesting + 1)
            nodes.append(Loop(pc, list(block.statements), branch, body))
            routine.has_checks = True
            return target
        nodes += block.statements
        if (
            to is not None
            and to > target
            and not branch.is_edge
            and (end is None or to <= end)
            and to in self.blocks.by_address
        ):
            then, _ = self._sequence(routine, branch.then, target, jump, nesting + 1)
            otherwise, _ = self._sequence(routine, target, to, None, nesting + 1)
            nodes.append(If(branch, then, otherwise))
            return to
        then, _ = self._sequence(routine, branch.then, target, None, nesting + 1)
        nodes.append(If(branch, then, []))
        return target

    def _need(self, routine: Routine, nodes: list[Node], after: int) -> int:
        """Insert checks of the budget, and return the maximum number of instructions to the first one.

        `after` is that number from the end of the nodes. The nodes are processed from last to first.
        """
        need = after
        for place in range(len(nodes) - 1, -1, -1):
            node = nodes[place]
            match node:
                case Exit() | SubReturn():
                    need = max(node.cost, 0)  # nothing after an exit is executed
                case If():
                    then = self._need(routine, node.then, need)
                    need = node.branch.cost + max(then, self._need(routine, node.otherwise, need))
                case Loop():
                    iteration = max(self._need(routine, node.body, 0), need)
                    node.need = self._need(routine, node.before, node.branch.cost + iteration)
                    need = 0  # the loop checks its own budget before the first iteration
                case SubCall():
                    sub = self.subs[node.end.target]
                    if sub.has_checks:
                        # The checks inside cannot cover what follows the call, so it gets its own check.
                        nodes.insert(place + 1, Check(node.end.back, need))
                        need = 0
                        routine.has_checks = True
                    need += 1 + sub.need
                case Check():
                    need = 0
                case _:
                    need += node.cost
                    # The exit of a check has no pending words, so it is possible only where the stack is empty.
                    if need > _CHECK_EVERY and not isinstance(node, Charge) and not node.place.pending:
                        nodes.insert(place, Check(node.place.pc, need))
                        need = 0
                        routine.has_checks = True
        return need
