"""What connects the ROS graph of a test with those of its programs, turn by turn."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol

from rclpy.context import Context

from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.lockstep.graph_link import GraphLink, LinkHub

__all__ = ["BrokenLinkError", "Connected", "Connection", "Connections", "LinkedGraphs"]


class BrokenLinkError(ThymioSimError):
    """A program has sent what is no change of a graph: it has written to the connection itself."""


class Connected(Protocol):
    """A program that is connected."""

    @property
    def is_running(self) -> bool:
        """Whether it has not ended."""

    def ask(self, message: dict[str, Any], until: str) -> None:
        """Send a message between turns, and wait for an event."""


class Connection(Protocol):
    """The connection with one program."""

    @property
    def has_news(self) -> bool:
        """Whether the program may have to take something, so that it needs a turn."""

    def begin_turn(self) -> dict[str, Any]:
        """What the message that begins a turn has."""

    def receive(self, event: Mapping[str, Any]) -> None:
        """Take what a message of the program has."""

    def answer(self) -> dict[str, Any]:
        """Wait until the endpoints of all processes but this one are matched; return the answer to its question."""

    def end_turn(self) -> None:
        """Wait until all that the program has sent is here."""

    def close(self) -> None:
        """Note that the program has ended."""


class Connections(Protocol):
    """The connections of a test with all of its programs."""

    is_embedded: bool
    """Whether programs are on the embedded graph."""

    def add(self, program: Connected) -> Connection:
        """Connect a program."""

    def settle(self) -> None:
        """Wait until the endpoints of all processes are matched."""

    def close(self) -> None:
        """Release everything."""


class LinkedGraphs:
    """Programs on the embedded graph: their graphs are linked with that of the test."""

    is_embedded = True

    def __init__(self, context: Context) -> None:
        self._hub = LinkHub(context.graph)

    def add(self, _program: Connected) -> Connection:
        """Connect a program."""
        return _LinkedProgram(self._hub)

    def settle(self) -> None:
        """Need nothing: endpoints match when they appear."""

    def close(self) -> None:
        """Link no more programs."""
        self._hub.graph.attach(None)


class _LinkedProgram:
    """The link with one program."""

    def __init__(self, hub: LinkHub) -> None:
        self._link = GraphLink(hub)

    @property
    def has_news(self) -> bool:
        """Whether there are changes or messages for it."""
        return self._link.has_news

    def begin_turn(self) -> dict[str, Any]:
        """What has changed for the program."""
        return {"changes": self._link.take()}

    def receive(self, event: Mapping[str, Any]) -> None:
        """Apply what the program has changed. Raises BrokenLinkError."""
        try:
            self._link.apply(event["changes"])
        except (KeyError, TypeError, ValueError) as error:
            raise BrokenLinkError(f"the program has written to its connection with the test: {error}") from error

    def answer(self) -> dict[str, Any]:
        """Need nothing."""
        return {}

    def end_turn(self) -> None:
        """Need nothing: messages come with the end of the turn."""

    def close(self) -> None:
        """Remove the nodes of the program."""
        self._link.close()
