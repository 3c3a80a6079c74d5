"""The state of one client. Each part of the switchboard changes the fields of its own concern only."""

from __future__ import annotations

from dataclasses import dataclass, field

from thymio_sim_ros.access import Role
from thymio_sim_ros.bridge.protocol.connection_graph import ConnectionGraph
from thymio_sim_ros.bridge.protocol.messages import ClientChannel
from thymio_sim_ros.bridge.switchboard.pending_requests import PendingRequests

__all__ = ["ClientState"]


@dataclass(slots=True)
class ClientState:
    """A connected client. It chooses the IDs of its subscriptions and channels."""

    id: int
    role: Role = Role.FULL
    subscriptions: dict[int, int] = field(default_factory=dict)
    """Subscription ID → channel ID."""
    ended: dict[int, None] = field(default_factory=dict)
    """IDs of subscriptions that ended because their channels were removed, the latest last."""
    channels: dict[int, ClientChannel] = field(default_factory=dict)
    """Channels on which the client publishes."""
    parameters: frozenset[str] = frozenset()
    """Names of the parameters whose updates the client receives."""
    graph: ConnectionGraph | None = None
    """The connection graph that the client knows, None without a subscription."""
    pending: PendingRequests = field(default_factory=PendingRequests)

    @property
    def is_read_only(self) -> bool:
        """Whether the client may subscribe and read, but not change anything."""
        return self.role is Role.READ_ONLY
