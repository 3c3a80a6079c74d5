"""Full names of topics and services."""

from __future__ import annotations

from thymio_sim_ros.portable_ros.graph.names import expanded
from thymio_sim_ros.portable_ros.rclpy.validate_namespace import validate_namespace
from thymio_sim_ros.portable_ros.rclpy.validate_node_name import validate_node_name
from thymio_sim_ros.portable_ros.rclpy.validate_topic_name import validate_topic_name

__all__ = ["expand_topic_name"]


def expand_topic_name(topic_name: str, node_name: str, node_namespace: str) -> str:
    """The full name of a topic of a node. Raises ValueError for a wrong name or substitution."""
    try:
        validate_topic_name(topic_name)
        validate_node_name(node_name)
        validate_namespace(node_namespace)
    except Exception as error:
        raise ValueError(str(error)) from error
    return expanded(topic_name, node_name, node_namespace)
