"""Publishers of lifecycle nodes."""

from __future__ import annotations

from typing import Any

from thymio_sim_ros.portable_ros.messages.message_class import MsgT
from thymio_sim_ros.portable_ros.rclpy.lifecycle.managed_entity import SimpleManagedEntity
from thymio_sim_ros.portable_ros.rclpy.publisher import Publisher

__all__ = ["LifecyclePublisher"]


class LifecyclePublisher(SimpleManagedEntity, Publisher[MsgT]):
    """A publisher that publishes while its node is active."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        SimpleManagedEntity.__init__(self)
        Publisher.__init__(self, *args, **kwargs)

    @SimpleManagedEntity.when_enabled
    def publish(self, msg: MsgT | bytes) -> None:
        """Send a message if the publisher is active. Raises as `Publisher.publish`."""
        Publisher.publish(self, msg)
