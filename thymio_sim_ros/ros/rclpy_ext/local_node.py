"""A node whose endpoints only this process reaches: for parts of a test, as opposed to a program under test.

A private name or domain would hide nothing, because every participant can list the graph and join any domain. So these
endpoints do not exist in DDS at all: callers get the `LocalNode` itself.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.serialization import deserialize_message

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.messages.message_class import Message, Service

__all__ = ["LocalNode", "LocalTopic"]


M = TypeVar("M", bound="Message")
Q = TypeVar("Q", bound="Message")
R = TypeVar("R", bound="Message")


class LocalTopic:
    """A topic of a LocalNode, which both its publishers and its subscribers use."""

    def __init__(self, kind: type[Message], name: str) -> None:
        self.kind, self.topic_name = kind, name
        self.handle = None  # read by subscription_count, which then uses the method below
        self.callbacks: list[Callable[[Any], object]] = []
        self.retained: list[Any] = []
        """The last message, if the topic is transient local."""
        self._is_retained = False

    def retain(self, profile: QoSProfile | int) -> None:
        """Keep the last message if the profile says so."""
        self._is_retained = getattr(profile, "durability", None) == DurabilityPolicy.TRANSIENT_LOCAL

    def publish(self, message: Message | bytes) -> None:
        """Pass a message, which may be serialized, to all subscribers at once."""
        if isinstance(message, bytes):
            message = deserialize_message(message, self.kind)
        if self._is_retained:
            self.retained = [message]
        for callback in self.callbacks:
            callback(message)

    def get_subscription_count(self) -> int:
        """Return the number of subscribers."""
        return len(self.callbacks)


class LocalNode:
    """Has the methods of a node by which endpoints are made; everything else is that of the node `node`."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._services: dict[str, tuple[type[Service[Any, Any]], Callable[[Any, Any], Any]]] = {}
        self._topics: dict[str, LocalTopic] = {}

    def __getattr__(self, name: str) -> Any:
        return getattr(self._node, name)

    # --- for the owner of the endpoints ---

    def create_service(
        self, kind: type[Service[Q, R]], name: str, callback: Callable[[Q, R], object], **_options: object
    ) -> str:
        """Make a service; return its full name."""
        full = str(self._node.resolve_service_name(name))
        self._services[full] = kind, callback
        return full

    def create_publisher(
        self, kind: type[Message], name: str, qos_profile: QoSProfile | int, **_options: object
    ) -> LocalTopic:
        """Make a publisher."""
        topic = self._topic(kind, name)
        topic.retain(qos_profile)
        return topic

    def create_subscription(
        self, kind: type[M], name: str, callback: Callable[[M], object], _profile: QoSProfile | int, **_options: object
    ) -> LocalTopic:
        """Make a subscription."""
        topic = self._topic(kind, name)
        topic.callbacks.append(callback)
        return topic

    def destroy_service(self, service: str) -> None:
        """Remove a service."""
        self._services.pop(service, None)

    def destroy_publisher(self, topic: LocalTopic) -> None:
        """Remove a topic."""
        self._topics.pop(topic.topic_name, None)

    destroy_subscription = destroy_publisher

    # --- for the test ---

    def topic(self, name: str) -> LocalTopic | None:
        """Return a topic by its full name, None if there is none."""
        return self._topics.get(name)

    def service(self, name: str) -> Callable[[Any], Any] | None:
        """Return the function that answers requests to a service, by its full name; None without this service."""
        if name not in self._services:
            return None
        kind, callback = self._services[name]
        return lambda request: callback(request, kind.Response())

    def _topic(self, kind: type[Message], name: str) -> LocalTopic:
        full = str(self._node.resolve_topic_name(name))
        return self._topics.setdefault(full, LocalTopic(kind, full))
