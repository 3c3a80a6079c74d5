"""The check of names of topics and services that may be relative."""

from __future__ import annotations

from typing import Literal

from thymio_sim_ros.portable_ros.graph.names import topic_problem
from thymio_sim_ros.portable_ros.rclpy.exceptions import InvalidServiceNameException, InvalidTopicNameException

__all__ = ["validate_topic_name"]

TOPIC_SEPARATOR_STRING = "/"


def validate_topic_name(name: str, *, is_service: bool = False) -> Literal[True]:
    """Return True. Raises InvalidTopicNameException, or InvalidServiceNameException."""
    if problem := topic_problem(name):
        raise (InvalidServiceNameException if is_service else InvalidTopicNameException)(name, *problem)
    return True
