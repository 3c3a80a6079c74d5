"""Transformation of messages of geometry_msgs to another frame, like `tf2_geometry_msgs`."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt
from geometry_msgs.msg import (
    Point,
    PointStamped,
    Pose,
    PoseStamped,
    PoseWithCovarianceStamped,
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
    "do_transform_pose_with_covariance_stamped",
    "do_transform_vector3",
    "transform_covariance",
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
    """Transform a pose without a header to the frame of the transform's header.

    Of the two quaternions of the rotation, q and -q, the result is the one with w ≥ 0, as in `tf2_geometry_msgs`.
    """
    p, q = pose.position, pose.orientation
    moved = transform_of(transform) * RigidTransform((p.x, p.y, p.z), (q.x, q.y, q.z, q.w))
    sign = -1.0 if moved.rotation[3] < 0.0 else 1.0
    (x, y, z), (qx, qy, qz, qw) = moved.translation, (sign * part for part in moved.rotation)
    return Pose(position=Point(x=x, y=y, z=z), orientation=Quaternion(x=qx, y=qy, z=qz, w=qw))


def do_transform_pose_stamped(pose: PoseStamped, transform: TransformStamped) -> PoseStamped:
    """Transform a pose to the frame of the transform's header."""
    return PoseStamped(header=transform.header, pose=do_transform_pose(pose.pose, transform))


def do_transform_pose_with_covariance_stamped(
    pose: PoseWithCovarianceStamped, transform: TransformStamped
) -> PoseWithCovarianceStamped:
    """Transform a pose and rotate its covariance to the frame of the transform's header."""
    moved = PoseWithCovarianceStamped(header=transform.header)
    moved.pose.pose = do_transform_pose(pose.pose.pose, transform)
    moved.pose.covariance = transform_covariance(pose.pose.covariance, transform)
    return moved


def transform_covariance(cov_in: npt.ArrayLike, transform: TransformStamped) -> npt.NDArray[np.float64]:
    """Rotate the covariance of a pose, 36 numbers, row by row: x, y, z in m, rotations about x, y, z in rad.

    Positions and rotations are both vectors, so each of the four 3 by 3 blocks C becomes R C Rᵀ.
    """
    rotation = transform_of(transform)
    columns = [rotation.rotate(axis) for axis in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))]
    both = np.kron(np.eye(2), np.array(columns).T)
    turned: npt.NDArray[np.float64] = both @ np.reshape(cov_in, (6, 6)) @ both.T
    return turned.ravel()


TRANSFORMERS: Mapping[type, Callable[[Any, TransformStamped], Any]] = {
    PointStamped: do_transform_point,
    Vector3Stamped: do_transform_vector3,
    PoseStamped: do_transform_pose_stamped,
    PoseWithCovarianceStamped: do_transform_pose_with_covariance_stamped,
}
"""Functions for the message types that `Buffer.transform` accepts."""
