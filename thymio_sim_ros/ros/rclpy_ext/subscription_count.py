"""Number of subscriptions of a publisher, polled often."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rclpy.publisher import Publisher

from thymio_sim_ros.ros.rclpy_ext.local_node import LocalTopic

__all__ = ["counter"]


def counter(publisher: Publisher[Any] | LocalTopic) -> Callable[[], int]:
    """Return a function that counts the subscriptions of a publisher; it must not be called on a destroyed one.

    The method of rclpy's handle takes a third of the time of `get_subscription_count`.
    """
    count: Callable[[], int] = getattr(publisher.handle, "get_subscription_count", publisher.get_subscription_count)
    return count
