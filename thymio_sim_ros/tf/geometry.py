"""Transformation of messages of geometry_msgs to another frame, like `tf2_geometry_msgs`."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from geometry_msgs.msg import (
    Point,
    PointStamped,
    Pose,
    PoseStamped,
    Quaternion,
    TransformStamped,
    Vector3,
    Vector3Stamped,
)

from thymio_sim_ros.tf.buffer_core import RigidTransform

__all__ = [
    "TRANSFORMERS",
    "do_transform_point",
    "do_transform_pose",
    "do_transform_pose_stamped",
    "do_transform_vector3",
    "transform_of",
]


def transform_of(transform: TransformStamped) -> RigidTransform:
    """The rigid transform of a message."""
    t, q = transform.transform.translation, transform.transform.rotation
    return RigidTransform((t.x, t.y, t.z), (q.x, q.y, q.z, q.w))


def do_transform_point(point: PointStamped, transform: TransformStamped) -> PointStamped:
    """Transform a point to the frame of the transform's header."""
    x, y, z = transform_of(transform).apply((point.point.x, point.point.y, point.point.z))
    return PointStamped(header=transform.header, point=Point(x=x, y=y, z=z))


def do_transform_vector3(vector3: Vector3Stamped, transform: TransformStamped) -> Vector3Stamped:
    """Rotate a vector to the frame of the transform's header, without translation."""
    x, y, z = transform_of(transform).rotate((vector3.vector.x, vector3.vector.y, vector3.vector.z))
    return Vector3Stamped(header=transform.header, vector=Vector3(x=x, y=y, z=z))


def do_transform_pose(pose: Pose, transform: TransformStamped) -> Pose:
    """Transform a pose without a header to the frame of the transform's header."""
    p, q = pose.position, pose.orientation
    moved = transform_of(transform) * RigidTransform((p.x, p.y, p.z), (q.x, q.y, q.z, q.w))
    (x, y, z), (qx, qy, qz, qw) = moved.translation, moved.rotation
    return Pose(position=Point(x=x, y=y, z=z), orientation=Quaternion(x=qx, y=qy, z=qz, w=qw))


def do_transform_pose_stamped(pose: PoseStamped, transform: TransformStamped) -> PoseStamped:
    """Transform a pose to the frame of the transform's header."""
    return PoseStamped(header=transform.header, pose=do_transform_pose(pose.pose, transform))


TRANSFORMERS: Mapping[type, Callable[[Any, TransformStamped], Any]] = {
    PointStamped: do_transform_point,
    Vector3Stamped: do_transform_vector3,
    PoseStamped: do_transform_pose_stamped,
}
"""Functions for the message types that `Buffer.transform` accepts."""
