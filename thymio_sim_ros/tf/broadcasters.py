"""The broadcasters of `tf2_ros`, which publish transforms."""

from __future__ import annotations

from collections.abc import Iterable

from geometry_msgs.msg import TransformStamped
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile

from thymio_sim_ros.ros.compat import tf2_messages
from thymio_sim_ros.tf.buffer import placed_of

__all__ = ["StaticTransformBroadcaster", "TransformBroadcaster"]

DYNAMIC = QoSProfile(depth=100)
STATIC = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class TransformBroadcaster:
    """Publishes transforms on `/tf`."""

    def __init__(self, node: Node, qos: QoSProfile | int | None = None) -> None:
        self.pub_tf = node.create_publisher(tf2_messages.TFMessage, "/tf", qos or DYNAMIC)

    def sendTransform(self, transform: TransformStamped | Iterable[TransformStamped]) -> None:  # noqa: N802  # as tf2's
        """Publish one transform, or several in one message."""
        self.pub_tf.publish(_encoded(_several(transform)))


class StaticTransformBroadcaster:
    """Publishes static transforms on `/tf_static`, transient local: late subscribers receive all of them."""

    def __init__(self, node: Node, qos: QoSProfile | int | None = None) -> None:
        self.pub_tf = node.create_publisher(tf2_messages.TFMessage, "/tf_static", qos or STATIC)
        self._sent: dict[str, TransformStamped] = {}

    def sendTransform(self, transform: TransformStamped | Iterable[TransformStamped]) -> None:  # noqa: N802  # as tf2's
        """Publish one transform or several; they replace earlier ones of the same child frame."""
        self._sent |= {stamped.child_frame_id: stamped for stamped in _several(transform)}
        self.pub_tf.publish(_encoded(self._sent.values()))


def _several(transform: TransformStamped | Iterable[TransformStamped]) -> list[TransformStamped]:
    return list(transform) if isinstance(transform, Iterable) else [transform]


def _encoded(transforms: Iterable[TransformStamped]) -> bytes:
    placed = map(placed_of, transforms)
    return tf2_messages.encode(
        tf2_messages.Transform(
            stamped.stamp_ns, stamped.frame, stamped.child, stamped.motion.translation, stamped.motion.rotation
        )
        for stamped in placed
    )
