"""Replaces the package `tf2_ros` where it is not installed (docs/tf.md)."""

from __future__ import annotations

import importlib
from typing import NoReturn

from geometry_msgs.msg import TransformStamped

from thymio_sim_ros.tf.buffer import Buffer, StaticTransformBroadcaster, TransformBroadcaster, TransformListener
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

_ACTIONS = {"BufferClient": "buffer_client", "BufferServer": "buffer_server"}


def __getattr__(name: str) -> NoReturn:
    """Raise the ImportError of what needs an action."""
    if name in _ACTIONS:
        getattr(importlib.import_module(f"{__name__}.{_ACTIONS[name]}"), name)
    raise AttributeError(f"module 'tf2_ros' has no attribute {name!r}")
