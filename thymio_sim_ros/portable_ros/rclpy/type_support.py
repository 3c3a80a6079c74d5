"""Checks of classes that should be messages or services."""

from __future__ import annotations

from typing import Any

from thymio_sim_ros.portable_ros.messages.action_class import is_action_type
from thymio_sim_ros.portable_ros.messages.message_class import is_message_type, is_service_type
from thymio_sim_ros.portable_ros.rclpy.exceptions import NoTypeSupportImportedException

__all__ = ["check_for_type_support", "check_is_valid_msg_type", "check_is_valid_srv_type"]


def check_for_type_support(msg_or_srv_type: Any) -> None:
    """Raise AttributeError for a class that is no message, service or action.

    Raises NoTypeSupportImportedException for those of an installed ROS, which this graph cannot serialize.
    """
    if any(check(msg_or_srv_type) for check in (is_message_type, is_service_type, is_action_type)):
        return
    if hasattr(type(msg_or_srv_type), "_TYPE_SUPPORT"):
        raise NoTypeSupportImportedException
    raise AttributeError(
        f"type object '{type(msg_or_srv_type).__name__}' has no attribute '_TYPE_SUPPORT' This might be a ROS 1 message"
        " type but it should be a ROS 2 message type. Make sure to source your ROS 2 workspace after your ROS 1"
        " workspace."
    )


def check_is_valid_msg_type(msg_type: Any) -> None:
    """Raise an exception for a class that is no message."""
    check_for_type_support(msg_type)
    if not is_message_type(msg_type):
        raise RuntimeError(f"The message type provided is not valid ({msg_type}), this might be a service or action")


def check_is_valid_srv_type(srv_type: Any) -> None:
    """Raise an exception for a class that is no service."""
    check_for_type_support(srv_type)
    if not is_service_type(srv_type):
        raise RuntimeError(f"The service type provided is not valid ({srv_type}), this might be a message or action")
