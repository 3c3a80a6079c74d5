"""Replaces the package `tf2_py` where it is not installed (docs/tf.md)."""

from __future__ import annotations

from thymio_sim_ros.tf.buffer import Buffer as BufferCore
from thymio_sim_ros.tf.errors import (
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TimeoutException,
    TransformException,
)

__all__ = [
    "BufferCore",
    "ConnectivityException",
    "ExtrapolationException",
    "InvalidArgumentException",
    "LookupException",
    "TimeoutException",
    "TransformException",
]
