"""The ROS graph as the bridge offers it: visible names, and the connection graph."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence

from rclpy.node import Node, NodeNameNonExistentError
from rclpy.topic_endpoint_info import TopicEndpointInfo

from thymio_sim_ros.bridge.protocol.connection_graph import ConnectionGraph

__all__ = [
    "allow_list",
    "connection_graph",
    "is_parameter_service",
    "services_with_servers",
    "visible",
    "visible_topics",
]

_PARAMETER_SERVICE = re.compile(
    r"/(describe_parameters|get_parameter_types|get_parameters|list_parameters|set_parameters|"
    r"set_parameters_atomically|get_type_description|get_logger_levels|set_logger_levels)$"
)
_NO_NODES = "_NODE_NAME_UNKNOWN_"


def allow_list(patterns: Iterable[str]) -> Callable[[str], bool]:
    """Return a test whether a whole name matches one of the regular expressions; empty ones are ignored."""
    compiled = [re.compile(pattern) for pattern in patterns if pattern]
    return lambda name: any(pattern.fullmatch(name) for pattern in compiled)


def is_parameter_service(name: str) -> bool:
    """Whether a service is one that every node has, for parameters, types and log levels."""
    return _PARAMETER_SERVICE.search(name) is not None


def services_with_servers(node: Node) -> dict[str, Sequence[str]]:
    """The services of the graph that have a server.

    The middleware's list also has services with clients only; the bridge's own clients would keep them there for ever.
    """
    return {name: types for name, types in node.get_service_names_and_types() if node.count_services(name)}


def visible(
    names: Mapping[str, Sequence[str]], is_allowed: Callable[[str], bool], *, hidden: bool
) -> dict[str, Sequence[str]]:
    """Allowed names; hidden ones (a part begins with `_`, such as those of actions) only if `hidden` is true."""
    return {name: types for name, types in names.items() if (hidden or "/_" not in name) and is_allowed(name)}


def visible_topics(
    names: Mapping[str, Sequence[str]], is_allowed: Callable[[str], bool], *, hidden: bool
) -> dict[str, Sequence[str]]:
    """Allowed topics, including hidden ones; those of actions only if `hidden` is true."""
    return {name: types for name, types in names.items() if (hidden or "/_action/" not in name) and is_allowed(name)}


def connection_graph(node: Node, topics: Iterable[str], services: Iterable[str]) -> ConnectionGraph:
    """The publishers, subscribers and servers of the given topics and services.

    Nodes are queried rather than topics, because there are far fewer of them.
    """
    topics, wanted = list(topics), set(services)
    nodes = node.get_node_names_and_namespaces()
    distinct = set(nodes)
    publishers, subscribers, providers = (_NodesByName(names) for names in (topics, topics, wanted))
    for name, namespace in distinct:
        try:
            publishers.add(name, namespace, node.get_publisher_names_and_types_by_node(name, namespace))
            subscribers.add(name, namespace, node.get_subscriber_names_and_types_by_node(name, namespace))
            providers.add(name, namespace, node.get_service_names_and_types_by_node(name, namespace))
        except NodeNameNonExistentError:
            continue  # the node has just ended
    if len(distinct) < len(nodes):  # of several nodes with one name only one is reported
        for topic in topics:
            publishers.add_all(topic, node.get_publishers_info_by_topic(topic))
            subscribers.add_all(topic, node.get_subscriptions_info_by_topic(topic))
    return ConnectionGraph(publishers.sorted(), subscribers.sorted(), providers.sorted())


class _NodesByName:
    """Node names by the topics or services that they use, for given topics or services."""

    def __init__(self, names: Iterable[str]) -> None:
        self._nodes: dict[str, set[str]] = {name: set() for name in names}

    def add(self, name: str, namespace: str, used: Iterable[tuple[str, Sequence[str]]]) -> None:
        """Add a node that uses these (name, types)."""
        for topic, _ in used:
            if topic in self._nodes:
                self._nodes[topic].add(_full(name, namespace))

    def add_all(self, topic: str, infos: Iterable[TopicEndpointInfo]) -> None:
        """Add the nodes of all endpoints of a topic."""
        self._nodes[topic].update(
            _full(info.node_name, info.node_namespace) for info in infos if info.node_name != _NO_NODES
        )

    def sorted(self) -> dict[str, tuple[str, ...]]:
        """Sorted node names by name; names without nodes are left out."""
        return {name: tuple(sorted(nodes)) for name, nodes in self._nodes.items() if nodes}


def _full(name: str, namespace: str) -> str:
    return f"{namespace.rstrip('/')}/{name}"
