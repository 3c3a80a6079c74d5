"""The queries of a node about the graph."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

from thymio_sim_ros.portable_ros.graph.graph import names_and_types
from thymio_sim_ros.portable_ros.graph.names import expanded, namespace_problem, node_problem
from thymio_sim_ros.portable_ros.graph.time_base import note_query
from thymio_sim_ros.portable_ros.messages.type_descriptions import HASH_PREFIX, type_hash
from thymio_sim_ros.portable_ros.rclpy._rclpy_pybind11 import NodeNameNonExistentError, RCLError
from thymio_sim_ros.portable_ros.rclpy.duration import Duration, Infinite
from thymio_sim_ros.portable_ros.rclpy.qos import LivelinessPolicy, QoSProfile
from thymio_sim_ros.portable_ros.rclpy.topic_endpoint_info import TopicEndpointInfo, TopicEndpointTypeEnum
from thymio_sim_ros.portable_ros.rclpy.type_hash import TypeHash
from thymio_sim_ros.portable_ros.rclpy.validate_full_topic_name import validate_full_topic_name
from thymio_sim_ros.portable_ros.rclpy_parts.node_base import NodeBase

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.graph.protocols import GraphNode

__all__ = ["NodeGraph"]

NamesAndTypes = list[tuple[str, list[str]]]

_GID_BYTES = 16
_NO_NODES = "Failed to get node names"


class NodeGraph(NodeBase):
    """The part of a node that looks at the graph."""

    def get_publisher_names_and_types_by_node(
        self, node_name: str, node_namespace: str, no_demangle: bool = False
    ) -> NamesAndTypes:
        """The topics that a node publishes. Raises NodeNameNonExistentError."""
        return self._of_node("publisher", node_name, node_namespace, lambda one: _topics(one.all_publishers))

    def get_subscriber_names_and_types_by_node(
        self, node_name: str, node_namespace: str, no_demangle: bool = False
    ) -> NamesAndTypes:
        """The topics that a node subscribes to. Raises NodeNameNonExistentError."""
        return self._of_node("subscriber", node_name, node_namespace, lambda one: _topics(one.all_subscriptions))

    def get_service_names_and_types_by_node(self, node_name: str, node_namespace: str) -> NamesAndTypes:
        """The services that a node offers. Raises NodeNameNonExistentError."""
        return self._of_node("service", node_name, node_namespace, lambda one: _services(one.all_services))

    def get_client_names_and_types_by_node(self, node_name: str, node_namespace: str) -> NamesAndTypes:
        """The services that a node calls. Raises NodeNameNonExistentError."""
        return self._of_node("client", node_name, node_namespace, lambda one: _services(one.all_clients))

    def get_topic_names_and_types(self, no_demangle: bool = False) -> NamesAndTypes:
        """All topics."""
        note_query()
        with self._handle, self._graph.lock:
            self._require_context("failed to get topic names and types")
            topics = self._graph.topics.items()
            published = ((name, end.msg_type) for name, one in topics for end in one.publishers)
            subscribed = ((name, end.msg_type) for name, one in topics for end in one.subscriptions)
            return names_and_types((*published, *subscribed))

    def get_service_names_and_types(self) -> NamesAndTypes:
        """All services."""
        with self._handle, self._graph.lock:
            self._require_context("failed to get service names and types")
            services = (pair for group in self._graph.services.values() for pair in _services(group))
            clients = (pair for group in self._graph.clients.values() for pair in _services(group))
            return names_and_types((*services, *clients))

    def get_node_names(self) -> list[str]:
        """The names of all nodes."""
        return [name for name, _ in self.get_node_names_and_namespaces()]

    def get_fully_qualified_node_names(self) -> list[str]:
        """The full names of all nodes."""
        with self._handle, self._graph.lock:
            self._require_context(_NO_NODES)
            return [one.get_fully_qualified_name() for one in self._graph.nodes]

    def get_node_names_and_namespaces(self) -> list[tuple[str, str]]:
        """Names and namespaces of all nodes."""
        with self._handle, self._graph.lock:
            self._require_context(_NO_NODES)
            return [(one.get_name(), one.get_namespace()) for one in self._graph.nodes]

    def get_node_names_and_namespaces_with_enclaves(self) -> list[tuple[str, str, str]]:
        """Names, namespaces and enclaves of all nodes."""
        return [(name, namespace, "/") for name, namespace in self.get_node_names_and_namespaces()]

    def count_publishers(self, topic_name: str) -> int:
        """The number of publishers of a topic."""
        note_query()
        return len(self._ends(topic_name, "publishers", "Error in rcl_count_publishers"))

    def count_subscribers(self, topic_name: str) -> int:
        """The number of subscriptions of a topic."""
        note_query()
        return len(self._ends(topic_name, "subscriptions", "Error in rcl_count_subscribers"))

    def count_services(self, service_name: str) -> int:
        """The number of servers of a service."""
        full = self._full(service_name, is_service=True)
        with self._handle, self._graph.lock:
            self._require_context("Error in rcl_count_services")
            return len(self._graph.services[full])

    def count_clients(self, service_name: str) -> int:
        """The number of clients of a service."""
        full = self._full(service_name, is_service=True)
        with self._handle, self._graph.lock:
            self._require_context("Error in rcl_count_clients")
            return len(self._graph.clients[full])

    def get_publishers_info_by_topic(self, topic_name: str, no_mangle: bool = False) -> list[TopicEndpointInfo]:
        """The publishers of a topic."""
        return [
            _info(node, end, TopicEndpointTypeEnum.PUBLISHER)
            for node, end in self._owned_ends(topic_name, "publishers", lambda one: one.all_publishers)
        ]

    def get_subscriptions_info_by_topic(self, topic_name: str, no_mangle: bool = False) -> list[TopicEndpointInfo]:
        """The subscriptions of a topic."""
        return [
            _info(node, end, TopicEndpointTypeEnum.SUBSCRIPTION)
            for node, end in self._owned_ends(topic_name, "subscriptions", lambda one: one.all_subscriptions)
        ]

    def wait_for_node(self, fully_qualified_node_name: str, timeout: float) -> bool:
        """Wait for a node; return whether there is one."""
        name = fully_qualified_node_name
        wanted = name if name.startswith("/") else f"/{name}"
        return self._graph.wait_for(lambda: wanted in self.get_fully_qualified_node_names(), timeout, f"node {wanted}")

    def _of_node(
        self, kind: str, name: str, namespace: str, listed: Callable[[GraphNode], Iterable[tuple[str, Any]]]
    ) -> NamesAndTypes:
        """What the nodes of a name have. Raises RCLError for names that are not valid, NodeNameNonExistentError."""
        namespace = namespace or "/"
        asked = f"{kind} names and types"
        with self._handle, self._graph.lock:
            self._require_context(f"failed to get {asked}")
            if problem := node_problem(name) or namespace_problem(namespace):
                raise RCLError(f"failed to get {asked}: {problem[0]}")
            nodes = [one for one in self._graph.nodes if (one.get_name(), one.get_namespace()) == (name, namespace)]
            if not nodes:
                raise NodeNameNonExistentError(
                    f"cannot get {asked} for nonexistent node: {namespace.rstrip('/')}/{name}"
                )
            return names_and_types(pair for one in nodes for pair in listed(one))

    def _full(self, name: str, *, is_service: bool = False) -> str:
        full = expanded(name, self._name, self._namespace)
        validate_full_topic_name(full, is_service=is_service)
        return full

    def _ends(self, topic: str, kind: str, failure: str) -> list[Any]:
        full = self._full(topic)
        with self._handle, self._graph.lock:
            self._require_context(failure)
            return list(getattr(self._graph.topics[full], kind)) if full in self._graph.topics else []

    def _owned_ends(
        self, topic: str, kind: str, ends_of: Callable[[GraphNode], Iterable[Any]]
    ) -> list[tuple[GraphNode, Any]]:
        """The endpoints of a topic, each with its node."""
        with self._graph.lock:
            failure = f"Failed to get information by topic for {kind}"
            owners = {id(end): node for node in self._graph.nodes for end in ends_of(node)}
            return [(owners[id(end)], end) for end in self._ends(topic, kind, failure)]


def _topics(ends: Iterable[Any]) -> Iterable[tuple[str, Any]]:
    return ((end.topic_name, end.msg_type) for end in ends)


def _services(ends: Iterable[Any]) -> Iterable[tuple[str, Any]]:
    return ((end.service_name, end.srv_type) for end in ends)


def _info(node: GraphNode, end: Any, of: TopicEndpointTypeEnum) -> TopicEndpointInfo:
    name = end.msg_type.TYPE_NAME
    return TopicEndpointInfo(
        node_name=node.get_name(),
        node_namespace=node.get_namespace(),
        topic_type=name,
        topic_type_hash=_hash_of(name),
        endpoint_type=of,
        endpoint_gid=list(id(end).to_bytes(_GID_BYTES, "little")),
        qos_profile=_discovered(end.qos_profile, of),
    )


def _hash_of(name: str) -> TypeHash:
    """The hash of a type; an invalid one for a type that only another process knows."""
    try:
        return TypeHash(1, bytes.fromhex(type_hash(name).removeprefix(HASH_PREFIX)))
    except KeyError:
        return TypeHash()


def _discovered(profile: QoSProfile, of: TopicEndpointTypeEnum) -> QoSProfile:
    """A profile as others see it: with what takes the place of default values."""

    def of_duration(duration: Duration) -> Duration:
        return Infinite if duration == Duration() else duration

    is_default = profile.liveliness == LivelinessPolicy.SYSTEM_DEFAULT
    return QoSProfile(
        history=profile.history,
        depth=profile.depth,
        reliability=profile.reliability,
        durability=profile.durability,
        lifespan=of_duration(profile.lifespan) if of is TopicEndpointTypeEnum.PUBLISHER else Infinite,
        deadline=of_duration(profile.deadline),
        liveliness=LivelinessPolicy.AUTOMATIC if is_default else profile.liveliness,
        liveliness_lease_duration=of_duration(profile.liveliness_lease_duration),
    )
