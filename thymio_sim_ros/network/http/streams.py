"""Streams of events: who gets which."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from thymio_sim_ros.access import RefusedError
from thymio_sim_ros.network.http.nodes import Key
from thymio_sim_ros.network.http.replies import event_line
from thymio_sim_ros.network.http.requests import StreamEvents

__all__ = ["MAX_STREAMS", "Streams", "Subscription"]

MAX_STREAMS = 64
"""Open streams; further ones are rejected."""


@dataclass(eq=False, slots=True)
class Subscription:
    """A stream of events: of one node or all, with one name or all, `left` more of them (None: without end).

    `send` gets each event as bytes, and None after the last.
    """

    key: Key | None
    name: str | None
    left: int | None
    send: Callable[[bytes | None], None]


class Streams:
    """All open streams."""

    def __init__(self) -> None:
        """Create a set without streams."""
        self._open: dict[Subscription, None] = {}

    def __len__(self) -> int:
        return len(self._open)

    def open(self, key: Key | None, action: StreamEvents, send: Callable[[bytes | None], None]) -> Subscription:
        """Open a stream, until `close`. Raises RefusedError."""
        if len(self._open) >= MAX_STREAMS:
            raise RefusedError(503, f"{MAX_STREAMS} streams are open already; close one of them")
        stream = Subscription(key, action.name, action.limit, send)
        self._open[stream] = None
        return stream

    def close(self, stream: Subscription) -> None:
        """Close a stream; a second call has no effect."""
        self._open.pop(stream, None)

    def publish(self, key: Key, name: str, words: Sequence[int]) -> None:
        """Send an event of a node to the streams that want it."""
        line = event_line(name, words)
        for stream in list(self._open):
            if stream.key not in (None, key) or stream.name not in (None, name):
                continue
            stream.send(line)
            if stream.left is not None:
                stream.left -= 1
                if not stream.left:
                    self._end(stream)

    def end_of_network(self, number: int) -> None:
        """End the streams of nodes of a network that is gone; clients that wait for it ask again."""
        for stream in list(self._open):
            if stream.key is not None and stream.key[0] == number:
                self._end(stream)

    def _end(self, stream: Subscription) -> None:
        self.close(stream)
        stream.send(None)
