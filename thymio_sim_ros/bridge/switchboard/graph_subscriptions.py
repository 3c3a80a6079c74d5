"""The connection graph of the data source and the clients that subscribe to it."""

from __future__ import annotations

from collections.abc import Mapping

from thymio_sim_ros.bridge.protocol.connection_graph import ConnectionGraph
from thymio_sim_ros.bridge.protocol.messages import ConnectionGraphUpdate
from thymio_sim_ros.bridge.switchboard.client_state import ClientState
from thymio_sim_ros.bridge.switchboard.events import GraphSubscriptionChanged
from thymio_sim_ros.bridge.switchboard.outcome import Delivery, Outcome

__all__ = ["GraphSubscriptions"]


class GraphSubscriptions:
    """Sends each subscriber the whole graph first and then differences."""

    def __init__(self, clients: Mapping[int, ClientState]) -> None:
        self._clients = clients
        self._graph = ConnectionGraph()

    def subscribe(self, client: ClientState, outcome: Outcome) -> None:
        """Subscribe a client and send it the whole graph; a second subscription has no effect."""
        if client.graph is not None:
            return
        if self._has_no_subscriber():
            outcome.events.append(GraphSubscriptionChanged(True))
        update = self._graph.since(ConnectionGraph())
        if update is not None:
            outcome.send(update)
        client.graph = self._graph

    def unsubscribe(self, client: ClientState, outcome: Outcome) -> None:
        """End the subscription of a client, if it has one; the client may have disconnected."""
        if client.graph is not None:
            client.graph = None
            if self._has_no_subscriber():
                outcome.events.append(GraphSubscriptionChanged(False))

    def set_graph(self, graph: ConnectionGraph) -> list[Delivery]:
        """Set the current graph; return the difference to the graph that each subscriber knows."""
        self._graph = graph
        # Most subscribers know the same graph object, so each difference is computed once per object. The list
        # keeps the objects alive: the ID of a deleted object could be used again.
        known = [(client, client.graph) for client in self._clients.values() if client.graph is not None]
        updates: dict[int, ConnectionGraphUpdate | None] = {}
        deliveries = []
        for client, earlier in known:
            if id(earlier) not in updates:
                updates[id(earlier)] = graph.since(earlier)
            update = updates[id(earlier)]
            if update is not None:
                client.graph = graph
                deliveries.append(Delivery((client.id,), update))
        return deliveries

    def resend(self) -> list[Delivery]:
        """The whole graph for all subscribers, which lost it with the last session."""
        for client in self._clients.values():
            if client.graph is not None:
                client.graph = ConnectionGraph()
        return self.set_graph(self._graph)

    def _has_no_subscriber(self) -> bool:
        return all(client.graph is None for client in self._clients.values())
