"""Serialized messages."""

from __future__ import annotations

from thymio_sim_ros.portable_ros.messages import cdr
from thymio_sim_ros.portable_ros.messages.message_class import Message, MsgT
from thymio_sim_ros.portable_ros.rclpy._rclpy_pybind11 import RMWError
from thymio_sim_ros.portable_ros.rclpy.type_support import check_is_valid_msg_type

__all__ = ["deserialize_message", "serialize_message"]


def serialize_message(message: Message) -> bytes:
    """The bytes of a message."""
    check_is_valid_msg_type(type(message))
    return cdr.serialize(message)


def deserialize_message(serialized_message: bytes, message_type: type[MsgT]) -> MsgT:
    """The message of the bytes. Raises RMWError for others."""
    check_is_valid_msg_type(message_type)
    try:
        return cdr.deserialize(serialized_message, message_type)
    except ValueError as error:
        raise RMWError(f"failed to deserialize ROS message: {error}") from error
