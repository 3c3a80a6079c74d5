"""The actions of the graph."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from thymio_sim_ros.portable_ros.messages.interface_files import FEEDBACK_MESSAGE
from thymio_sim_ros.portable_ros.rclpy._rclpy_pybind11 import NodeNameNonExistentError, RCLError
from thymio_sim_ros.portable_ros.rclpy_parts.action_parts import FEEDBACK, full_name
from thymio_sim_ros.portable_ros.rclpy_parts.node_graph import NamesAndTypes, NodeGraph

__all__ = [
    "get_action_client_names_and_types_by_node",
    "get_action_names_and_types",
    "get_action_server_names_and_types_by_node",
]


def get_action_client_names_and_types_by_node(
    node: NodeGraph, remote_node_name: str, remote_node_namespace: str
) -> NamesAndTypes:
    """The actions of which a node is a client. Raises RCLError for a node that there is not."""
    return _of_node("client", node.get_subscriber_names_and_types_by_node, remote_node_name, remote_node_namespace)


def get_action_server_names_and_types_by_node(
    node: NodeGraph, remote_node_name: str, remote_node_namespace: str
) -> NamesAndTypes:
    """The actions that a node offers. Raises RCLError for a node that there is not."""
    return _of_node("server", node.get_publisher_names_and_types_by_node, remote_node_name, remote_node_namespace)


def get_action_names_and_types(node: NodeGraph) -> NamesAndTypes:
    """All actions that have a server or a client."""
    return _actions(node.get_topic_names_and_types())


def _of_node(role: str, topics_of: Callable[[str, str], Any], name: str, namespace: str) -> NamesAndTypes:
    try:
        return _actions(topics_of(name, namespace))
    except NodeNameNonExistentError as error:
        raise RCLError(f"Failed to get action {role} names and type: {error}") from error


def _actions(topics: NamesAndTypes) -> NamesAndTypes:
    """The actions of the topics that have feedback."""
    end, kind = full_name("", FEEDBACK), f"_{FEEDBACK_MESSAGE}"
    found = (
        (name.removesuffix(end), [one.removesuffix(kind) for one in types if one.endswith(kind)])
        for name, types in topics
        if name.endswith(end)
    )
    return [(name, types) for name, types in found if types]
