"""The connection of the runtime to a simulator in the same process whose endpoints do not match its own."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Any

from rclpy.node import Node

__all__ = ["Post", "SimulatorLink"]

Post = Callable[[str, str, Any], None]
"""Takes a command: ROS name of the robot, topic without that name, message. Thread-safe."""


class SimulatorLink:
    """Replaces matching within the process, in both directions."""

    def __init__(self, make_inputs: Callable[[], Node], post: Post) -> None:
        """`post` passes commands to the simulator."""
        self._make_inputs, self.post = make_inputs, post

    @cached_property
    def inputs(self) -> Node:
        """A node of another participant, which subscribes to the simulator's topics for the runtime.

        Created when it is first used, after the endpoints of all robots: a participant that exists already discovers
        them one by one, which takes twice as long.
        """
        return self._make_inputs()
