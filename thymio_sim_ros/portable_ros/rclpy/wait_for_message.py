"""Waits for one message."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING

from thymio_sim_ros.portable_ros.messages.message_class import MsgT
from thymio_sim_ros.portable_ros.rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from thymio_sim_ros.portable_ros.rclpy.node import Node
from thymio_sim_ros.portable_ros.rclpy.task import Future

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.rclpy.qos import QoSProfile

__all__ = ["wait_for_message"]


def wait_for_message(
    msg_type: type[MsgT], node: Node, topic: str, *, qos_profile: QoSProfile | int = 1, time_to_wait: float = -1
) -> tuple[bool, MsgT | None]:
    """Wait for a message of a topic; return whether there is one, and the message or None.

    Raises InvalidTopicNameException.
    """
    received: Future[MsgT] = Future()
    waiter = Node(
        f"_{node.get_name()}_waiter",
        context=node.context,
        namespace=node.get_namespace(),
        use_global_arguments=False,
        enable_rosout=False,
        start_parameter_services=False,
    )
    full = node._endpoint_name(topic)
    waiter.create_subscription(msg_type, full, received.set_result, qos_profile)
    with suppress(ExternalShutdownException), SingleThreadedExecutor(context=node.context) as executor:
        executor.add_node(waiter)
        executor.spin_until_future_complete(received, time_to_wait)
    waiter.destroy_node()
    return received.done(), received.result()
