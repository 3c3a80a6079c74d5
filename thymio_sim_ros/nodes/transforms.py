"""/tf and /tf_static of all robots (ros-interface.md sections 4.1 and 8).

`odom → base_link` is the wheels' odometry and how the robot leans; `map → odom` makes up for its drift, so that
`map → base_link` is the truth (perfect localisation); the wheels turn by their angles.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from rclpy.node import Node

from thymio_sim_ros.nodes import qos, tf_messages
from thymio_sim_ros.nodes.convert import quaternion
from thymio_sim_ros.nodes.description import fixed_frames, wheel_position
from thymio_sim_ros.nodes.names import MAP_FRAME, SIDES, RobotNames
from thymio_sim_ros.nodes.tf_messages import Transform
from thymio_sim_ros.sim.geometry import LEVEL, Pose, Tilt
from thymio_sim_ros.sim.readings import MotorReading, PoseReading, Reading

NO_TURN = (0.0, 0.0, 0.0, 1.0)


class Transforms:
    """Publishes transforms from readings; silent where the type cannot be had (`tf_messages.available`)."""

    def __init__(self, node: Node) -> None:
        self._moving = self._static = None
        if tf_messages.available():
            self._moving = node.create_publisher(tf_messages.TFMessage, "/tf", qos.TRANSFORMS)
            self._static = node.create_publisher(tf_messages.TFMessage, "/tf_static", qos.LATCHED)
        self._angles: dict[str, tuple[float, float]] = {}

    def begin(self, robots: Sequence[RobotNames]) -> None:
        """Latched frames of these robots, all in one message."""
        self._angles.clear()
        if self._static is None:
            return
        transforms = [
            Transform(0, names.frame("base_link"), names.frame(frame.name), frame.position, frame.quaternion)
            for names in robots
            for frame in fixed_frames()
        ]
        self._static.publish(tf_messages.encode(transforms))

    def take(self, names: RobotNames, sensor: str, reading: Reading) -> None:
        """Remember wheel angles; with each pose publish the robot's moving frames."""
        if isinstance(reading, MotorReading):
            self._angles[names.name] = reading.angles_rad
        elif isinstance(reading, PoseReading) and self._moving is not None:
            self._moving.publish(tf_messages.encode(self._frames(names, reading)))

    def _frames(self, names: RobotNames, reading: PoseReading) -> list[Transform]:
        ns, base, odom = reading.stamp_ns, names.frame("base_link"), names.frame("odom")
        frames = [
            _planar(ns, MAP_FRAME, odom, origin_of(reading.truth, reading.odometry)),
            _planar(ns, odom, base, reading.odometry, reading.tilt),
        ]
        for side, angle in zip(SIDES, self._angles.get(names.name, (0.0, 0.0)), strict=True):
            turn = (0.0, math.sin(angle / 2), 0.0, math.cos(angle / 2))
            frames.append(Transform(ns, base, names.frame(f"{side}_wheel_link"), wheel_position(side), turn))
        return frames


def origin_of(truth: Pose, odometry: Pose) -> Pose:
    """Where odometry's origin lies in the world: truth · odometry⁻¹."""
    yaw = truth.yaw_rad - odometry.yaw_rad
    cos, sin = math.cos(yaw), math.sin(yaw)
    return Pose(
        truth.x_m - cos * odometry.x_m + sin * odometry.y_m, truth.y_m - sin * odometry.x_m - cos * odometry.y_m, yaw
    )


def _planar(ns: int, frame: str, child: str, pose: Pose, tilt: Tilt = LEVEL) -> Transform:
    turn = quaternion(pose.yaw_rad, tilt)
    return Transform(ns, frame, child, (pose.x_m, pose.y_m, 0.0), (turn.x, turn.y, turn.z, turn.w))
