"""The subscription of a client to a topic."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rclpy._rclpy_pybind11 import RCLError, RMWError
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy

from thymio_sim_ros.bridge.rosbridge.pace import Pace
from thymio_sim_ros.ros.foxglove.qos import subscription_qos
from thymio_sim_ros.ros.foxglove.rosbridge.client_node import ClientNode
from thymio_sim_ros.ros.foxglove.rosbridge.host import Host, RefusedError
from thymio_sim_ros.ros.foxglove.rosbridge.outbox import Outbox
from thymio_sim_ros.ros.foxglove.rosbridge.values import Compression, from_cdr

if TYPE_CHECKING:
    from rclpy.subscription import Subscription

__all__ = ["Request", "TopicSubscription"]

_SHOWN = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)


@dataclass(frozen=True, slots=True)
class Request:
    """What one `subscribe` of a client asks for."""

    throttle_s: float = 0.0
    queue_length: int = 0
    fragment_size: int | None = None
    compression: Compression = Compression.NONE


class TopicSubscription:
    """One ROS subscription for all requests of a client for a topic, as rosbridge_suite has it.

    The requests share the shortest throttle, the longest queue, the smallest parts and the strongest compression.
    """

    def __init__(
        self, host: Host, outbox: Outbox, place: ClientNode, topic: str, kind: Any, *, extra: dict[str, Any], slot: int
    ) -> None:
        """`kind` is the class of the messages, `extra` are further fields of what the client gets."""
        self._host, self._outbox, self._place = host, outbox, place
        self._kind, self._slot = kind, slot
        self.topic = topic
        self._frame = {"op": "publish", **extra}
        self._profile: QoSProfile | None = None
        """The profile that the client asked for, None: one that fits the publishers."""
        self._known: object = None
        self._publishers = -1
        self._subscription: Subscription | None = None
        self._shown: Subscription | None = None
        self._requests: dict[object, Request] = {}
        self._combined = Request()
        self._pace: Pace[bytes] = Pace(0.0, 0)

    def add(self, key: object, request: Request, profile: QoSProfile | None) -> None:
        """Add a request of the client, or change it. Raises RefusedError."""
        self._requests[key] = request
        self._combine()
        if self._subscription is None:
            self._profile = profile
            self._subscribe()

    def remove(self, key: object) -> bool:
        """Remove a request, None: all; return whether none is left."""
        if key is None:
            self._requests.clear()
        self._requests.pop(key, None)
        if self._requests:
            self._combine()
        return not self._requests

    def _combine(self) -> None:
        requests = self._requests.values()
        order = list(Compression)
        before = self._combined
        self._combined = Request(
            min(item.throttle_s for item in requests),
            max(item.queue_length for item in requests),
            min((item.fragment_size for item in requests if item.fragment_size), default=None),
            max((item.compression for item in requests), key=order.index),
        )
        if (before.throttle_s, before.queue_length) != (self._combined.throttle_s, self._combined.queue_length):
            self._pace = Pace(self._combined.throttle_s, self._combined.queue_length)

    def refresh(self) -> None:
        """Subscribe again if the publishers now need another QoS."""
        if self._profile is None and self._host.node.count_publishers(self.topic) != self._publishers:
            before = self._known
            profile = self._fitting_profile()
            if before != self._known:
                self._unsubscribe()
                self._subscription = self._create(self._place.subscriber, profile)

    def poll(self) -> bool:
        """Send a queued message that is due; return whether others are queued."""
        payload = self._pace.due(time.monotonic())
        if payload is not None:
            self._send(payload)
        return self._pace.is_waiting

    def close(self) -> None:
        """End the subscription."""
        self._unsubscribe()
        if self._shown is not None and self._place.own is not None:
            self._place.own.destroy_subscription(self._shown)

    def _fitting_profile(self) -> QoSProfile:
        publishers = self._host.node.get_publishers_info_by_topic(self.topic)
        low, high = self._host.depths
        self._publishers = len(publishers)
        self._known = found = subscription_qos(publishers, min_depth=low, max_depth=high)
        return found.profile

    def _subscribe(self) -> None:
        profile = self._profile or self._fitting_profile()
        try:
            self._subscription = self._create(self._place.subscriber, profile)
            own = self._place.own
            if own is not None and own is not self._place.subscriber:
                # The graph shows it as a subscription of the client's node; the messages come by the other one.
                self._shown = own.create_subscription(self._kind, self.topic, lambda _: None, _SHOWN, raw=True)
        except RCLError as error:
            self._unsubscribe()
            raise RefusedError(f"subscribe.type: {self.topic} has another type: {error}".partition("\n")[0]) from error

    def _create(self, node: Node, profile: QoSProfile) -> Subscription:
        return node.create_subscription(self._kind, self.topic, self._receive, profile, raw=True)

    def _unsubscribe(self) -> None:
        if self._subscription is not None:
            self._place.subscriber.destroy_subscription(self._subscription)
            self._subscription = None

    def _receive(self, payload: bytes) -> None:
        due = self._pace.offer(payload, time.monotonic())
        if due is not None:
            self._send(due)
        if self._pace.is_waiting:
            self._host.wake()

    def _send(self, payload: bytes) -> None:
        compression = self._combined.compression
        try:
            value = from_cdr(payload, self._kind, compression)
        except (RMWError, ValueError) as error:
            self._outbox.status("error", f"a message on {self.topic} cannot be decoded: {error}".partition("\n")[0])
            return
        if compression is Compression.RAW:
            value["secs"], value["nsecs"] = divmod(self._host.now_ns(), 1_000_000_000)
        self._outbox.send({**self._frame, "msg": value}, compression, self._combined.fragment_size, self._slot)
