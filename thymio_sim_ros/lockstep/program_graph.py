"""The ROS graph of a program under test, as its session needs it, and the embedded one."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, Protocol

from thymio_sim_ros.lockstep.clocks import EPOCH_NS, UPTIME_NS
from thymio_sim_ros.lockstep.graph_link import GraphLink, LinkHub
from thymio_sim_ros.lockstep.turns import Turns
from thymio_sim_ros.portable_ros import import_hook
from thymio_sim_ros.portable_ros.graph import time_base, waits
from thymio_sim_ros.portable_ros.graph.graph import graph_of

__all__ = ["EmbeddedGraph", "ProgramGraph"]


class ProgramGraph(Protocol):
    """The graph of the process of a program."""

    has_new: bool
    """Whether there are endpoints that may not be matched yet."""

    def outgoing(self, event: str) -> dict[str, Any]:
        """What a message to the test has."""

    def receive(self, message: Mapping[str, Any]) -> None:
        """Take what the message that begins a turn has."""

    def match(self, expected: Mapping[str, Mapping[str, int]]) -> None:
        """Wait until all endpoints are matched with those of all processes."""

    def leave_test(self) -> None:
        """Exchange nothing more: this process was forked by the program."""


class EmbeddedGraph:
    """The embedded graph, linked with that of the test. Its clocks and waits have the time of the turns."""

    has_new = False

    def __init__(self, turns: Turns) -> None:
        import_hook.install(is_forced=True)
        time_base.give_to(_TurnTime(turns))
        waits.watch(_NamedWaits(turns))
        self._link = GraphLink(LinkHub(graph_of(int(os.environ.get("ROS_DOMAIN_ID") or 0))))

    def outgoing(self, event: str) -> dict[str, Any]:
        """What has changed since the last message."""
        return {"changes": self._link.take()}

    def receive(self, message: Mapping[str, Any]) -> None:
        """Apply what has changed in the graph of the test."""
        self._link.apply(message["changes"])

    def match(self, expected: Mapping[str, Mapping[str, int]]) -> None:
        """Need nothing: endpoints match when they appear."""

    def leave_test(self) -> None:
        """Exchange nothing more."""
        self._link.cut()


class _NamedWaits:
    """Names the waits of threads, for reports on the program."""

    def __init__(self, turns: Turns) -> None:
        self._turns = turns

    def begin(self, wait: waits.Wait) -> None:
        """Name a wait."""
        self._turns.name_wait(str(wait))

    def end(self, _wait: waits.Wait) -> None:
        """Name no more waits."""
        self._turns.name_wait("")


class _TurnTime:
    """The time of the turns, as the time of this process."""

    def __init__(self, turns: Turns) -> None:
        self._turns = turns
        self.note_query = turns.poll

    def system_ns(self) -> int:
        """Time since 1970."""
        return EPOCH_NS + self._turns.now_ns

    def steady_ns(self) -> int:
        """Time of a clock that is never set."""
        return UPTIME_NS + self._turns.now_ns

    def simulated_ns(self) -> int:
        """Simulated time."""
        return self._turns.now_ns
