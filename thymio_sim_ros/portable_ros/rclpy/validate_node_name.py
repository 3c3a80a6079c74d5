"""The check of names of nodes."""

from __future__ import annotations

from typing import Literal

from thymio_sim_ros.portable_ros.graph.names import node_problem
from thymio_sim_ros.portable_ros.rclpy.exceptions import InvalidNodeNameException

__all__ = ["validate_node_name"]


def validate_node_name(node_name: str) -> Literal[True]:
    """Return True. Raises InvalidNodeNameException."""
    if problem := node_problem(node_name):
        raise InvalidNodeNameException(node_name, *problem)
    return True
