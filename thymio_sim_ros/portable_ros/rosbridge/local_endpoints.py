"""The nodes and endpoints of this process, and which of them a server knows."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

from thymio_sim_ros.portable_ros.graph.graph import Graph
from thymio_sim_ros.portable_ros.graph.protocols import GraphNode
from thymio_sim_ros.portable_ros.graph.remote_ends import Kind
from thymio_sim_ros.portable_ros.messages.taught_packages import definitions_for
from thymio_sim_ros.portable_ros.rclpy.qos import DurabilityPolicy
from thymio_sim_ros.portable_ros.rosbridge.operations import Operation, qos_of

__all__ = ["Announcements", "LocalEndpoint"]

_ANNOUNCE = {Kind.PUBLISHER: "advertise", Kind.SUBSCRIPTION: "subscribe", Kind.SERVICE: "advertise_service"}
_WITHDRAW = {Kind.PUBLISHER: "unadvertise", Kind.SUBSCRIPTION: "unsubscribe", Kind.SERVICE: "unadvertise_service"}
_RAW = "cbor-raw"


class LocalEndpoint(NamedTuple):
    """An endpoint of this process with its node, None if that is gone."""

    kind: Kind
    end: Any
    name: str
    type_name: str
    node: GraphNode | None


class Announcements:
    """Tells a server about the nodes and endpoints of this process. Its ids are those of the operations."""

    def __init__(self, graph: Graph, is_remote: Callable[[object], bool], *, is_extended: bool) -> None:
        """`is_remote`: whether a node is a remote one; `is_extended`: whether the server knows nodes and QoS."""
        self._graph, self._is_remote, self._is_extended = graph, is_remote, is_extended
        self._numbers = itertools.count(1)
        self._nodes: dict[int, tuple[GraphNode, str]] = {}
        """Nodes with their ids, by identity; they are kept, so that no other object gets the same identity."""
        self._ends: dict[int, tuple[LocalEndpoint, str]] = {}
        self._by_id: dict[str, LocalEndpoint] = {}
        self._packages: set[str] = set()
        """Packages of this program whose definitions the server has."""

    def added(self) -> Iterator[tuple[Operation, LocalEndpoint | None]]:
        """The operations for new nodes and endpoints, each with its endpoint, and before it the types that it needs."""
        nodes, ends = self._present()
        for key, node in nodes.items():
            if key not in self._nodes:
                self._nodes[key] = (node, f"node{next(self._numbers)}")
                if self._is_extended:
                    name, namespace = node.get_name(), node.get_namespace()
                    yield {"op": "node", "id": self._nodes[key][1], "name": name, "namespace": namespace}, None
        for key, endpoint in ends.items():
            if key not in self._ends:
                wire_id = f"{endpoint.kind.value}{next(self._numbers)}"
                self._ends[key] = (endpoint, wire_id)
                self._by_id[wire_id] = endpoint
                if self._is_extended:
                    for package, texts in definitions_for(endpoint.type_name.partition("/")[0], self._packages):
                        yield {"op": "interfaces", "package": package, "texts": dict(texts)}, None
                yield self._announcement(endpoint, wire_id), endpoint

    def removed(self) -> Iterator[Operation]:
        """The operations for nodes and endpoints that are gone."""
        nodes, ends = self._present()
        for key in [key for key in self._ends if key not in ends]:
            endpoint, wire_id = self._ends.pop(key)
            del self._by_id[wire_id]
            yield self._operation(_WITHDRAW[endpoint.kind], endpoint, wire_id)
        for key in [key for key in self._nodes if key not in nodes]:
            wire_id = self._nodes.pop(key)[1]
            if self._is_extended:
                yield {"op": "remove_node", "id": wire_id}

    def endpoint(self, wire_id: object) -> LocalEndpoint | None:
        """The endpoint of an id."""
        return self._by_id.get(wire_id) if isinstance(wire_id, str) else None

    def named(self, kind: Kind, name: str) -> list[LocalEndpoint]:
        """The endpoints of a topic or a service."""
        return [one for one in self._by_id.values() if one.kind is kind and one.name == name]

    def place_of(self, end: object) -> Operation:
        """The fields by which operations name an endpoint; none if the server does not know it."""
        found = self._ends.get(id(end))
        return self._place(*found) if found else {}

    def id_of_node(self, node: object) -> str | None:
        """The id of a node; None if the server does not know it."""
        found = self._nodes.get(id(node))
        return found[1] if found else None

    def names(self) -> set[tuple[Kind, str]]:
        """Kinds and names of all endpoints."""
        return {(one.kind, one.name) for one in self._by_id.values()}

    def _present(self) -> tuple[dict[int, GraphNode], dict[int, LocalEndpoint]]:
        """The nodes and endpoints of this process, by identity."""
        with self._graph.lock:
            nodes = {id(node): node for node in self._graph.nodes if not self._is_remote(node)}
            owners = {
                id(end): node
                for node in nodes.values()
                for end in (*node.all_publishers, *node.all_subscriptions, *node.all_services)
            }
            ends = [
                LocalEndpoint(kind, end, name, end_type, owners[id(end)])
                for kind, name, end, end_type in self._all_endpoints()
                if id(end) in owners
            ]
        return nodes, {id(one.end): one for one in ends}

    def _all_endpoints(self) -> Iterator[tuple[Kind, str, Any, str]]:
        """The endpoints of the graph, with their kinds, names and types."""
        for name, topic in self._graph.topics.items():
            yield from ((Kind.PUBLISHER, name, end, end.msg_type.TYPE_NAME) for end in topic.publishers)
            yield from ((Kind.SUBSCRIPTION, name, end, end.msg_type.TYPE_NAME) for end in topic.subscriptions)
        for name, services in self._graph.services.items():
            yield from ((Kind.SERVICE, name, end, end.srv_type.TYPE_NAME) for end in services)

    def _announcement(self, endpoint: LocalEndpoint, wire_id: str) -> Operation:
        operation = self._operation(_ANNOUNCE[endpoint.kind], endpoint, wire_id)
        operation["type"] = endpoint.type_name
        if endpoint.kind is not Kind.PUBLISHER and (self._is_extended or endpoint.kind is Kind.SUBSCRIPTION):
            operation["compression"] = _RAW
        if endpoint.kind is Kind.SERVICE:
            return operation
        profile = endpoint.end.qos_profile
        if self._is_extended:
            return operation | {"qos": qos_of(profile)}
        if endpoint.kind is Kind.PUBLISHER:
            operation["queue_size"] = profile.kept or 0
            operation["latch"] = profile.durability == DurabilityPolicy.TRANSIENT_LOCAL
        return operation

    def _operation(self, op: str, endpoint: LocalEndpoint, wire_id: str) -> Operation:
        place = "service" if endpoint.kind is Kind.SERVICE else "topic"
        return {"op": op, place: endpoint.name, **self._place(endpoint, wire_id)}

    def _place(self, endpoint: LocalEndpoint, wire_id: str) -> Operation:
        return {"id": wire_id, **({"node": self.id_of_node(endpoint.node)} if self._is_extended else {})}
