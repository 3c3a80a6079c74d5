"""Callbacks for events of publishers and subscriptions.

In one process no message is lost: callbacks for that are accepted and never called. Publishers with automatic
liveliness live as long as their process.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum
from typing import TYPE_CHECKING, Any, ClassVar

from thymio_sim_ros.portable_ros.graph.entity import Entity
from thymio_sim_ros.portable_ros.graph.event_queue import EventQueue
from thymio_sim_ros.portable_ros.rclpy._rclpy_pybind11 import RCLError
from thymio_sim_ros.portable_ros.rclpy.qos import QoSPolicyKind, qos_policy_name_from_kind

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.rclpy.callback_groups import CallbackGroup

__all__ = [
    "EventHandler",
    "IncompatibleTypeInfo",
    "PublisherEventCallbacks",
    "QoSEventHandler",
    "QoSLivelinessChangedInfo",
    "QoSLivelinessLostInfo",
    "QoSMessageLostInfo",
    "QoSOfferedDeadlineMissedInfo",
    "QoSOfferedIncompatibleQoSInfo",
    "QoSPublisherEventType",
    "QoSPublisherMatchedInfo",
    "QoSRequestedDeadlineMissedInfo",
    "QoSRequestedIncompatibleQoSInfo",
    "QoSSubscriptionEventType",
    "QoSSubscriptionMatchedInfo",
    "SubscriptionEventCallbacks",
    "UnsupportedEventTypeError",
]


class QoSPublisherEventType(IntEnum):
    """Events of publishers."""

    RCL_PUBLISHER_OFFERED_DEADLINE_MISSED = 0
    RCL_PUBLISHER_LIVELINESS_LOST = 1
    RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS = 2
    RCL_PUBLISHER_INCOMPATIBLE_TYPE = 3
    RCL_PUBLISHER_MATCHED = 4


class QoSSubscriptionEventType(IntEnum):
    """Events of subscriptions."""

    RCL_SUBSCRIPTION_REQUESTED_DEADLINE_MISSED = 0
    RCL_SUBSCRIPTION_LIVELINESS_CHANGED = 1
    RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS = 2
    RCL_SUBSCRIPTION_MESSAGE_LOST = 3
    RCL_SUBSCRIPTION_INCOMPATIBLE_TYPE = 4
    RCL_SUBSCRIPTION_MATCHED = 5


class UnsupportedEventTypeError(RCLError):
    """The middleware has no such event."""


@dataclass(frozen=True, slots=True)
class MatchedInfo:
    """Numbers of matches since the start and now, and their last changes."""

    total_count: int
    total_count_change: int
    current_count: int
    current_count_change: int


@dataclass(frozen=True, slots=True)
class IncompatibleQoSInfo:
    """Number of endpoints that did not fit, and the policy because of which the last one did not."""

    total_count: int
    total_count_change: int
    last_policy_kind: QoSPolicyKind


@dataclass(frozen=True, slots=True)
class IncompatibleTypeInfo:
    """Number of endpoints of the topic that have another type."""

    total_count: int
    total_count_change: int


@dataclass(frozen=True, slots=True)
class CountInfo:
    """Number of deadlines that were missed, of messages that were lost, or of the ends of a publisher's liveliness."""

    total_count: int
    total_count_change: int


@dataclass(frozen=True, slots=True)
class QoSLivelinessChangedInfo:
    """Numbers of publishers that are alive and that are not, and their last changes."""

    alive_count: int
    not_alive_count: int
    alive_count_change: int
    not_alive_count_change: int


QoSSubscriptionMatchedInfo = QoSPublisherMatchedInfo = MatchedInfo
QoSRequestedIncompatibleQoSInfo = QoSOfferedIncompatibleQoSInfo = IncompatibleQoSInfo
QoSRequestedDeadlineMissedInfo = QoSOfferedDeadlineMissedInfo = CountInfo
QoSMessageLostInfo = QoSLivelinessLostInfo = CountInfo


class EventHandler(Entity):
    """Calls a callback for events of one type, in the executor of the node."""

    def __init__(self, *, callback_group: CallbackGroup, callback: Callable[[Any], Any], event_type: IntEnum) -> None:
        super().__init__(callback_group)
        self.callback, self.event_type = callback, event_type
        self._queue: EventQueue[Any] = EventQueue(None)

    def put(self, info: Any) -> None:
        """Queue an event."""
        self._queue.put(info)
        self.notify()

    def pending(self) -> int:
        """The number of events."""
        return len(self._queue)

    def take(self) -> tuple[Callable[..., Any], tuple[Any, ...]] | None:
        """Take an event."""
        info = self._queue.get()
        return None if info is None else (self.callback, (info,))


QoSEventHandler = EventHandler
"""The former name."""


class _EventCallbacks:
    """Callbacks of an endpoint. By default, endpoints that do not fit are logged."""

    TYPES: ClassVar[dict[str, IntEnum]] = {}
    """The types of events by the names of the callbacks."""
    MISFIT: ClassVar[str] = ""
    """The line about a profile that does not fit."""

    deadline: Callable[[Any], Any] | None
    liveliness: Callable[[Any], Any] | None
    incompatible_qos: Callable[[IncompatibleQoSInfo], Any] | None
    incompatible_type: Callable[[IncompatibleTypeInfo], Any] | None
    matched: Callable[[MatchedInfo], Any] | None
    use_default_callbacks: bool

    def handlers(self, group: CallbackGroup, topic: str, warn: Callable[[str], Any]) -> dict[str, EventHandler]:
        """The handlers of all callbacks by their names; `warn` logs a line."""
        defaults: dict[str, Callable[[Any], Any]] = {}
        if self.use_default_callbacks:
            defaults["incompatible_qos"] = lambda info: warn(
                self.MISFIT.format(topic=topic, policy=qos_policy_name_from_kind(info.last_policy_kind))
            )
            defaults["incompatible_type"] = lambda _: warn(
                f"Incompatible type on topic '{topic}', no messages will be sent to it."
            )
        callbacks = {name: getattr(self, name) or defaults.get(name) for name in self.TYPES}
        return {
            name: EventHandler(callback_group=group, callback=callback, event_type=self.TYPES[name])
            for name, callback in callbacks.items()
            if callback is not None
        }


class SubscriptionEventCallbacks(_EventCallbacks):
    """Callbacks of a subscription. By default, publishers that do not fit are logged."""

    TYPES: ClassVar[dict[str, IntEnum]] = {
        "deadline": QoSSubscriptionEventType.RCL_SUBSCRIPTION_REQUESTED_DEADLINE_MISSED,
        "incompatible_qos": QoSSubscriptionEventType.RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS,
        "liveliness": QoSSubscriptionEventType.RCL_SUBSCRIPTION_LIVELINESS_CHANGED,
        "message_lost": QoSSubscriptionEventType.RCL_SUBSCRIPTION_MESSAGE_LOST,
        "incompatible_type": QoSSubscriptionEventType.RCL_SUBSCRIPTION_INCOMPATIBLE_TYPE,
        "matched": QoSSubscriptionEventType.RCL_SUBSCRIPTION_MATCHED,
    }
    MISFIT: ClassVar[str] = (
        "New publisher discovered on topic '{topic}', offering incompatible QoS. No messages will be received from it."
        " Last incompatible policy: {policy}"
    )

    def __init__(
        self,
        *,
        deadline: Callable[[CountInfo], Any] | None = None,
        incompatible_qos: Callable[[IncompatibleQoSInfo], Any] | None = None,
        liveliness: Callable[[QoSLivelinessChangedInfo], Any] | None = None,
        message_lost: Callable[[CountInfo], Any] | None = None,
        incompatible_type: Callable[[IncompatibleTypeInfo], Any] | None = None,
        matched: Callable[[MatchedInfo], Any] | None = None,
        use_default_callbacks: bool = True,
    ) -> None:
        self.deadline, self.liveliness, self.message_lost = deadline, liveliness, message_lost
        self.incompatible_qos, self.incompatible_type, self.matched = incompatible_qos, incompatible_type, matched
        self.use_default_callbacks = use_default_callbacks


class PublisherEventCallbacks(_EventCallbacks):
    """Callbacks of a publisher. By default, subscriptions that do not fit are logged."""

    TYPES: ClassVar[dict[str, IntEnum]] = {
        "deadline": QoSPublisherEventType.RCL_PUBLISHER_OFFERED_DEADLINE_MISSED,
        "liveliness": QoSPublisherEventType.RCL_PUBLISHER_LIVELINESS_LOST,
        "incompatible_qos": QoSPublisherEventType.RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS,
        "incompatible_type": QoSPublisherEventType.RCL_PUBLISHER_INCOMPATIBLE_TYPE,
        "matched": QoSPublisherEventType.RCL_PUBLISHER_MATCHED,
    }
    MISFIT: ClassVar[str] = (
        "New subscription discovered on topic '{topic}', requesting incompatible QoS. No messages will be sent to it."
        " Last incompatible policy: {policy}"
    )

    def __init__(
        self,
        *,
        deadline: Callable[[CountInfo], Any] | None = None,
        liveliness: Callable[[CountInfo], Any] | None = None,
        incompatible_qos: Callable[[IncompatibleQoSInfo], Any] | None = None,
        incompatible_type: Callable[[IncompatibleTypeInfo], Any] | None = None,
        matched: Callable[[MatchedInfo], Any] | None = None,
        use_default_callbacks: bool = True,
    ) -> None:
        self.deadline, self.liveliness, self.matched = deadline, liveliness, matched
        self.incompatible_qos, self.incompatible_type = incompatible_qos, incompatible_type
        self.use_default_callbacks = use_default_callbacks
