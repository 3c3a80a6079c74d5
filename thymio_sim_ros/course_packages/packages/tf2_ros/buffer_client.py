"""The client of `tf2_ros`. Without the types of its action, importing the class is an error that names the cure."""

from __future__ import annotations

from typing import Any

from thymio_sim_ros import course_packages
from thymio_sim_ros.ros.compat.absent_types import without_action


def __getattr__(name: str) -> Any:
    """The class BufferClient, loaded when it is used. Raises ImportError without its action."""
    if name != "BufferClient":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    if not course_packages.is_installed("tf2_msgs"):
        raise without_action(
            "tf2_ros.BufferClient", "tf2_msgs.action.LookupTransform", "tf2_ros.Buffer with a TransformListener"
        )
    from thymio_sim_ros.tf.buffer_client import BufferClient

    return BufferClient
