"""The graph for clients that follow it (the operation `graph`)."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any

from rclpy.node import Node, NodeNameNonExistentError

from thymio_sim_ros.ros.foxglove.rosbridge.qos_values import from_profile
from thymio_sim_ros.ros.foxglove.time_share import TimeShare

__all__ = ["GraphFeed"]

_SHARE = 0.02
"""Largest share of the thread's time for queries."""

Names = list[tuple[str, str]]
"""Names with their types."""


class GraphFeed:
    """All nodes with their endpoints, as the last query found them."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._share = TimeShare(_SHARE)
        self._found: dict[tuple[str, str], dict[str, Names]] = {}
        self._qos: dict[tuple[str, str], tuple[object, dict[tuple[str, str], Any]]] = {}
        """By kind and topic: the nodes that use it, and the QoS of each."""
        self.nodes: list[dict[str, Any]] = []
        """The graph for clients."""

    def update(self) -> bool:
        """Query the graph, unless that has used up its share of time; return whether it has changed."""
        if not self._share.is_due:
            return False
        with self._share.work():
            found = {key: endpoints for key in self._keys() if (endpoints := self._query(*key)) is not None}
            if found == self._found and self.nodes:
                return False
            self._found = found
            self.nodes = [self._described(key, endpoints) for key, endpoints in found.items()]
        return True

    def _keys(self) -> Iterable[tuple[str, str]]:
        return dict.fromkeys(self._node.get_node_names_and_namespaces())

    def _query(self, name: str, namespace: str) -> dict[str, Names] | None:
        """The endpoints of a node, None if it has just ended."""
        node = self._node
        try:
            return {
                "publishers": _pairs(node.get_publisher_names_and_types_by_node(name, namespace)),
                "subscriptions": _pairs(node.get_subscriber_names_and_types_by_node(name, namespace)),
                "services": _pairs(node.get_service_names_and_types_by_node(name, namespace)),
                "clients": _pairs(node.get_client_names_and_types_by_node(name, namespace)),
            }
        except NodeNameNonExistentError:
            return None

    def _described(self, key: tuple[str, str], endpoints: dict[str, Names]) -> dict[str, Any]:
        name, namespace = key
        queries = (
            ("publishers", self._node.get_publishers_info_by_topic),
            ("subscriptions", self._node.get_subscriptions_info_by_topic),
        )
        with_qos = {
            kind: [[topic, of, self._profile(kind, query, topic, key)] for topic, of in endpoints[kind]]
            for kind, query in queries
        }
        return {"name": name, "namespace": namespace, **endpoints, **with_qos}

    def _profile(self, kind: str, query: Callable[[str], Any], topic: str, key: tuple[str, str]) -> Any:
        """The QoS of an endpoint. A topic is queried again when other nodes use it."""
        users = [node for node, endpoints in self._found.items() if any(name == topic for name, _ in endpoints[kind])]
        known = self._qos.get((kind, topic))
        if known is None or known[0] != users:
            profiles = {(info.node_name, info.node_namespace): from_profile(info.qos_profile) for info in query(topic)}
            known = self._qos[kind, topic] = users, profiles
        return known[1].get(key, {})


def _pairs(names: Sequence[tuple[str, Sequence[str]]]) -> Names:
    return [(name, kind) for name, types in names for kind in types]
