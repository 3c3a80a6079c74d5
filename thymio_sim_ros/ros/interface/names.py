"""Names of topics and frames of one robot (docs/spec/ros-interface.md sections 2 and 8).

A playground with one robot uses the empty name: `odom`, frame `base_link`. With several, the robot's
name is the namespace and the prefix of its frames and joints: `thymio_1/odom`, `thymio_1/base_link`.
All names of topics and services except `GLOBAL` are relative to the namespace of the node.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass

from rclpy.node import Node

PROXIMITY = ("left", "center_left", "center", "center_right", "right", "rear_left", "rear_right")
"""Names of the seven proximity sensors in Thymio's order 0…6."""

SIDES = ("left", "right")

GLOBAL = ("/clock", "/diagnostics", "/tf", "/tf_static")
"""Topics with the same name in all namespaces, as ROS tools expect."""

HIDDEN = "_"
"""First character of a hidden word: `ros2 topic list` omits topics with such a word in their name (docs/ros.md)."""

MAP_FRAME = "map"
SCAN_FRAME = "base_scan"
"""Frame of the lidar."""


@dataclass(frozen=True, slots=True)
class FrameNames:
    """Names of frames and joints that the user can choose; all except `map` get the robot's prefix."""

    map: str = MAP_FRAME
    odom: str = "odom"
    base_link: str = "base_link"
    left_wheel_joint: str = "left_wheel_joint"
    right_wheel_joint: str = "right_wheel_joint"


DEFAULT_FRAMES = FrameNames()


@dataclass(frozen=True, slots=True)
class RobotNames:
    """Topic and frame names of one robot.

    `name` is empty for a single robot. `prefix` is that of its frames; None is the name.
    """

    name: str
    prefix: str | None = None
    frames: FrameNames = DEFAULT_FRAMES

    def topic(self, relative: str) -> str:
        """Return a topic or service name, relative to the node's namespace."""
        return f"{self.name}/{relative}" if self.name else relative

    def frame(self, relative: str) -> str:
        """Return the name of a frame or joint; `relative` is the default one."""
        if relative == MAP_FRAME:
            return self.frames.map
        return self.fixed_frame(getattr(self.frames, relative, relative))

    def fixed_frame(self, name: str) -> str:
        """Return the name of a frame with its prefix, as it is."""
        prefix = self.name if self.prefix is None else self.prefix
        return f"{prefix}/{name}" if prefix else name


@dataclass(frozen=True, slots=True)
class Naming:
    """Assigns ROS names to the robots of a simulation.

    `prefix` precedes the prefix of each robot's frames. `namespaced_tf`: frames have no prefix and are published on
    `tf` in the robot's namespace. `keeps_names`: a single robot keeps its name too.
    """

    prefix: str = ""
    namespaced_tf: bool = False
    keeps_names: bool = False
    frames: FrameNames = DEFAULT_FRAMES

    def one(self, robot: str) -> RobotNames:
        """Return the names of a robot that is added to others."""
        if self.namespaced_tf:
            return RobotNames(robot, "", self.frames)
        return RobotNames(robot, "/".join(part for part in (self.prefix, robot) if part), self.frames)

    def all(self, robots: Iterable[str]) -> dict[str, RobotNames]:
        """Return ROS names by name in the world, for the robots of one playground."""
        robots = tuple(robots)
        if len(robots) == 1 and not self.keeps_names:
            return {robots[0]: self.one("")}
        return {robot: self.one(robot) for robot in robots}


def ros_names(robots: tuple[str, ...]) -> dict[str, RobotNames]:
    """Return ROS names by name in the world, with the default options."""
    return Naming().all(robots)


def is_hidden(topic: str) -> bool:
    """Whether `ros2 topic list` omits this topic, because a word of its name begins with `_`."""
    return any(word.startswith(HIDDEN) for word in topic.split("/"))


def full_name(node: Node, topic: str) -> str:
    """Return the full name of a topic of a node, for messages to the user; remappings are ignored."""
    return topic if topic.startswith("/") else f"{node.get_namespace().rstrip('/')}/{topic}"


def raw_topic(sensor: str) -> str:
    """Return the topic with the integer readings of a sensor, relative to the robot's namespace."""
    return f"_raw/{sensor}"


def topic_word(event: str) -> str:
    """Return the name of an Aseba event as one word of a topic name (docs/spec/ros-interface.md section 6.1)."""
    word = re.sub(r"[^A-Za-z0-9_]", "_", event)
    return f"_{word}" if word[:1].isdigit() else word
