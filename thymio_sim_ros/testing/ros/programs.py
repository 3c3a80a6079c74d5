"""Programs: the programs of a test, their turns, and the barrier between their processes and this one."""

from __future__ import annotations

import contextlib
from collections import Counter
from collections.abc import Callable, Mapping, Sequence

import pytest
from rclpy.context import Context
from rclpy.node import Node

from thymio_sim_ros.lockstep import real_time
from thymio_sim_ros.lockstep.barrier import Barrier
from thymio_sim_ros.lockstep.matching import endpoints, is_complete
from thymio_sim_ros.testing.ros.program import INTERRUPTED_NS, Program
from thymio_sim_ros.testing.ros.program_files import Target

__all__ = ["Programs"]

KINDS = ("publishers", "subscriptions", "services", "clients")


class Programs:
    """The programs of a test, in the order in which they were started. Only one process runs at a time."""

    def __init__(self, context: Context, nodes: Callable[[], Sequence[Node]]) -> None:
        """`nodes()`: the nodes of this process."""
        self._context = context
        self._nodes = nodes
        self._barrier: Barrier | None = None
        self._programs: list[Program] = []

    def start(
        self,
        program: Program,
        target: Target,
        arguments: Sequence[str],
        *,
        stdin: str | Sequence[tuple[float, str]] | None,
        now_ns: int,
    ) -> None:
        """Start a program and give it its first turn, in which no simulated time passes."""
        __tracebackhide__ = True
        if self._barrier is None:
            self._barrier = Barrier(self._context, "test")
        self._programs.append(program)
        options = {**target.options, "name": f"program_{len(self._programs)}", "arguments": list(arguments)}
        program.start(options, stdin=stdin, now_ns=now_ns)
        self.take_turn(program, now_ns)

    @property
    def running(self) -> list[Program]:
        """Programs that have not ended."""
        return [program for program in self._programs if program.is_running]

    def __len__(self) -> int:
        return len(self._programs)

    def take_turns(self, until_ns: int) -> None:
        """Give each program a turn until this simulated time."""
        __tracebackhide__ = True
        for program in self.running:
            self.take_turn(program, until_ns)

    def take_turn(self, program: Program, until_ns: int, *, interrupt: bool = False) -> None:
        """Give a program a turn: all messages of others have arrived before it, all of its own after it."""
        __tracebackhide__ = True
        barrier = self._barrier
        assert barrier is not None
        barrier.mark()
        marks = {barrier.source: barrier.sent}
        for other in self._programs:
            if other is not program:
                marks |= other.marks
        program.take_turn(until_ns, marks, lambda: self.settle(without=program), interrupt=interrupt)
        barrier.wait(program.marks)

    def settle(self, without: Program | None = None) -> Mapping[str, Mapping[str, int]]:
        """Wait until all endpoints of all processes but one are matched; return the numbers of all endpoints."""
        assert self._barrier is not None
        nodes = [self._barrier.node, *self._nodes()]
        expected = _sum([endpoints(nodes), *(program.endpoints for program in self.running)])
        real_time.wait_for(lambda: is_complete(nodes, expected), "publishers and subscriptions to find each other")
        for program in self.running:
            if program is not without:
                program.match(expected)
        return expected

    def stop(self, program: Program, now_ns: int) -> None:
        """Interrupt a program as Ctrl-C does, and kill it if it has not ended soon."""
        if not program.is_running:
            return
        with contextlib.suppress(pytest.fail.Exception, real_time.NotAnsweredError):
            self.take_turn(program, now_ns + INTERRUPTED_NS, interrupt=True)
        program.kill()

    def lines(self) -> list[str]:
        """Describe all programs, one line or more for each."""
        return [line for program in self._programs for line in program.lines()]

    def close(self, now_ns: int) -> None:
        """Stop all programs."""
        with contextlib.ExitStack() as end:
            if self._barrier is not None:
                end.callback(self._barrier.node.destroy_node)
            for program in self._programs:
                end.callback(program.close)
                end.callback(self.stop, program, now_ns)


def _sum(parts: Sequence[Mapping[str, Mapping[str, int]]]) -> dict[str, dict[str, int]]:
    numbers = {kind: Counter[str]() for kind in KINDS}
    for part in parts:
        for kind, counted in part.items():
            numbers[kind].update(counted)
    return {kind: dict(counted) for kind, counted in numbers.items()}
