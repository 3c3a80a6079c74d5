"""Publishers."""

from __future__ import annotations

import threading
from collections import deque
from typing import TYPE_CHECKING, Generic

from thymio_sim_ros.portable_ros.graph import time_base
from thymio_sim_ros.portable_ros.graph.endpoint_events import EndpointEvents
from thymio_sim_ros.portable_ros.graph.entity import Handle
from thymio_sim_ros.portable_ros.graph.protocols import Sample
from thymio_sim_ros.portable_ros.messages import cdr
from thymio_sim_ros.portable_ros.messages.message_class import MsgT
from thymio_sim_ros.portable_ros.rclpy._rclpy_pybind11 import RCLError
from thymio_sim_ros.portable_ros.rclpy.duration import Duration
from thymio_sim_ros.portable_ros.rclpy.qos import DurabilityPolicy, QoSProfile

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.graph.protocols import SubscriptionEnd
    from thymio_sim_ros.portable_ros.rclpy.context import Context

__all__ = ["Publisher"]


class Publisher(Generic[MsgT]):
    """Sends serialized messages to all matched subscriptions."""

    def __init__(
        self,
        context: Context,
        msg_type: type[MsgT],
        topic: str,
        topic_name: str,
        qos_profile: QoSProfile,
        events: EndpointEvents,
        logger_name: str,
    ) -> None:
        """`topic` is the name that the program gave, `topic_name` the full one."""
        self.context = context
        self.msg_type, self.topic, self.qos_profile = msg_type, topic, qos_profile
        self.events, self.event_handlers = events, events.handlers
        self._topic_name, self._logger_name = topic_name, logger_name
        self._handle = Handle("Publisher")
        self._lock = threading.RLock()
        self._count = 0
        self.is_part = False
        """Whether something else stands for the publisher in lists of the node: an action, or the log."""
        self.matched: tuple[SubscriptionEnd, ...] = ()
        self._retained: deque[Sample] | None = None
        if qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL:
            self._retained = deque(maxlen=qos_profile.kept)

    @property
    def topic_name(self) -> str:
        """The full name of the topic."""
        with self._handle:
            return self._topic_name

    @property
    def handle(self) -> Handle:
        """The handle."""
        return self._handle

    @property
    def logger_name(self) -> str:
        """The name of the log of the node."""
        with self._handle:
            return self._logger_name

    def publish(self, msg: MsgT | bytes) -> None:
        """Send a message, or the bytes of a serialized one. Raises TypeError for a message of another type."""
        time_base.note_query()
        with self._handle:
            if isinstance(msg, bytes):
                data: bytes | None = msg
            elif isinstance(msg, self.msg_type):
                data = cdr.serialize(msg) if self._has_reader() else None
            else:
                raise TypeError(f"Expected {self.msg_type}, got {type(msg)}")
            if not self.context.ok():
                raise RCLError("Failed to publish: publisher's context is invalid")
            self._send(data)

    def get_subscription_count(self) -> int:
        """The number of matched subscriptions. Raises RCLError after a shutdown of the context."""
        with self._handle:
            if not self.context.ok():
                raise RCLError("failed to get subscription count: publisher's context is invalid")
            return len(self.matched)

    def assert_liveliness(self) -> None:
        """Be alive for another lease, with the policy MANUAL_BY_TOPIC. Others live as long as their process."""
        with self._handle:
            if self.events.lease is not None:
                self.events.lease.begin([one.events for one in self.matched])

    def wait_for_all_acked(self, timeout: Duration = Duration(nanoseconds=-1)) -> bool:  # noqa: B008  # as rclpy's
        """Return at once: messages arrive while they are published. Raises RCLError after a shutdown."""
        with self._handle:
            if not self.context.ok():
                raise RCLError(
                    "Failed to wait for all acknowledgements: publisher's context is invalid"  # codespell:ignore
                )
            return True

    def destroy(self) -> None:
        """Publish no more. Nodes have `destroy_publisher`."""
        self.events.destroy()
        self._handle.destroy_when_not_in_use()

    def match(self, subscription: SubscriptionEnd) -> None:
        """Send messages to a subscription from now on, after those that are retained for it."""
        with self._lock:
            self.matched = (*self.matched, subscription)
            subscription.add_match(self)
            is_late = subscription.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL
            if is_late and not self.context.graph.is_carried:
                for sample in self.retained:
                    subscription.receive(sample)
        self.events.report_match(1)
        subscription.events.report_match(1)

    def unmatch(self, subscription: SubscriptionEnd) -> None:
        """Send no more messages to a subscription."""
        with self._lock:
            self.matched = tuple(one for one in self.matched if one is not subscription)
            if self.events.lease is not None:
                self.events.lease.forget(subscription.events)
        self.events.report_match(-1)

    @property
    def retained(self) -> tuple[Sample, ...]:
        """The messages that late subscriptions get: without those that are older than the lifespan."""
        # A copy without the lock, which a publishing thread holds; the thread of the transport must not wait for it.
        kept = () if self._retained is None else tuple(self._retained.copy())
        lifespan_ns = self.qos_profile.lifespan.nanoseconds
        if not lifespan_ns:
            return kept
        oldest_ns = time_base.system_ns() - lifespan_ns
        return tuple(one for one in kept if one.source_timestamp > oldest_ns)

    def _has_reader(self) -> bool:
        return bool(self.matched) or self._retained is not None or self.context.graph.is_carried

    def _send(self, data: bytes | None) -> None:
        with self._lock:
            self._count += 1
            self.events.note_message()
            if self.events.lease is not None:
                self.assert_liveliness()
            if data is None:
                return
            sample = Sample(data, time_base.system_ns(), self._count)
            if self._retained is not None:
                self._retained.append(sample)
            if self.context.graph.carry(self, sample):
                return
            for subscription in self.matched:
                subscription.receive(sample)
