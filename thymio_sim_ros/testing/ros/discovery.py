"""State of discovery: which endpoints are matched. Discovery takes some milliseconds even inside one process."""

from __future__ import annotations

from collections.abc import Sequence, Set
from typing import Any

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSCompatibility, QoSProfile, ReliabilityPolicy, qos_check_compatible

from thymio_sim_ros.testing.failure_messages import pluralized

__all__ = ["all_matched", "as_published", "is_matched", "topic_lines"]

_EVERYWHERE = ("/clock", "/parameter_events", "/rosout")
"""Topics of every node; not listed in failure messages."""


def all_matched(nodes: Sequence[Node]) -> bool:
    """Whether all compatible publishers and subscriptions of these nodes are matched.

    Only topics with a publisher and a subscription among these nodes are checked: a simulator has thousands of others.
    """
    published = {publisher.topic_name for node in nodes for publisher in node.publishers}
    wanted = {subscription.topic_name for node in nodes for subscription in node.subscriptions}
    used = (published & wanted).difference(_EVERYWHERE[1:])
    return all(_node_is_matched(node, used) for node in nodes)


def _node_is_matched(node: Node, topics: Set[str]) -> bool:
    return all(_publisher_is_matched(node, one) for one in node.publishers if one.topic_name in topics) and all(
        is_matched(node, one) for one in node.subscriptions if one.topic_name in topics
    )


def _publisher_is_matched(node: Node, publisher: Any) -> bool:
    infos = node.get_subscriptions_info_by_topic(publisher.topic_name)
    fits = sum(_fit(publisher.qos_profile, info.qos_profile) for info in infos)
    return bool(publisher.get_subscription_count() >= fits)


def is_matched(node: Node, subscription: Any) -> bool:
    """Whether a subscription is matched with all compatible publishers, including those of other processes."""
    infos = node.get_publishers_info_by_topic(subscription.topic_name)
    fits = sum(_fit(info.qos_profile, subscription.qos_profile) for info in infos)
    return bool(subscription.get_publisher_count() >= fits)


def _fit(published: QoSProfile, wanted: QoSProfile) -> bool:
    compatibility, _ = qos_check_compatible(published, wanted)
    return bool(compatibility == QoSCompatibility.OK)


def as_published(node: Node, topic: str, depth: int, *, transient_local: bool | None) -> QoSProfile:
    """A profile compatible with all publishers of a topic: the weakest reliability and durability among them."""
    profiles = [info.qos_profile for info in node.get_publishers_info_by_topic(topic)]
    reliable = all(profile.reliability == ReliabilityPolicy.RELIABLE for profile in profiles)
    if transient_local is None:
        durabilities = {profile.durability for profile in profiles}
        transient_local = durabilities == {DurabilityPolicy.TRANSIENT_LOCAL}
    return QoSProfile(
        depth=depth,
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if transient_local else DurabilityPolicy.VOLATILE,
    )


def topic_lines(node: Node, ours: Sequence[str]) -> list[str]:
    """The topics of the graph as text: one line for each topic of nodes other than `ours`, and the number of the rest.

    A topic without publisher or without subscriber is marked: often its name is misspelled.
    """
    lines, others = [], 0
    for topic, kinds in node.get_topic_names_and_types():
        publishers = node.get_publishers_info_by_topic(topic)
        subscribers = node.get_subscriptions_info_by_topic(topic)
        if topic in _EVERYWHERE or all(_name(info) in ours for info in (*publishers, *subscribers)):
            others += 1
            continue
        sides = f"{pluralized(len(publishers), 'publisher')}, {pluralized(len(subscribers), 'subscriber')}"
        unmatched = "" if publishers and subscribers else " (no subscriber)" if publishers else " (no publisher)"
        unfit = [
            (one, other) for one in publishers for other in subscribers if not _fit(one.qos_profile, other.qos_profile)
        ]
        quality = f" ({_name(unfit[0][0])} and {_name(unfit[0][1])} have incompatible QoS)" if unfit else ""
        lines.append(f"{topic} {' '.join(kinds)}: {sides}{unmatched}{quality}")
    return [*lines, f"and {pluralized(others, 'other topic')}"] if others else lines


def _name(info: Any) -> str:
    return str(info.node_name)
