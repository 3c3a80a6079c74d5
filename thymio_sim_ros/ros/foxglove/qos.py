"""QoS of the bridge's endpoints, from what the graph tells about the others (docs/spec/foxglove.md section 5)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from rclpy.topic_endpoint_info import TopicEndpointInfo

__all__ = ["SubscriptionQos", "publisher_qos", "subscription_qos"]


@dataclass(frozen=True, slots=True)
class SubscriptionQos:
    """How to subscribe: comparable, so that a change is noticed.

    `kept`: messages for newcomers, 0 unless latched; of several publishers as many as may be, since who sent one is not
    told, and one that sends often must not displace another's last.
    """

    is_reliable: bool
    kept: int
    depth: int

    @property
    def profile(self) -> QoSProfile:
        """The same for rclpy."""
        return _profile(self.depth, is_reliable=self.is_reliable, is_transient_local=self.kept > 0)


def subscription_qos(
    publishers: Sequence[TopicEndpointInfo], *, min_depth: int, max_depth: int, best_effort: bool = False
) -> SubscriptionQos:
    """As `ros2 topic echo`: reliable if all publishers are (never with `best_effort`), transient local if all are.

    Fast DDS reports depth 0: count each publisher for one at least. Without publishers: what matches any.
    """
    profiles = [info.qos_profile for info in publishers]
    asked = sum(max(1, profile.depth) for profile in profiles)
    is_transient_local = bool(profiles) and all(
        item.durability == DurabilityPolicy.TRANSIENT_LOCAL for item in profiles
    )
    return SubscriptionQos(
        is_reliable=not best_effort
        and bool(profiles)
        and all(item.reliability == ReliabilityPolicy.RELIABLE for item in profiles),
        kept=0 if not is_transient_local else max_depth if len(profiles) > 1 else min(asked, max_depth),
        depth=min(max(asked, min_depth), max_depth),
    )


def publisher_qos(publishers: Sequence[TopicEndpointInfo], subscriptions: Sequence[TopicEndpointInfo]) -> QoSProfile:
    """For a client's topic: reliable, which suits every subscription; latched where others expect it."""
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
