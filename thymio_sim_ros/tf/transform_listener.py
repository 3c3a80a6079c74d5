"""The listener of `tf2_ros`, which fills a buffer with the transforms that it receives."""

from __future__ import annotations

import threading

from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.clock import ClockChange, JumpThreshold, TimeJump
from rclpy.duration import Duration
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile

from thymio_sim_ros.ros.compat import tf2_messages
from thymio_sim_ros.ros.rclpy_ext.throttled_log import ThrottledLog
from thymio_sim_ros.tf.buffer import Buffer
from thymio_sim_ros.tf.buffer_core import RigidTransform, StampedTransform
from thymio_sim_ros.tf.errors import TransformException

__all__ = ["TransformListener"]

DYNAMIC = QoSProfile(depth=100)
STATIC = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class TransformListener:
    """Fills a buffer with the transforms on `/tf` and `/tf_static`; clears it when the node's time jumps backwards.

    With `spin_thread`, a thread with its own node receives messages, also while callbacks of `node` are waiting.
    """

    def __init__(
        self,
        buffer: Buffer,
        node: Node,
        *,
        spin_thread: bool = False,
        qos: QoSProfile | None = None,
        static_qos: QoSProfile | None = None,
        tf_topic: str = "/tf",
        tf_static_topic: str = "/tf_static",
    ) -> None:
        self.buffer, self.node = buffer, node
        self._warn = ThrottledLog(node)
        self._spin_node: Node | None = None
        if spin_thread:
            self._spin_node = Node(
                f"{node.get_name()}_tf_listener",
                context=node.context,
                namespace=node.get_namespace(),
                enable_rosout=False,
                start_parameter_services=False,
            )
        endpoint_node, group = self._spin_node or node, ReentrantCallbackGroup()
        kind = tf2_messages.TFMessage
        self.tf_sub = endpoint_node.create_subscription(
            kind, tf_topic, self.callback, qos or DYNAMIC, callback_group=group, raw=True
        )
        self.tf_static_sub = endpoint_node.create_subscription(
            kind, tf_static_topic, self.static_callback, static_qos or STATIC, callback_group=group, raw=True
        )
        self._jumps = node.get_clock().create_jump_callback(
            JumpThreshold(min_forward=None, min_backward=Duration(nanoseconds=-1), on_clock_change=True),
            post_callback=self._on_jump,
        )
        if self._spin_node is not None:
            self.executor = SingleThreadedExecutor(context=node.context)
            self.executor.add_node(self._spin_node)
            self.dedicated_listener_thread = threading.Thread(target=self._spin, name="tf_listener", daemon=True)
            self.dedicated_listener_thread.start()

    def callback(self, data: bytes) -> None:
        """Store the transforms of a serialized message of `/tf`."""
        self._on_transforms(data, is_static=False)

    def static_callback(self, data: bytes) -> None:
        """Store the transforms of a serialized message of `/tf_static`."""
        self._on_transforms(data, is_static=True)

    def unregister(self) -> None:
        """Destroy the subscriptions, and the thread if there is one."""
        self._jumps.unregister()
        if self._spin_node is None:
            self.node.destroy_subscription(self.tf_sub)
            self.node.destroy_subscription(self.tf_static_sub)
            return
        self.executor.shutdown(timeout_sec=1.0)
        self.dedicated_listener_thread.join(timeout=1.0)
        self._spin_node.destroy_node()

    def _spin(self) -> None:
        try:
            self.executor.spin()
        except ExternalShutdownException:
            return

    def _on_transforms(self, data: bytes, *, is_static: bool) -> None:
        try:
            transforms = [
                StampedTransform(
                    message.stamp_ns,
                    message.frame,
                    message.child,
                    RigidTransform(message.translation, message.rotation),
                )
                for message in tf2_messages.decode(data)
            ]
            self.buffer._store(transforms, "default_authority", is_static=is_static)
        except (tf2_messages.TransformDataError, TransformException) as error:
            self._warn("tf:", f"{error}; does the node use the simulator's time (use_sim_time:=true)?")

    def _on_jump(self, jump: TimeJump) -> None:
        if jump.delta.nanoseconds < 0 or jump.clock_change not in (
            ClockChange.ROS_TIME_NO_CHANGE,
            ClockChange.SYSTEM_TIME_NO_CHANGE,
        ):
            self.buffer.clear()
