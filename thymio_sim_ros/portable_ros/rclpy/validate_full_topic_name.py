"""The check of full names of topics and services."""

from __future__ import annotations

from typing import Literal

from thymio_sim_ros.portable_ros.graph.names import full_topic_problem
from thymio_sim_ros.portable_ros.rclpy.exceptions import InvalidServiceNameException, InvalidTopicNameException

__all__ = ["validate_full_topic_name"]


def validate_full_topic_name(name: str, *, is_service: bool = False) -> Literal[True]:
    """Return True. Raises InvalidTopicNameException, or InvalidServiceNameException."""
    if problem := full_topic_problem(name):
        raise (InvalidServiceNameException if is_service else InvalidTopicNameException)(name, *problem)
    return True
