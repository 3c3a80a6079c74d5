"""Programs: the programs of a test, and their turns."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Sequence

import pytest
from rclpy.context import Context
from rclpy.node import Node

from thymio_sim_ros.lockstep import real_time
from thymio_sim_ros.portable_ros.import_hook import is_served
from thymio_sim_ros.testing.ros.connections import Connections, LinkedGraphs
from thymio_sim_ros.testing.ros.program import INTERRUPTED_NS, Program
from thymio_sim_ros.testing.ros.program_files import Target

__all__ = ["Programs"]


class Programs:
    """The programs of a test, in the order in which they were started. Only one process runs at a time."""

    def __init__(self, context: Context, nodes: Callable[[], Sequence[Node]]) -> None:
        """`nodes()`: the nodes of this process."""
        self._context = context
        self._nodes = nodes
        self._connections: Connections | None = None
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
        if self._connections is None:
            self._connections = self._made_connections()
        self._programs.append(program)
        name = f"program_{len(self._programs)}"
        options = {**target.options, "name": name, "arguments": list(arguments)}
        options["is_embedded"] = self._connections.is_embedded
        program.start(options, self._connections.add(program), stdin=stdin, now_ns=now_ns)
        program.take_turn(now_ns)

    def _made_connections(self) -> Connections:
        if is_served("rclpy"):
            return LinkedGraphs(self._context)
        from thymio_sim_ros.testing.ros.installed_connections import InstalledRos

        return InstalledRos(self._context, self._nodes)

    @property
    def running(self) -> list[Program]:
        """Programs that have not ended."""
        return [program for program in self._programs if program.is_running]

    def __len__(self) -> int:
        return len(self._programs)

    def take_turns(self, until_ns: int) -> None:
        """Give each program a turn until this simulated time.

        All messages of others have arrived before it, and all of its own after it.
        """
        __tracebackhide__ = True
        for program in self.running:
            program.take_turn(until_ns)

    def settle(self) -> None:
        """Wait until all endpoints of all processes are matched."""
        assert self._connections is not None
        self._connections.settle()

    def stop(self, program: Program, now_ns: int) -> None:
        """Interrupt a program as Ctrl-C does, and kill it if it has not ended soon."""
        if not program.is_running:
            return
        with contextlib.suppress(pytest.fail.Exception, real_time.NotAnsweredError):
            program.take_turn(now_ns + INTERRUPTED_NS, interrupt=True)
        program.kill()

    def lines(self) -> list[str]:
        """Describe all programs, one line or more for each."""
        return [line for program in self._programs for line in program.lines()]

    def close(self, now_ns: int) -> None:
        """Stop all programs."""
        with contextlib.ExitStack() as end:
            if self._connections is not None:
                end.callback(self._connections.close)
            for program in self._programs:
                end.callback(program.close)
                end.callback(self.stop, program, now_ns)
