"""Connections with programs on an installed ROS 2: a barrier in DDS at each turn, and waits for its discovery."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from rclpy.context import Context
from rclpy.node import Node

from thymio_sim_ros.lockstep import real_time
from thymio_sim_ros.lockstep.installed_ros.barrier import Barrier
from thymio_sim_ros.lockstep.matching import endpoints, is_complete
from thymio_sim_ros.testing.ros.connections import Connected, Connection

__all__ = ["InstalledRos"]

KINDS = ("publishers", "subscriptions", "services", "clients")


class InstalledRos:
    """The connections of a test with all of its programs."""

    is_embedded = False

    def __init__(self, context: Context, nodes: Callable[[], Sequence[Node]]) -> None:
        """`nodes()`: the nodes of this process."""
        self.barrier = Barrier(context, "test")
        self.programs: list[_InstalledProgram] = []
        self._nodes = nodes

    def add(self, program: Connected) -> Connection:
        """Connect a program."""
        made = _InstalledProgram(self, program)
        self.programs.append(made)
        return made

    def settle(self) -> None:
        """Wait until all endpoints of all processes are matched."""
        self.match_all(without=None)

    def match_all(self, without: _InstalledProgram | None) -> Mapping[str, Mapping[str, int]]:
        """Wait until all endpoints of all processes but one are matched; return the numbers of all endpoints."""
        nodes = [self.barrier.node, *self._nodes()]
        expected = _sum([endpoints(nodes), *(program.endpoints for program in self.programs)])
        real_time.wait_for(lambda: is_complete(nodes, expected), "publishers and subscriptions to find each other")
        for one in self.programs:
            if one is not without and one.program.is_running:
                one.program.ask({"match": expected}, "matched")
        return expected

    def close(self) -> None:
        """Destroy the node of the barrier."""
        self.barrier.node.destroy_node()


class _InstalledProgram:
    """The connection with one program."""

    has_news = True
    """Always: messages of DDS cannot be seen before they are taken."""

    def __init__(self, of: InstalledRos, program: Connected) -> None:
        self._of, self.program = of, program
        self.marks: dict[str, int] = {}
        self.endpoints: Mapping[str, Mapping[str, int]] = {}

    def begin_turn(self) -> dict[str, Any]:
        """The marks before which all messages must have arrived."""
        barrier = self._of.barrier
        barrier.mark()
        marks = {barrier.source: barrier.sent}
        for other in self._of.programs:
            if other is not self:
                marks |= other.marks
        return {"marks": marks}

    def receive(self, event: Mapping[str, Any]) -> None:
        """Take marks and endpoints."""
        if event["event"] != "settle":  # a mark of an endpoint that is not matched yet does not arrive
            self.marks.update(event.get("marks", {}))
        self.endpoints = event.get("endpoints", self.endpoints)

    def answer(self) -> dict[str, Any]:
        """Wait until all endpoints of the other processes are matched; return the numbers of all."""
        return {"match": self._of.match_all(without=self)}

    def end_turn(self) -> None:
        """Wait until all that the program has published is here."""
        self._of.barrier.wait(self.marks)

    def close(self) -> None:
        """Expect no endpoints of the program."""
        self.endpoints = {}


def _sum(parts: Sequence[Mapping[str, Mapping[str, int]]]) -> dict[str, dict[str, int]]:
    numbers = {kind: Counter[str]() for kind in KINDS}
    for part in parts:
        for kind, counted in part.items():
            numbers[kind].update(counted)
    return {kind: dict(counted) for kind, counted in numbers.items()}
