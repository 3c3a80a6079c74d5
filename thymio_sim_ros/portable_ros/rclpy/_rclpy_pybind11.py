"""What other modules use of the compiled part of rclpy: exceptions, checks of arguments, the waits of executors."""

from __future__ import annotations

import sys
import threading

from thymio_sim_ros.portable_ros.graph import waits
from thymio_sim_ros.portable_ros.rclpy.constants import S_TO_NS

__all__ = [
    "InvalidHandle",
    "NodeNameNonExistentError",
    "RCLError",
    "RCLInvalidROSArgsError",
    "RMWError",
    "UnknownROSArgsError",
    "WaitSet",
    "require_argument",
]

_LONGEST_WAIT_S = 0.2 if sys.platform == "win32" else threading.TIMEOUT_MAX
"""Of one wait: Windows handles Ctrl-C between waits."""


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


def require_argument(function: str, found: object, kind: type) -> None:
    """Raise TypeError, as the compiled function does, for an argument of another type."""
    if not isinstance(found, kind):
        raise TypeError(f"{function}(): incompatible function arguments: found {found!r}, expected a {kind.__name__}")


class WaitSet:
    """All waits of an executor: for an event, which notifies `changed`, or for a timer."""

    def __init__(self) -> None:
        self.changed = threading.Condition()
        self.due_s: float | None = None
        """Seconds until the next timer, None without timers."""

    def wait(self, timeout_nsec: int) -> None:
        """Wait for an event or a timer, or until the time is over; -1 for no limit. `changed` must be held."""
        limits = [_LONGEST_WAIT_S if timeout_nsec < 0 else timeout_nsec / S_TO_NS]
        with waits.named("messages or timers", timeout_nsec / S_TO_NS):
            self.changed.wait(min(limits if self.due_s is None else [*limits, self.due_s]))
