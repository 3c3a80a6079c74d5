"""tf2 for students: the classes of `tf2_ros` and the functions of `tf_transformations`, also without these packages.

    from thymio_sim_ros.tf import Buffer, TransformListener, euler_from_quaternion

If `tf2_ros`, `tf2_geometry_msgs` or `tf_transformations` is installed, as on a complete ROS installation, the names
refer to the package. Otherwise, as with the ROS wheels, they refer to this project's implementation with the same
arguments and exceptions. Programs need no change; those that import the packages themselves get the same
(`course_packages`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from thymio_sim_ros import course_packages
from thymio_sim_ros.tf import geometry

if TYPE_CHECKING:
    from thymio_sim_ros.tf.broadcasters import StaticTransformBroadcaster, TransformBroadcaster
    from thymio_sim_ros.tf.buffer import Buffer
    from thymio_sim_ros.tf.errors import (
        ConnectivityException,
        ExtrapolationException,
        InvalidArgumentException,
        LookupException,
        TimeoutException,
        TransformException,
        TypeException,
    )
    from thymio_sim_ros.tf.geometry import (
        do_transform_point,
        do_transform_pose,
        do_transform_pose_stamped,
        do_transform_vector3,
    )
    from thymio_sim_ros.tf.transform_listener import TransformListener
else:
    if course_packages.is_installed("tf2_ros"):
        from tf2_ros import (
            Buffer,
            ConnectivityException,
            ExtrapolationException,
            InvalidArgumentException,
            LookupException,
            StaticTransformBroadcaster,
            TimeoutException,
            TransformBroadcaster,
            TransformException,
            TransformListener,
            TransformRegistration,
            TypeException,
        )
    else:
        from thymio_sim_ros.tf.broadcasters import StaticTransformBroadcaster, TransformBroadcaster
        from thymio_sim_ros.tf.buffer import Buffer
        from thymio_sim_ros.tf.errors import (
            ConnectivityException,
            ExtrapolationException,
            InvalidArgumentException,
            LookupException,
            TimeoutException,
            TransformException,
            TypeException,
        )
        from thymio_sim_ros.tf.transform_listener import TransformListener

        TransformRegistration = None
    if course_packages.is_installed("tf2_geometry_msgs"):
        from tf2_geometry_msgs import (
            do_transform_point,
            do_transform_pose,
            do_transform_pose_stamped,
            do_transform_vector3,
        )
    else:
        from thymio_sim_ros.tf.geometry import (
            do_transform_point,
            do_transform_pose,
            do_transform_pose_stamped,
            do_transform_vector3,
        )

        if TransformRegistration is not None:
            for _kind, _act in geometry.TRANSFORMERS.items():
                TransformRegistration().add(_kind, _act)

if TYPE_CHECKING:
    from thymio_sim_ros.tf.transformations import (
        compose_matrix,
        concatenate_matrices,
        euler_from_matrix,
        euler_from_quaternion,
        euler_matrix,
        identity_matrix,
        inverse_matrix,
        is_same_transform,
        quaternion_about_axis,
        quaternion_conjugate,
        quaternion_from_euler,
        quaternion_from_matrix,
        quaternion_inverse,
        quaternion_matrix,
        quaternion_multiply,
        quaternion_slerp,
        random_quaternion,
        rotation_from_matrix,
        rotation_matrix,
        translation_from_matrix,
        translation_matrix,
        unit_vector,
        vector_norm,
    )
else:
    from thymio_sim_ros.tf import transformations as _ours

    if course_packages.is_installed("tf_transformations"):
        import tf_transformations as _theirs
    else:
        _theirs = _ours
    for _name in _ours.__all__:
        globals()[_name] = getattr(_theirs, _name)

__all__ = [
    "Buffer",
    "ConnectivityException",
    "ExtrapolationException",
    "InvalidArgumentException",
    "LookupException",
    "StaticTransformBroadcaster",
    "TimeoutException",
    "TransformBroadcaster",
    "TransformException",
    "TransformListener",
    "TypeException",
    "compose_matrix",
    "concatenate_matrices",
    "do_transform_point",
    "do_transform_pose",
    "do_transform_pose_stamped",
    "do_transform_vector3",
    "euler_from_matrix",
    "euler_from_quaternion",
    "euler_matrix",
    "identity_matrix",
    "inverse_matrix",
    "is_same_transform",
    "quaternion_about_axis",
    "quaternion_conjugate",
    "quaternion_from_euler",
    "quaternion_from_matrix",
    "quaternion_inverse",
    "quaternion_matrix",
    "quaternion_multiply",
    "quaternion_slerp",
    "random_quaternion",
    "rotation_from_matrix",
    "rotation_matrix",
    "translation_from_matrix",
    "translation_matrix",
    "unit_vector",
    "vector_norm",
]
