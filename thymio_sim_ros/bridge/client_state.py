"""What one client has asked for: an immutable value that is replaced, never edited."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from thymio_sim_ros.bridge.graph import ConnectionGraph
from thymio_sim_ros.bridge.messages import ClientChannel


@dataclass(frozen=True, slots=True)
class ClientState:
    """Ids are the client's own; `graph` is the connection graph it has been told, None: it did not ask."""

    subscriptions: Mapping[int, int] = field(default_factory=dict)
    """Subscription id → channel id."""
    ended: Mapping[int, None] = field(default_factory=dict)
    """Subscription ids that ended because their channels vanished, the latest last."""
    channels: Mapping[int, ClientChannel] = field(default_factory=dict)
    parameters: frozenset[str] = frozenset()
    graph: ConnectionGraph | None = None
    calls: int = 0
    """Service calls without an answer."""
    wishes: int = 0
    """Requests to get or to set parameters without an answer."""
    open_size: int = 0
    """Bytes of all these."""
    is_read_only: bool = False
    """Whether it may watch and nothing else."""
