"""What connects the graph of this process with a graph elsewhere."""

from __future__ import annotations

from typing import Protocol

from thymio_sim_ros.portable_ros.graph.protocols import PublisherEnd, Sample

__all__ = ["Transport"]


class Transport(Protocol):
    """Shows the nodes of this process elsewhere, and adds nodes from there to the graph.

    Remote nodes and endpoints (`remote_ends.py`) are members of the graph like all others, so that queries, matches and
    waits need to know nothing of it. A remote service gets requests by `ServiceEnd.receive`. The transport passes
    messages to `SubscriptionEnd.receive`, and requests to `ServiceEnd.receive` with its own clients.
    """

    @property
    def is_connected(self) -> bool:
        """Whether it carries messages: then it delivers them to the subscriptions of this process, too."""

    def graph_changed(self) -> None:
        """Note that nodes or endpoints have changed; called with the lock of the graph, must not wait."""

    def publish(self, publisher: PublisherEnd, sample: Sample) -> bool:
        """Carry a message of a publisher of this process; return whether that is done, False without a connection."""
