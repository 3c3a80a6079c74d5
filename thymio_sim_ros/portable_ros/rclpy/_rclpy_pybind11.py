"""The exceptions that the compiled part of rclpy raises."""

from __future__ import annotations

__all__ = [
    "InvalidHandle",
    "NodeNameNonExistentError",
    "RCLError",
    "RCLInvalidROSArgsError",
    "RMWError",
    "UnknownROSArgsError",
]


class RCLError(RuntimeError):
    """An operation failed."""


class RMWError(RuntimeError):
    """An operation of the middleware failed."""


class RCLInvalidROSArgsError(RCLError):
    """ROS arguments cannot be parsed."""


class UnknownROSArgsError(RuntimeError):
    """There are words behind `--ros-args` that are no ROS arguments."""


class NodeNameNonExistentError(RCLError):
    """The graph has no node of this name."""


class InvalidHandle(RuntimeError):
    """The object is destroyed."""
