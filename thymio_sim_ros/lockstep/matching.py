"""Matching: whether the endpoints of nodes have found each other. DDS needs some milliseconds for that."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence, Set
from typing import Any

from rclpy.client import Client
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import QoSCompatibility, QoSProfile, qos_check_compatible
from rclpy.service import Service
from rclpy.subscription import Subscription

from thymio_sim_ros.names.type_names import type_name

__all__ = ["EVERYWHERE", "TURNS", "all_matched", "endpoints", "fit", "is_complete", "is_matched"]

EVERYWHERE = ("/clock", "/parameter_events", "/rosout")
"""Topics of every node."""

TURNS = "/_thymio_sim/turns"
"""Topic of the marks between the processes of a test on an installed ROS."""


def all_matched(nodes: Sequence[Node]) -> bool:
    """Whether all compatible publishers and subscriptions of these nodes are matched.

    Only topics with a publisher and a subscription among these nodes are checked: a simulator has thousands of others.
    """
    published = {publisher.topic_name for node in nodes for publisher in node.publishers}
    wanted = {subscription.topic_name for node in nodes for subscription in node.subscriptions}
    used = (published & wanted).difference(EVERYWHERE[1:])
    return all(_node_is_matched(node, used) for node in nodes)


def endpoints(nodes: Iterable[Node]) -> dict[str, dict[str, int]]:
    """Numbers of publishers, subscriptions, services and clients, for `is_complete` in another process.

    Endpoints of topics are counted by name, as in the graph; endpoints of services by name and type.
    """
    numbers = {kind: Counter[str]() for kind in ("publishers", "subscriptions", "services", "clients")}
    for node in nodes:
        for kind in ("publishers", "subscriptions"):
            numbers[kind].update(end.topic_name for end in getattr(node, kind))
        for kind in ("services", "clients"):
            numbers[kind].update(_service(end) for end in getattr(node, kind))
    return {kind: dict(counted) for kind, counted in numbers.items()}


def is_complete(nodes: Sequence[Node], expected: Mapping[str, Mapping[str, int]]) -> bool:
    """Whether these nodes are matched with all endpoints that there are according to `expected`.

    `expected` has the numbers of all processes, by kind and name, as `endpoints` has those of one. Topics with
    publishers or subscriptions only are not checked, nor are those of every node.
    """
    if not nodes:
        return True
    published, subscribed = expected["publishers"], expected["subscriptions"]
    used = (published.keys() & subscribed.keys()).difference(EVERYWHERE)
    view = nodes[0]
    own = {publisher.topic_name for node in nodes for publisher in node.publishers}
    own |= {subscription.topic_name for node in nodes for subscription in node.subscriptions}
    own &= used
    return (
        all(view.count_publishers(topic) >= published[topic] for topic in own)
        and all(view.count_subscribers(topic) >= subscribed[topic] for topic in own)
        and all(_node_is_matched(node, own) for node in nodes)
        and all(
            client.service_is_ready()
            for node in nodes
            for client in node.clients
            if _service(client) in expected["services"]
        )
    )


def _node_is_matched(node: Node, topics: Set[str]) -> bool:
    return all(_publisher_is_matched(node, end) for end in node.publishers if end.topic_name in topics) and all(
        is_matched(node, end) for end in node.subscriptions if end.topic_name in topics
    )


def _service(end: Service | Client[Any, Any]) -> str:
    return f"{end.service_name} {type_name(end.srv_type)}"


def _publisher_is_matched(node: Node, publisher: Publisher[Any]) -> bool:
    own = type_name(publisher.msg_type)
    infos = node.get_subscriptions_info_by_topic(publisher.topic_name)
    fits = sum(info.topic_type == own and fit(publisher.qos_profile, info.qos_profile) for info in infos)
    return bool(publisher.get_subscription_count() >= fits)


def is_matched(node: Node, subscription: Subscription) -> bool:
    """Whether a subscription is matched with all compatible publishers, including those of other processes."""
    own = type_name(subscription.msg_type)
    infos = node.get_publishers_info_by_topic(subscription.topic_name)
    fits = sum(info.topic_type == own and fit(info.qos_profile, subscription.qos_profile) for info in infos)
    return bool(subscription.get_publisher_count() >= fits)


def fit(published: QoSProfile, wanted: QoSProfile) -> bool:
    """Whether a publisher and a subscription with these profiles match.

    A value that is left to the middleware, such as the liveliness of a plain QoSProfile, is a warning of rclpy.
    """
    compatibility, _ = qos_check_compatible(published, wanted)
    return bool(compatibility != QoSCompatibility.ERROR)
