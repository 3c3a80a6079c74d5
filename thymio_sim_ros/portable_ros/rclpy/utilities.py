"""The default context, and facts about the installation."""

from __future__ import annotations

import sys
import threading
from collections.abc import Sequence
from typing import TYPE_CHECKING

from thymio_sim_ros.portable_ros.graph.arguments import without_ros_arguments
from thymio_sim_ros.portable_ros.graph.time_base import note_query
from thymio_sim_ros.portable_ros.rclpy.constants import S_TO_NS

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.rclpy.context import Context

RMW_IDENTIFIER = "portable_ros"
"""Stands for the name of a middleware."""

_default: Context | None = None
_lock = threading.Lock()


def get_default_context(*, shutting_down: bool = False) -> Context:
    """The context of everything that names none; a new one where the last one is being shut down."""
    from thymio_sim_ros.portable_ros.rclpy.context import Context

    global _default
    with _lock:
        if shutting_down:
            old, _default = _default, None
            if old is None:
                old = Context()
            return old
        if _default is None:
            _default = Context()
        return _default


def remove_ros_args(args: Sequence[str] | None = None) -> list[str]:
    """The arguments of the program without those of ROS."""
    return without_ros_arguments(sys.argv if args is None else args)


def ok(*, context: Context | None = None) -> bool:
    """Whether the context is initialized and not shut down."""
    note_query()
    return (context or get_default_context()).ok()


def shutdown(*, context: Context | None = None) -> None:
    """Shut the context down. Raises RuntimeError if that has been done."""
    (context or get_default_context(shutting_down=True)).shutdown()


def try_shutdown(*, context: Context | None = None) -> None:
    """Shut the context down unless that has been done."""
    if context is None:
        context = get_default_context()
        context.try_shutdown()
        get_default_context(shutting_down=True)
    else:
        context.try_shutdown()


def get_rmw_implementation_identifier() -> str:
    """The name that stands for this graph among the names of middlewares."""
    return RMW_IDENTIFIER


def get_available_rmw_implementations() -> set[str]:
    """The only one."""
    return {RMW_IDENTIFIER}


def timeout_sec_to_nsec(timeout_sec: float | None) -> int:
    """Nanoseconds; -1 for None and negative times, which stand for no limit."""
    return -1 if timeout_sec is None or timeout_sec < 0 else int(timeout_sec * S_TO_NS)
