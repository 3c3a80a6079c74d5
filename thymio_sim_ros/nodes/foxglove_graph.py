"""The ROS graph as the bridge shows it: names to offer, and who talks to whom."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence

from rclpy.node import Node
from rclpy.topic_endpoint_info import TopicEndpointInfo

from thymio_sim_ros.bridge.graph import ConnectionGraph

__all__ = ["allow_list", "connection_graph", "is_parameter_service", "visible"]

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


def connection_graph(node: Node, topics: Iterable[str], services: Iterable[str]) -> ConnectionGraph:
    """Who publishes, subscribes and answers the named topics and services."""
    topics = list(topics)
    wanted = set(services)
    providers: dict[str, set[str]] = {}
    for name, namespace in node.get_node_names_and_namespaces():
        for service, _ in node.get_service_names_and_types_by_node(name, namespace):
            if service in wanted:
                providers.setdefault(service, set()).add(_full(name, namespace))
    return ConnectionGraph(
        published={topic: names for topic in topics if (names := _names(node.get_publishers_info_by_topic(topic)))},
        subscribed={topic: names for topic in topics if (names := _names(node.get_subscriptions_info_by_topic(topic)))},
        services={service: tuple(sorted(names)) for service, names in sorted(providers.items())},
    )


def _names(infos: Sequence[TopicEndpointInfo]) -> tuple[str, ...]:
    return tuple(sorted({_full(info.node_name, info.node_namespace) for info in infos if info.node_name != _NO_NODES}))


def _full(name: str, namespace: str) -> str:
    return f"{namespace.rstrip('/')}/{name}"
