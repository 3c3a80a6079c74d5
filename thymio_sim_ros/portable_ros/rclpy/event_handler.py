"""Callbacks for events of publishers and subscriptions.

In one process no message is lost, late or without its publisher, so that of all events only matches and profiles that
do not fit occur; callbacks for others are accepted and never called.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum
from typing import Any

from thymio_sim_ros.portable_ros.rclpy._rclpy_pybind11 import RCLError
from thymio_sim_ros.portable_ros.rclpy.qos import QoSPolicyKind, qos_policy_name_from_kind

__all__ = ["PublisherEventCallbacks", "SubscriptionEventCallbacks", "UnsupportedEventTypeError"]


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


QoSSubscriptionMatchedInfo = QoSPublisherMatchedInfo = MatchedInfo
QoSRequestedIncompatibleQoSInfo = QoSOfferedIncompatibleQoSInfo = IncompatibleQoSInfo


class SubscriptionEventCallbacks:
    """Callbacks of a subscription. By default, profiles that do not fit are logged."""

    def __init__(
        self,
        *,
        deadline: Callable[[Any], Any] | None = None,
        incompatible_qos: Callable[[IncompatibleQoSInfo], Any] | None = None,
        liveliness: Callable[[Any], Any] | None = None,
        message_lost: Callable[[Any], Any] | None = None,
        incompatible_type: Callable[[Any], Any] | None = None,
        matched: Callable[[MatchedInfo], Any] | None = None,
        use_default_callbacks: bool = True,
    ) -> None:
        self.deadline, self.liveliness, self.message_lost = deadline, liveliness, message_lost
        self.incompatible_qos, self.incompatible_type, self.matched = incompatible_qos, incompatible_type, matched
        self.use_default_callbacks = use_default_callbacks

    def incompatible_callback(
        self, topic: str, warn: Callable[[str], Any]
    ) -> Callable[[IncompatibleQoSInfo], Any] | None:
        """The callback for publishers that do not fit."""
        if self.incompatible_qos or not self.use_default_callbacks:
            return self.incompatible_qos
        return lambda info: warn(
            f"New publisher discovered on topic '{topic}', offering incompatible QoS. No messages will be received from"
            f" it. Last incompatible policy: {qos_policy_name_from_kind(info.last_policy_kind)}"
        )


class PublisherEventCallbacks:
    """Callbacks of a publisher. By default, profiles that do not fit are logged."""

    def __init__(
        self,
        *,
        deadline: Callable[[Any], Any] | None = None,
        liveliness: Callable[[Any], Any] | None = None,
        incompatible_qos: Callable[[IncompatibleQoSInfo], Any] | None = None,
        incompatible_type: Callable[[Any], Any] | None = None,
        matched: Callable[[MatchedInfo], Any] | None = None,
        use_default_callbacks: bool = True,
    ) -> None:
        self.deadline, self.liveliness, self.incompatible_qos = deadline, liveliness, incompatible_qos
        self.incompatible_type, self.matched = incompatible_type, matched
        self.use_default_callbacks = use_default_callbacks

    def incompatible_callback(
        self, topic: str, warn: Callable[[str], Any]
    ) -> Callable[[IncompatibleQoSInfo], Any] | None:
        """The callback for subscriptions that do not fit."""
        if self.incompatible_qos or not self.use_default_callbacks:
            return self.incompatible_qos
        return lambda info: warn(
            f"New subscription discovered on topic '{topic}', requesting incompatible QoS. No messages will be sent to"
            f" it. Last incompatible policy: {qos_policy_name_from_kind(info.last_policy_kind)}"
        )
