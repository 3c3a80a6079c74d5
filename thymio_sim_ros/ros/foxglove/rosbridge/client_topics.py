"""What a client publishes and subscribes to."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from builtin_interfaces.msg import Time
from rclpy._rclpy_pybind11 import RCLError
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import Header

from thymio_sim_ros.bridge.rosbridge.frames import Operation
from thymio_sim_ros.ros.foxglove.held_publisher import HeldPublisher
from thymio_sim_ros.ros.foxglove.publishers import velocity_fault
from thymio_sim_ros.ros.foxglove.qos import publisher_qos
from thymio_sim_ros.ros.foxglove.rosbridge.client_node import ClientNode
from thymio_sim_ros.ros.foxglove.rosbridge.host import Host, RefusedError
from thymio_sim_ros.ros.foxglove.rosbridge.outbox import Outbox
from thymio_sim_ros.ros.foxglove.rosbridge.qos_values import to_profile
from thymio_sim_ros.ros.foxglove.rosbridge.subscriptions import Request, TopicSubscription
from thymio_sim_ros.ros.foxglove.rosbridge.values import Compression, cdr_of, to_message

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.messages.message_class import Message

__all__ = ["ClientTopics", "Key", "key_of"]

Key = tuple[str, str, object]
"""An endpoint of a client: the node that it belongs to, its name as the client writes it, and its ID.

Without a node, all requests of a client for one name share an endpoint, and the ID is None.
"""


def key_of(operation: Operation, name: str) -> Key:
    """The endpoint that an operation is about; `name` is the field with its topic, service or action."""
    node = str(operation.get("node", ""))
    return node, operation[name], operation.get("id") if node else None


@dataclass(slots=True)
class _Advertised:
    """A publisher, and the IDs of the operations that advertise it."""

    place: ClientNode
    type_name: str
    held: HeldPublisher
    users: set[object] = field(default_factory=set)


class ClientTopics:
    """The publishers and subscriptions of one client."""

    def __init__(self, host: Host, outbox: Outbox) -> None:
        self._host, self._outbox = host, outbox
        self._slots = itertools.count(1)
        self._publishers: dict[Key, _Advertised] = {}
        self._subscriptions: dict[Key, TopicSubscription] = {}

    def __len__(self) -> int:
        return len(self._publishers) + len(self._subscriptions)

    def advertise(self, operation: Operation, place: ClientNode) -> None:
        """Create a publisher, or count a further user of it. Raises RefusedError."""
        key = key_of(operation, "topic")
        known = self._publishers.get(key)
        if known is None:
            known = self._publishers[key] = self._advertise(operation, place)
        elif operation["type"].replace("/msg/", "/") != known.type_name.replace("/msg/", "/"):
            raise RefusedError(f"advertise.type: expected {known.type_name}, found {operation['type']:.80}")
        known.users.add(operation.get("id"))

    def unadvertise(self, operation: Operation) -> None:
        """End a publisher with its last user; without an ID, all of them are. Raises RefusedError."""
        key = key_of(operation, "topic")
        known = self._publishers.get(key)
        if known is None:
            raise RefusedError(f"unadvertise.topic: expected an advertised one, found {operation['topic']:.80}")
        known.users.discard(operation.get("id"))
        if "id" not in operation or not known.users:
            self._publishers.pop(key).held.destroy()

    def publish(self, operation: Operation, place: ClientNode) -> None:
        """Publish a message; the topic is advertised first where it is not. Raises RefusedError, ValueRefusedError."""
        known = self._publishers.get(key_of(operation, "topic"))
        if known is None:
            known = self._publishers[key_of(operation, "topic")] = self._advertise(operation, place)
        value = operation.get("msg")
        message = to_message(value, known.held.message_type, "publish.msg")
        data = cdr_of(value)
        if data is None:
            self._stamp(message, value)
        if fault := velocity_fault(message):
            raise RefusedError(f"publish.msg: {operation['topic']}: {fault}")
        if not known.held.publish(message if data is None else data):
            self._host.wake()

    def subscribe(self, operation: Operation, place: ClientNode) -> None:
        """Subscribe to a topic, or change a subscription. Raises RefusedError."""
        key = key_of(operation, "topic")
        profile = to_profile(operation["qos"], "subscribe.qos") if "qos" in operation else None
        request = Request(
            operation.get("throttle_rate", 0) / 1000,
            int(operation.get("queue_length", 0)),
            operation.get("fragment_size"),
            Compression(operation.get("compression", "none")),
        )
        known = self._subscriptions.get(key)
        if known is None:
            topic = place.resolve(operation["topic"], "subscribe.topic")
            if not self._host.is_topic(topic):
                raise RefusedError(f"subscribe.topic: {topic} is not offered (topic_whitelist)")
            _, kind = self._host.topic_type(topic, operation.get("type"), "subscribe.type")
            extra = {"topic": operation["topic"], **({"id": operation.get("id")} if key[0] else {})}
            known = TopicSubscription(self._host, self._outbox, place, topic, kind, extra=extra, slot=next(self._slots))
        known.add(operation.get("id"), request, profile)
        self._subscriptions[key] = known

    def unsubscribe(self, operation: Operation) -> None:
        """End a request for a topic, or all without an ID. Raises RefusedError."""
        key = key_of(operation, "topic")
        known = self._subscriptions.get(key)
        if known is None:
            raise RefusedError(f"unsubscribe.topic: expected a subscribed one, found {operation['topic']:.80}")
        if known.remove(operation.get("id")):
            self._subscriptions.pop(key).close()

    def refresh(self) -> None:
        """Adapt the subscriptions to the publishers of their topics."""
        for subscription in self._subscriptions.values():
            subscription.refresh()

    def poll(self) -> bool:
        """Send and publish what is due; return whether more waits."""
        sent = [subscription.poll() for subscription in self._subscriptions.values()]
        flushed = [known.held.flush() for known in self._publishers.values()]
        return any(sent) or not all(flushed)

    def close(self, node: str | None = None) -> None:
        """End the endpoints of a node of the client, None: all."""
        for key in [key for key in self._publishers if node in (None, key[0])]:
            self._publishers.pop(key).held.destroy()
        for key in [key for key in self._subscriptions if node in (None, key[0])]:
            self._subscriptions.pop(key).close()

    def _advertise(self, operation: Operation, place: ClientNode) -> _Advertised:
        where = operation["op"]
        topic = place.resolve(operation["topic"], f"{where}.topic")
        if not self._host.is_client_topic(topic):
            raise RefusedError(f"{where}.topic: clients may not publish on {topic} (client_topic_whitelist)")
        type_name, kind = self._host.topic_type(topic, operation.get("type"), f"{where}.type")
        try:
            held = HeldPublisher(place.publisher, kind, topic, self._publisher_profile(operation, topic))
        except (RCLError, TypeError, AttributeError) as error:  # another type in this process, or not a message type
            first_line = str(error).partition("\n")[0]
            raise RefusedError(f"{where}.type: cannot publish {type_name} on {topic}: {first_line}") from error
        return _Advertised(place, type_name, held)

    def _publisher_profile(self, operation: Operation, topic: str) -> QoSProfile:
        if "qos" in operation:
            return to_profile(operation["qos"], f"{operation['op']}.qos")
        node = self._host.node
        profile = publisher_qos(node.get_publishers_info_by_topic(topic), node.get_subscriptions_info_by_topic(topic))
        if operation.get("latch"):
            profile.durability, profile.depth = DurabilityPolicy.TRANSIENT_LOCAL, 1
        return profile

    def _stamp(self, message: Message, value: object) -> None:
        """Set the stamp of a message to now if the client gave none, as rosbridge_suite does."""
        header = getattr(message, "header", None)
        if not isinstance(header, Header):
            return
        given = value.get("header") if isinstance(value, dict) else None
        if not isinstance(given, dict) or "stamp" not in given:
            sec, nanosec = divmod(self._host.now_ns(), 1_000_000_000)
            header.stamp = Time(sec=sec, nanosec=nanosec)
