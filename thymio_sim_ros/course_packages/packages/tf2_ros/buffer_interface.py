"""The interface of buffers of `tf2_ros`, and the registers of message types."""

from __future__ import annotations

from thymio_sim_ros.tf.buffer_interface import (
    BufferInterface,
    ConvertRegistration,
    Stamped,
    TransformRegistration,
    convert,
)
from thymio_sim_ros.tf.errors import NotImplementedException, TypeException

__all__ = [
    "BufferInterface",
    "ConvertRegistration",
    "NotImplementedException",
    "Stamped",
    "TransformRegistration",
    "TypeException",
    "convert",
]
