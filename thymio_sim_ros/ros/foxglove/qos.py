"""QoS of the bridge's endpoints, derived from the other endpoints of a topic (docs/spec/foxglove.md section 5)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from rclpy.topic_endpoint_info import TopicEndpointInfo

__all__ = ["SubscriptionQos", "publisher_qos", "subscription_qos"]


@dataclass(frozen=True, slots=True)
class SubscriptionQos:
    """QoS of a subscription; comparable, to detect changes.

    `retained` is the number of messages retained for new clients, 0 unless the topic is transient local. With several
    publishers it is the maximum: the publisher of a message is not known, and one that publishes often must not
    displace the last message of another.
    """

    is_reliable: bool
    retained: int
    depth: int

    @property
    def profile(self) -> QoSProfile:
        """The QoS profile for rclpy."""
        return _profile(self.depth, is_reliable=self.is_reliable, is_transient_local=self.retained > 0)


def subscription_qos(
    publishers: Sequence[TopicEndpointInfo], *, min_depth: int, max_depth: int, best_effort: bool = False
) -> SubscriptionQos:
    """Return the QoS of a subscription that matches all publishers, with the strongest guarantees that they share.

    Like `ros2 topic echo`: reliable if all publishers are (never with `best_effort`), transient local if all are.
    Without publishers: best effort and volatile, which match any. The depth is the sum of the publishers' depths,
    within `min_depth` and `max_depth`; each publisher counts at least 1, because Fast DDS reports depth 0.
    """
    profiles = [info.qos_profile for info in publishers]
    total_depth = sum(max(1, profile.depth) for profile in profiles)
    is_transient_local = bool(profiles) and all(
        item.durability == DurabilityPolicy.TRANSIENT_LOCAL for item in profiles
    )
    return SubscriptionQos(
        is_reliable=not best_effort
        and bool(profiles)
        and all(item.reliability == ReliabilityPolicy.RELIABLE for item in profiles),
        retained=0 if not is_transient_local else max_depth if len(profiles) > 1 else min(total_depth, max_depth),
        depth=min(max(total_depth, min_depth), max_depth),
    )


def publisher_qos(publishers: Sequence[TopicEndpointInfo], subscriptions: Sequence[TopicEndpointInfo]) -> QoSProfile:
    """Return the QoS of a publisher for clients: reliable, which matches every subscription.

    It is transient local if another endpoint of the topic is.
    """
    durabilities = [info.qos_profile.durability for info in (*publishers, *subscriptions)]
    is_transient_local = DurabilityPolicy.TRANSIENT_LOCAL in durabilities
    return _profile(1 if is_transient_local else 10, is_reliable=True, is_transient_local=is_transient_local)


def _profile(depth: int, *, is_reliable: bool, is_transient_local: bool) -> QoSProfile:
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST,
        depth=depth,
        reliability=ReliabilityPolicy.RELIABLE if is_reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if is_transient_local else DurabilityPolicy.VOLATILE,
    )
