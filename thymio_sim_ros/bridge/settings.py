"""The limits and options of a server, and the receiver of its events."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Protocol

from thymio_sim_ros.access import Tokens
from thymio_sim_ros.bridge.switchboard.events import Event

__all__ = ["REFUSED_FACTOR", "EventSink", "ServerSettings"]

REFUSED_FACTOR = 4
"""Longest frame that is answered, in `max_message_size`: it has to be buffered."""


class EventSink(Protocol):
    """Receiver of events; called in the event loop, must not block."""

    def is_full(self, client: int) -> bool:
        """Whether too many events of this client are pending; the server then stops reading from it."""

    def post(self, event: Event) -> None:
        """Accept an event."""


@dataclass(frozen=True, slots=True)
class ServerSettings:
    """Limits and options of a server."""

    allowed_origins: tuple[str, ...] = ()
    """Additional origins of web pages (see `access.origins`); `*` allows all."""
    buffer_limit: int = 1 << 20
    """Bytes that may be buffered for a client before data frames are dropped."""
    max_message_size: int = 4 << 20
    """Size of the longest frame accepted from a client, bytes. One of up to `REFUSED_FACTOR` times that is answered
    with the reason, a longer one ends the connection."""
    max_clients: int = 128
    """Maximum number of clients."""
    heartbeat_s: float = 30.0
    """Time without a message after which a client is pinged; it has half of this time to answer, s."""
    tokens: Tokens = field(default_factory=Tokens)
    is_read_only_service: Callable[[str], bool] = lambda service: False
    """Whether a read-only client may call a service, by name."""
