"""Replaces the package `tf2_ros` where it is not installed (docs/tf.md)."""

from __future__ import annotations

import importlib
from typing import Any

from geometry_msgs.msg import TransformStamped

from thymio_sim_ros.tf.broadcasters import StaticTransformBroadcaster, TransformBroadcaster
from thymio_sim_ros.tf.buffer import Buffer
from thymio_sim_ros.tf.buffer import Buffer as BufferCore
from thymio_sim_ros.tf.buffer_interface import (
    BufferInterface,
    ConvertRegistration,
    Stamped,
    TransformRegistration,
    convert,
)
from thymio_sim_ros.tf.errors import (
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    NotImplementedException,
    TimeoutException,
    TransformException,
    TypeException,
)
from thymio_sim_ros.tf.transform_listener import TransformListener

__all__ = [
    "Buffer",
    "BufferCore",
    "BufferInterface",
    "ConnectivityException",
    "ConvertRegistration",
    "ExtrapolationException",
    "InvalidArgumentException",
    "LookupException",
    "NotImplementedException",
    "Stamped",
    "StaticTransformBroadcaster",
    "TimeoutException",
    "TransformBroadcaster",
    "TransformException",
    "TransformListener",
    "TransformRegistration",
    "TransformStamped",
    "TypeException",
    "convert",
]


def __getattr__(name: str) -> Any:
    """The class BufferClient, which not every ROS can have. Raises ImportError without its action."""
    if name == "BufferClient":
        return importlib.import_module(f"{__name__}.buffer_client").BufferClient
    raise AttributeError(f"module 'tf2_ros' has no attribute {name!r}")
