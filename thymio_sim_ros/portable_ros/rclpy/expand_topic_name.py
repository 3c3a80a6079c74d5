"""Full names of topics and services."""

from __future__ import annotations

from thymio_sim_ros.portable_ros.graph.names import expanded, namespace_problem, node_problem

__all__ = ["expand_topic_name"]


def expand_topic_name(topic_name: str, node_name: str, node_namespace: str) -> str:
    """The full name of a topic of a node. Raises ValueError for a wrong name or substitution."""
    full = expanded(topic_name, node_name, node_namespace)
    for what, name, problem in (
        ("node name", node_name, node_problem(node_name)),
        ("node namespace", node_namespace, namespace_problem(node_namespace)),
    ):
        if problem:
            raise ValueError(f"{what} '{name}' is invalid: {problem[0]}")
    return full
