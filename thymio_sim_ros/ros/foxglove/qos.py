"""QoS of the bridge's endpoints, from what the graph tells about the others (docs/spec/foxglove.md section 5)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from rclpy.topic_endpoint_info import TopicEndpointInfo

__all__ = ["Reception", "publishing", "reception"]


@dataclass(frozen=True, slots=True)
class Reception:
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
        return _profile(self.depth, is_reliable=self.is_reliable, is_latched=self.kept > 0)


def reception(
    publishers: Sequence[TopicEndpointInfo], *, min_depth: int, max_depth: int, best_effort: bool = False
) -> Reception:
    """As `ros2 topic echo`: reliable if all publishers are (never with `best_effort`), transient local if all are.

    Fast DDS reports depth 0: count each publisher for one at least. Without publishers: what matches any.
    """
    profiles = [info.qos_profile for info in publishers]
    asked = sum(max(1, profile.depth) for profile in profiles)
    is_latched = bool(profiles) and all(item.durability == DurabilityPolicy.TRANSIENT_LOCAL for item in profiles)
    return Reception(
        is_reliable=not best_effort
        and bool(profiles)
        and all(item.reliability == ReliabilityPolicy.RELIABLE for item in profiles),
        kept=0 if not is_latched else max_depth if len(profiles) > 1 else min(asked, max_depth),
        depth=min(max(asked, min_depth), max_depth),
    )


def publishing(publishers: Sequence[TopicEndpointInfo], subscriptions: Sequence[TopicEndpointInfo]) -> QoSProfile:
    """For a client's topic: reliable, which suits every subscription; latched where others expect it."""
    durabilities = [info.qos_profile.durability for info in (*publishers, *subscriptions)]
    is_latched = DurabilityPolicy.TRANSIENT_LOCAL in durabilities
    return _profile(1 if is_latched else 10, is_reliable=True, is_latched=is_latched)


def _profile(depth: int, *, is_reliable: bool, is_latched: bool) -> QoSProfile:
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST,
        depth=depth,
        reliability=ReliabilityPolicy.RELIABLE if is_reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if is_latched else DurabilityPolicy.VOLATILE,
    )
