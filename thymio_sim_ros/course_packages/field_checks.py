"""Checks of message fields by rclpy: without them, `linear.x = 1` sends the bytes of an int as a float, near zero."""

from __future__ import annotations

import os
from collections.abc import MutableMapping

__all__ = ["VARIABLE", "switch_on"]

VARIABLE = "ROS_PYTHON_CHECK_FIELDS"
"""Each module of messages reads it when it is imported."""


def switch_on(environment: MutableMapping[str, str] = os.environ) -> None:
    """Let messages that are imported later check the types of values, unless the user has decided."""
    environment.setdefault(VARIABLE, "1")
