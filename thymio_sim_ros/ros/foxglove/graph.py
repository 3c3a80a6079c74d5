"""The ROS graph as the bridge shows it: names to offer, and who talks to whom."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence

from rclpy.node import Node, NodeNameNonExistentError
from rclpy.topic_endpoint_info import TopicEndpointInfo

from thymio_sim_ros.bridge.protocol.connection_graph import ConnectionGraph

__all__ = ["allow_list", "connection_graph", "is_parameter_service", "visible", "visible_topics"]

_PARAMETER_SERVICE = re.compile(
    r"/(describe_parameters|get_parameter_types|get_parameters|list_parameters|set_parameters|"
    r"set_parameters_atomically|get_type_description|get_logger_levels|set_logger_levels)$"
)
_NO_NODES = "_NODE_NAME_UNKNOWN_"


def allow_list(patterns: Iterable[str]) -> Callable[[str], bool]:
    """A test whether a name matches one of the regular expressions as a whole; empty ones do not count."""
    compiled = [re.compile(pattern) for pattern in patterns if pattern]
    return lambda name: any(pattern.fullmatch(name) for pattern in compiled)


def is_parameter_service(name: str) -> bool:
    """Whether it is one of the services that every node has."""
    return _PARAMETER_SERVICE.search(name) is not None


def visible(
    names: Mapping[str, Sequence[str]], is_allowed: Callable[[str], bool], *, hidden: bool
) -> dict[str, Sequence[str]]:
    """What to offer: allowed, and without hidden names (a part begins with `_`, as those of actions) unless wanted."""
    return {name: types for name, types in names.items() if (hidden or "/_" not in name) and is_allowed(name)}


def visible_topics(
    names: Mapping[str, Sequence[str]], is_allowed: Callable[[str], bool], *, hidden: bool
) -> dict[str, Sequence[str]]:
    """Topics to offer: those with hidden names too, since a viewer is a tool; those of actions only if wanted."""
    return {name: types for name, types in names.items() if (hidden or "/_action/" not in name) and is_allowed(name)}


def connection_graph(node: Node, topics: Iterable[str], services: Iterable[str]) -> ConnectionGraph:
    """Who publishes, subscribes and answers the named topics and services.

    Nodes are asked, not topics: they are far fewer.
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
            continue  # it has just left
    if len(distinct) < len(nodes):  # of nodes of one name only one answers
        for topic in topics:
            publishers.add_all(topic, node.get_publishers_info_by_topic(topic))
            subscribers.add_all(topic, node.get_subscriptions_info_by_topic(topic))
    return ConnectionGraph(publishers.sorted(), subscribers.sorted(), providers.sorted())


class _NodesByName:
    """Nodes by the names that they use, of which some are wanted."""

    def __init__(self, wanted: Iterable[str]) -> None:
        self._nodes: dict[str, set[str]] = {name: set() for name in wanted}

    def add(self, name: str, namespace: str, used: Iterable[tuple[str, Sequence[str]]]) -> None:
        """A node uses these names, which come with their types."""
        for topic, _ in used:
            if topic in self._nodes:
                self._nodes[topic].add(_full(name, namespace))

    def add_all(self, topic: str, infos: Iterable[TopicEndpointInfo]) -> None:
        """All who use one of them."""
        self._nodes[topic].update(
            _full(info.node_name, info.node_namespace) for info in infos if info.node_name != _NO_NODES
        )

    def sorted(self) -> dict[str, tuple[str, ...]]:
        """As a graph has it: without names that nobody uses."""
        return {name: tuple(sorted(nodes)) for name, nodes in self._nodes.items() if nodes}


def _full(name: str, namespace: str) -> str:
    return f"{namespace.rstrip('/')}/{name}"
