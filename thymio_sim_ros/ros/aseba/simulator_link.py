"""The connection of the runtime to a simulator in the same process whose endpoints do not match its own."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from rclpy.node import Node

__all__ = ["SimulatorLink"]


@dataclass(frozen=True, slots=True)
class SimulatorLink:
    """Replaces matching within the process, in both directions."""

    inputs: Node
    """A node of another participant, which subscribes to the simulator's topics for the runtime."""

    post: Callable[[str, str, Any], None]
    """Passes a command to the simulator: ROS name of the robot, topic without that name, message. Thread-safe."""
