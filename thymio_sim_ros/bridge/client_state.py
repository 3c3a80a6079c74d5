"""The requests of one client: an immutable value that is replaced, never modified."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from thymio_sim_ros.bridge.graph import ConnectionGraph
from thymio_sim_ros.bridge.messages import ClientChannel


@dataclass(frozen=True, slots=True)
class ClientState:
    """State of a client. IDs are chosen by the client; `graph` is the last graph sent, None without a subscription."""

    subscriptions: Mapping[int, int] = field(default_factory=dict)
    """Subscription id → channel id."""
    ended: Mapping[int, None] = field(default_factory=dict)
    """Subscription ids that ended because their channels vanished, the latest last."""
    channels: Mapping[int, ClientChannel] = field(default_factory=dict)
    parameters: frozenset[str] = frozenset()
    graph: ConnectionGraph | None = None
    calls: int = 0
    """Service calls without an answer."""
    parameter_requests: int = 0
    """Requests to get or to set parameters without an answer."""
    open_size: int = 0
    """Bytes of all these."""
    is_read_only: bool = False
    """Whether it may only subscribe and read."""
