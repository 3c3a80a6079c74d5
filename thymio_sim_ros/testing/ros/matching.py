"""Who has found whom in the graph: discovery takes some milliseconds even inside one process."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSCompatibility, QoSProfile, ReliabilityPolicy, qos_check_compatible

from thymio_sim_ros.testing.waiting import counted

__all__ = ["as_published", "is_settled", "topic_lines"]

_EVERYWHERE = ("/clock", "/parameter_events", "/rosout")
"""Topics of every node, which tell nothing."""


def is_settled(nodes: Iterable[Node]) -> bool:
    """Whether every publisher and subscription of these nodes has found those of the graph that fit it."""
    return all(_is_met(node) for node in nodes)


def _is_met(node: Node) -> bool:
    for publisher in node.publishers:
        infos = node.get_subscriptions_info_by_topic(publisher.topic_name)
        fits = sum(_fit(publisher.qos_profile, info.qos_profile) for info in infos)
        if publisher.get_subscription_count() < fits:
            return False
    for subscription in node.subscriptions:
        infos = node.get_publishers_info_by_topic(subscription.topic_name)
        fits = sum(_fit(info.qos_profile, subscription.qos_profile) for info in infos)
        if subscription.get_publisher_count() < fits:
            return False
    return True


def _fit(published: QoSProfile, wanted: QoSProfile) -> bool:
    compatibility, _ = qos_check_compatible(published, wanted)
    return bool(compatibility == QoSCompatibility.OK)


def as_published(node: Node, topic: str, depth: int, *, latched: bool | None) -> QoSProfile:
    """A profile that hears all publishers of a topic: as reliable and as latched as the least of them."""
    profiles = [info.qos_profile for info in node.get_publishers_info_by_topic(topic)]
    reliable = all(profile.reliability == ReliabilityPolicy.RELIABLE for profile in profiles)
    if latched is None:
        latched = bool(profiles) and all(profile.durability == DurabilityPolicy.TRANSIENT_LOCAL for profile in profiles)
    return QoSProfile(
        depth=depth,
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
    )


def topic_lines(node: Node, ours: Sequence[str]) -> list[str]:
    """The topics of the graph for a person: those of nodes that are not `ours` one by one, the others as a number.

    A topic that lacks its other side is marked: often its name is misspelt.
    """
    lines, others = [], 0
    for topic, kinds in node.get_topic_names_and_types():
        publishers = node.get_publishers_info_by_topic(topic)
        subscribers = node.get_subscriptions_info_by_topic(topic)
        if topic in _EVERYWHERE or all(_name(info) in ours for info in (*publishers, *subscribers)):
            others += 1
            continue
        sides = f"{counted(len(publishers), 'publisher')}, {counted(len(subscribers), 'subscriber')}"
        lonely = "" if publishers and subscribers else " (nobody " + ("listens)" if publishers else "publishes)")
        unfit = [
            (one, other) for one in publishers for other in subscribers if not _fit(one.qos_profile, other.qos_profile)
        ]
        quality = f" ({_name(unfit[0][0])} and {_name(unfit[0][1])} do not fit in QoS)" if unfit else ""
        lines.append(f"{topic} {' '.join(kinds)}: {sides}{lonely}{quality}")
    return [*lines, f"and {others} other topics"] if others else lines


def _name(info: Any) -> str:
    return str(info.node_name)
