"""Names of topics and frames of one robot (ros-interface.md sections 2 and 8).

A playground with one robot uses the empty name: `/odom`, frame `base_link`. With several, the robot's
name is the namespace and the prefix of its frames and joints: `/thymio_1/odom`, `thymio_1/base_link`.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

PROXIMITY = ("left", "center_left", "center", "center_right", "right", "rear_left", "rear_right")
"""Names of the seven proximity sensors in Thymio's order 0…6."""

SIDES = ("left", "right")

MAP_FRAME = "map"


@dataclass(frozen=True, slots=True)
class RobotNames:
    """Topic and frame names of one robot; `name` is empty where it is the only one."""

    name: str

    def topic(self, relative: str) -> str:
        """Absolute topic name."""
        return f"/{self.name}/{relative}" if self.name else f"/{relative}"

    def frame(self, relative: str) -> str:
        """Frame or joint name."""
        return f"{self.name}/{relative}" if self.name else relative


def ros_names(robots: tuple[str, ...]) -> dict[str, RobotNames]:
    """World name → names in ROS, for the robots of one playground."""
    if len(robots) == 1:
        return {robots[0]: RobotNames("")}
    return {robot: RobotNames(robot) for robot in robots}


def topic_word(event: str) -> str:
    """The name of an Aseba event as one word of a topic name (ros-interface.md section 6.1)."""
    word = re.sub(r"[^A-Za-z0-9_]", "_", event)
    return f"_{word}" if word[:1].isdigit() else word
