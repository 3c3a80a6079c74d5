"""Who has found whom in the graph: discovery takes some milliseconds even inside one process."""

from __future__ import annotations

from collections.abc import Sequence, Set
from typing import Any

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSCompatibility, QoSProfile, ReliabilityPolicy, qos_check_compatible

from thymio_sim_ros.testing.failure_messages import counted

__all__ = ["as_published", "has_met", "is_settled", "topic_lines"]

_EVERYWHERE = ("/clock", "/parameter_events", "/rosout")
"""Topics of every node, which tell nothing."""


def is_settled(nodes: Sequence[Node]) -> bool:
    """Whether the publishers and subscriptions of these nodes have found those of the others that fit them.

    A simulator has thousands that nobody uses: only topics with both sides among these nodes are looked at.
    """
    published = {publisher.topic_name for node in nodes for publisher in node.publishers}
    wanted = {subscription.topic_name for node in nodes for subscription in node.subscriptions}
    used = (published & wanted).difference(_EVERYWHERE[1:])
    return all(_is_met(node, used) for node in nodes)


def _is_met(node: Node, topics: Set[str]) -> bool:
    return all(_has_met_all(node, one) for one in node.publishers if one.topic_name in topics) and all(
        has_met(node, one) for one in node.subscriptions if one.topic_name in topics
    )


def _has_met_all(node: Node, publisher: Any) -> bool:
    infos = node.get_subscriptions_info_by_topic(publisher.topic_name)
    fits = sum(_fit(publisher.qos_profile, info.qos_profile) for info in infos)
    return bool(publisher.get_subscription_count() >= fits)


def has_met(node: Node, subscription: Any) -> bool:
    """Whether a subscription has found all publishers that fit it, those of other processes too."""
    infos = node.get_publishers_info_by_topic(subscription.topic_name)
    fits = sum(_fit(info.qos_profile, subscription.qos_profile) for info in infos)
    return bool(subscription.get_publisher_count() >= fits)


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
    return [*lines, f"and {counted(others, 'other topic')}"] if others else lines


def _name(info: Any) -> str:
    return str(info.node_name)
