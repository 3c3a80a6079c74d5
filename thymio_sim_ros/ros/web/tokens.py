"""The tokens that a node is started with: environment variables, or parameters that it never declares.

Every node of the ROS domain and every client of the bridge may read declared parameters, and `ros2 param dump` writes
them to a file. Therefore `token` and `read_only_token` are read from the command line or a parameter file but never
declared. For the same reason addresses with a token are printed to standard output, not logged (/rosout).
"""

from __future__ import annotations

import os
from collections.abc import Mapping

from rclpy.node import Node

from thymio_sim_ros.access.tokens import READ_ONLY_VARIABLE, TOKEN, TOKEN_VARIABLE, Tokens
from thymio_sim_ros.ros.rclpy_ext import parameters
from thymio_sim_ros.ros.rclpy_ext.node_runner import StartError

__all__ = ["PARAMETERS", "VARIABLES", "given_tokens"]

VARIABLES = {"token": TOKEN_VARIABLE, "read_only_token": READ_ONLY_VARIABLE}
PARAMETERS = frozenset(VARIABLES)


def given_tokens(node: Node, environment: Mapping[str, str] = os.environ) -> Tokens:
    """The tokens that the user gave the node, empty if there are none. Raises StartError for invalid or equal ones."""
    full, read_only = (
        _checked(name, parameters.undeclared(node, name) or environment.get(variable, ""))
        for name, variable in VARIABLES.items()
    )
    if full and full == read_only:
        raise StartError("parameters token and read_only_token: found the same token, expected two different ones")
    return Tokens(full, read_only)


def _checked(name: str, value: str) -> str:
    if value and not TOKEN.fullmatch(value):
        raise StartError(f"{name}: expected 4 to 200 letters, digits, '.', '_', '~' or '-'")
    return value
