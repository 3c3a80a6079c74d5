"""The check of namespaces."""

from __future__ import annotations

from typing import Literal

from thymio_sim_ros.portable_ros.graph.names import namespace_problem
from thymio_sim_ros.portable_ros.rclpy.exceptions import InvalidNamespaceException

__all__ = ["validate_namespace"]


def validate_namespace(namespace: str) -> Literal[True]:
    """Return True. Raises InvalidNamespaceException."""
    if problem := namespace_problem(namespace):
        raise InvalidNamespaceException(namespace, *problem)
    return True
