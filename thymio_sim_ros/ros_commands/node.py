"""The verbs of nodes."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping

from rclpy.action import get_action_client_names_and_types_by_node, get_action_server_names_and_types_by_node
from rclpy.topic_or_service_is_hidden import topic_or_service_is_hidden

from thymio_sim_ros.ros_commands.member import Member

__all__ = ["VERBS", "split"]


def split(name: str) -> tuple[str, str]:
    """Name and namespace of a node by its full name."""
    namespace, _, short = name.rpartition("/")
    return short, namespace or "/"


def _list(member: Member, options: argparse.Namespace) -> None:
    member.discover()
    for name in member.nodes():
        if options.include_hidden or not topic_or_service_is_hidden(name):
            print(name)


def _info(member: Member, options: argparse.Namespace) -> None:
    full = member.find("node", options.node, member.nodes)
    member.discover()
    node, (name, namespace) = member.node, split(full)
    print(full)
    for title, found in (
        ("Subscribers", node.get_subscriber_names_and_types_by_node(name, namespace)),
        ("Publishers", node.get_publisher_names_and_types_by_node(name, namespace)),
        ("Service Servers", node.get_service_names_and_types_by_node(name, namespace)),
        ("Service Clients", node.get_client_names_and_types_by_node(name, namespace)),
        ("Action Servers", get_action_server_names_and_types_by_node(node, name, namespace)),
        ("Action Clients", get_action_client_names_and_types_by_node(node, name, namespace)),
    ):
        print(f"  {title}:")
        shown = [(one, types) for one, types in sorted(found) if not topic_or_service_is_hidden(one)]
        print("\n".join(f"    {one}: {', '.join(types)}" for one, types in shown))


VERBS: Mapping[str, Callable[[Member, argparse.Namespace], None]] = {"list": _list, "info": _info}
