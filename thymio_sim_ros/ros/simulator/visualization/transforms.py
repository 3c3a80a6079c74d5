"""Publishes /tf and /tf_static of all robots (docs/spec/ros-interface.md sections 4.1 and 8).

`odom → base_link` is the wheel odometry and the tilt of the robot; `map → odom` compensates the drift, so that
`map → base_link` is the true pose (perfect localization). Topics without subscribers cost nothing.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile

from thymio_sim_ros.ros.compat import tf2_messages
from thymio_sim_ros.ros.compat.tf2_messages import Transform
from thymio_sim_ros.ros.interface import qos
from thymio_sim_ros.ros.interface.names import MAP_FRAME, SIDES, RobotNames
from thymio_sim_ros.ros.interface.rotations import rotation, wheel_rotation
from thymio_sim_ros.ros.interface.subscriber_demand import SubscriberDemand, TopicDemand
from thymio_sim_ros.ros.simulator.visualization.urdf import FixedFrame, fixed_frames, wheel_position
from thymio_sim_ros.sim.model.geometry import LEVEL, Pose, Tilt
from thymio_sim_ros.sim.model.readings import PoseReading, Reading

__all__ = ["POSE_SENSOR", "TransformOptions", "Transforms", "frames_of", "origin_of"]


@dataclass(frozen=True, slots=True)
class TransformOptions:
    """Whether to publish `map → odom`, wheel frames and fixed frames, and whether in each robot's namespace.

    `has_lidar`: whether the robots have a lidar. `frames`: further frames that are fixed at the robot's origin.
    `is_localized`: whether `map → odom` compensates the drift of the odometry; else it stays as at the start.
    """

    publish_map: bool = True
    publish_wheels: bool = True
    publish_static: bool = True
    namespaced: bool = False
    has_lidar: bool = False
    frames: tuple[str, ...] = ()
    is_localized: bool = True


POSE_SENSOR = "pose"
"""The sensor whose readings are the source of transforms."""

MOVING_FRAMES = TopicDemand(POSE_SENSOR)


class _TransformTopic:
    """Publishers of `tf` or `tf_static`, one per namespace, with the transforms collected for the next message."""

    def __init__(self, node: Node, word: str, profile: QoSProfile, demand: SubscriberDemand | None = None) -> None:
        """`demand` counts the topics with subscribers."""
        self.word = word
        self._node, self._profile, self._demand = node, profile, demand
        self._publishers: dict[str, Publisher[tf2_messages.TFMessage]] = {}
        self._heard: set[str] = set()
        self._waiting: dict[str, list[Transform]] = {}

    def open(self, topics: set[str]) -> None:
        """Create publishers of these topics and destroy all others."""
        self._waiting.clear()
        for topic in self._publishers.keys() - topics:
            self._set_demand(topic, 0)
            self._node.destroy_publisher(self._publishers.pop(topic))
        for topic in topics - self._publishers.keys():
            self._publishers[topic] = self._node.create_publisher(tf2_messages.TFMessage, topic, self._profile)

    def poll(self) -> None:
        """Find out which topics have subscribers."""
        for topic, publisher in self._publishers.items():
            self._set_demand(topic, publisher.get_subscription_count())

    def has_subscribers(self, topic: str) -> bool:
        """Whether a topic has subscribers."""
        return topic in self._heard

    def add(self, topic: str, transforms: Sequence[Transform]) -> None:
        """Add transforms to the next message."""
        self._waiting.setdefault(topic, []).extend(transforms)

    def flush(self) -> None:
        """Publish the collected transforms, one message per topic."""
        for topic, transforms in self._waiting.items():
            self._publishers[topic].publish(tf2_messages.encode(transforms))
        self._waiting.clear()

    def _set_demand(self, topic: str, subscribers: int) -> None:
        if self._demand is None or (subscribers > 0) == (topic in self._heard):
            return
        if subscribers:
            self._heard.add(topic)
            self._demand.add(MOVING_FRAMES)
        else:
            self._heard.remove(topic)
            self._demand.remove(MOVING_FRAMES)


class Transforms:
    """Publishes transforms from readings; does nothing if the type is not available (`tf2_messages.available`)."""

    def __init__(self, node: Node, demand: SubscriberDemand, options: TransformOptions | None = None) -> None:
        self._options = options or TransformOptions()
        self._is_on = tf2_messages.available()
        self._moving = _TransformTopic(node, "tf", qos.TRANSFORMS, demand)
        self._static = _TransformTopic(node, "tf_static", qos.TRANSIENT_LOCAL)
        self._origins: dict[RobotNames, Pose] = {}
        """Origin of the odometry at the first reading, where it is published unchanged."""
        if not self._options.is_localized:
            demand.add(MOVING_FRAMES)  # else a late subscriber would determine when the first reading is

    def restart(self) -> None:
        """Begin again with a new or reset world."""
        self._origins.clear()

    def set_robots(self, robots: Sequence[RobotNames]) -> None:
        """Publish the static frames of these robots, in one message per topic."""
        if not self._is_on:
            return
        self._moving.open({self._topic(names, self._moving) for names in robots})
        if not self._options.publish_static:
            return
        self._static.open({self._topic(names, self._static) for names in robots})
        for names in robots:
            base = names.frame("base_link")
            fixed = [
                Transform(0, base, names.fixed_frame(frame.name), frame.position, frame.quaternion)
                for frame in (
                    *fixed_frames(has_lidar=self._options.has_lidar, base=names.frames.base_link),
                    *(FixedFrame(name, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)) for name in self._options.frames),
                )
            ]
            self._static.add(self._topic(names, self._static), fixed)
        self._static.flush()

    def add_reading(self, names: RobotNames, reading: Reading, angles_rad: tuple[float, float]) -> None:
        """Add the moving frames of a robot from a pose reading and its wheel angles; `flush` publishes them."""
        if not isinstance(reading, PoseReading):
            return
        origin = origin_of(reading.truth, reading.odometry)
        if not self._options.is_localized:
            origin = self._origins.setdefault(names, origin)
        topic = self._topic(names, self._moving)
        if self._moving.has_subscribers(topic):
            self._moving.add(topic, self._frames(names, reading, origin, angles_rad))

    def poll(self) -> None:
        """Find out which moving frames have subscribers."""
        self._moving.poll()

    def flush(self) -> None:
        """Publish the transforms of this tick."""
        self._moving.flush()

    def _topic(self, names: RobotNames, channel: _TransformTopic) -> str:
        return names.topic(channel.word) if self._options.namespaced else f"/{channel.word}"

    def _frames(
        self, names: RobotNames, reading: PoseReading, origin: Pose, angles_rad: tuple[float, float]
    ) -> list[Transform]:
        ns = reading.stamp_ns
        world, odom, base, *wheels = _moving_frames(names)
        frames = [_planar(ns, odom, base, reading.odometry, reading.tilt, reading.height_m)]
        if self._options.publish_map:
            frames.insert(0, _planar(ns, world, odom, origin))
        if self._options.publish_wheels:
            for wheel, place, angle in zip(wheels, _WHEELS, angles_rad, strict=True):
                frames.append(Transform(ns, base, wheel, place, wheel_rotation(angle)))
        return frames


_WHEELS = tuple(map(wheel_position, SIDES))


@cache
def _moving_frames(names: RobotNames) -> tuple[str, ...]:
    """Return the frame names of map, odometry, robot and wheels."""
    return tuple(
        names.frame(usual) for usual in (MAP_FRAME, "odom", "base_link", *(f"{side}_wheel_link" for side in SIDES))
    )


def origin_of(truth: Pose, odometry: Pose) -> Pose:
    """Return the pose of the odometry origin in the world: truth · odometry⁻¹."""
    yaw = truth.yaw_rad - odometry.yaw_rad
    cos, sin = math.cos(yaw), math.sin(yaw)
    return Pose(
        truth.x_m - cos * odometry.x_m + sin * odometry.y_m, truth.y_m - sin * odometry.x_m - cos * odometry.y_m, yaw
    )


def frames_of(names: RobotNames, truth: Pose, odometry: Pose) -> dict[str, Pose]:
    """Return the poses of the frames of world, odometry and robot in the world, by frame name."""
    places = {MAP_FRAME: Pose(0.0, 0.0, 0.0), "odom": origin_of(truth, odometry), "base_link": truth}
    return {names.frame(usual): place for usual, place in places.items()}


def _planar(ns: int, frame: str, child: str, pose: Pose, tilt: Tilt = LEVEL, height_m: float = 0.0) -> Transform:
    return Transform(ns, frame, child, (pose.x_m, pose.y_m, height_m), rotation(pose.yaw_rad, tilt))
