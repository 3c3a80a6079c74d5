"""Replaces the package `tf2_ros` where it is not installed (docs/tf.md)."""

from __future__ import annotations

from geometry_msgs.msg import TransformStamped

from thymio_sim_ros.tf.buffer import Buffer, StaticTransformBroadcaster, TransformBroadcaster, TransformListener
from thymio_sim_ros.tf.errors import (
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TimeoutException,
    TransformException,
    TypeException,
)

__all__ = [
    "Buffer",
    "ConnectivityException",
    "ExtrapolationException",
    "InvalidArgumentException",
    "LookupException",
    "StaticTransformBroadcaster",
    "TimeoutException",
    "TransformBroadcaster",
    "TransformException",
    "TransformListener",
    "TransformStamped",
    "TypeException",
]
