"""State of discovery: profiles and topics of the graph, as other nodes see it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.topic_endpoint_info import TopicEndpointInfo

from thymio_sim_ros.lockstep.matching import EVERYWHERE, TURNS, fit
from thymio_sim_ros.names.type_names import type_name
from thymio_sim_ros.ros.rclpy_ext.connections import SUBSCRIBER, wrong_qos
from thymio_sim_ros.testing.failure_messages import pluralized

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.messages.message_class import Message

__all__ = ["as_published", "misfit", "topic_lines"]


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


def misfit(node: Node, kind: type[Message], topic: str, qos: QoSProfile | int) -> str:
    """A sentence if a subscription of `node` fits no publisher of other nodes, although there are some; else empty."""
    profile = QoSProfile(depth=qos) if isinstance(qos, int) else qos
    own = node.get_fully_qualified_name()
    misfits = [
        wrong_qos(SUBSCRIBER, topic, own, type_name(kind), profile, info.qos_profile)
        for info in node.get_publishers_info_by_topic(topic)
        if info.node_name != node.get_name()
    ]
    return str(misfits[0]) if misfits and all(misfits) else ""


def topic_lines(node: Node, ours: Sequence[str]) -> list[str]:
    """The topics of the graph as text: one line for each topic of nodes other than `ours`, and the number of the rest.

    A topic without publisher or without subscriber is marked: often its name is misspelled.
    """
    lines, others = [], 0
    for topic, kinds in node.get_topic_names_and_types():
        if topic == TURNS:
            continue
        publishers = node.get_publishers_info_by_topic(topic)
        subscribers = node.get_subscriptions_info_by_topic(topic)
        if topic in EVERYWHERE or all(_name(info) in ours for info in (*publishers, *subscribers)):
            others += 1
            continue
        sides = f"{pluralized(len(publishers), 'publisher')}, {pluralized(len(subscribers), 'subscriber')}"
        unmatched = "" if publishers and subscribers else " (no subscriber)" if publishers else " (no publisher)"
        pairs = [(one, other) for one in publishers for other in subscribers]
        same = [(one, other) for one, other in pairs if one.topic_type == other.topic_type]
        if pairs and not same:
            unmatched = " (different types: they are not connected)"
        unfit = [(one, other) for one, other in same if not fit(one.qos_profile, other.qos_profile)]
        quality = f" ({_name(unfit[0][0])} and {_name(unfit[0][1])} have incompatible QoS)" if unfit else ""
        lines.append(f"{topic} {' '.join(kinds)}: {sides}{unmatched}{quality}")
    return [*lines, f"and {pluralized(others, 'other topic')}"] if others else lines


def _name(info: TopicEndpointInfo) -> str:
    return str(info.node_name)
