"""The client of `tf2_ros` that needs an action: importing its class is an error that names the cure."""

from __future__ import annotations

from typing import NoReturn

from thymio_sim_ros.ros.compat.absent_types import without_action


def __getattr__(name: str) -> NoReturn:
    """Raise the ImportError of the class."""
    if name == "BufferClient":
        raise without_action(
            "tf2_ros.BufferClient", "tf2_msgs.action.LookupTransform", "tf2_ros.Buffer with a TransformListener"
        )
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
