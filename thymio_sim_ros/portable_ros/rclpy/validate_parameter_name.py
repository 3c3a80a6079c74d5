"""The check of names of parameters."""

from __future__ import annotations

from typing import Literal

from thymio_sim_ros.portable_ros.rclpy.exceptions import InvalidParameterException

__all__ = ["validate_parameter_name"]


def validate_parameter_name(name: str) -> Literal[True]:
    """Return True. Raises InvalidParameterException for an empty name."""
    if not name:
        raise InvalidParameterException(name)
    return True
