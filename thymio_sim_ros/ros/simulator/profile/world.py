"""The world and its robots as the rows of a profile use them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

from thymio_sim_ros.ros.interface.names import RobotNames
from thymio_sim_ros.sim.model.geometry import Pose, Twist
from thymio_sim_ros.sim.model.primitives import Color
from thymio_sim_ros.sim.playground.reader import RobotStart

if TYPE_CHECKING:
    from rclpy.node import Node

    from thymio_sim_ros.ros.rclpy_ext.message_reports import MessageReports
    from thymio_sim_ros.ros.simulator.world_runner import WorldRunner
    from thymio_sim_ros.sim.commands import Command
    from thymio_sim_ros.sim.model.readings import Reading
    from thymio_sim_ros.sim.physics import Contact
    from thymio_sim_ros.sim.robot.robot import Robot

__all__ = ["RunningRobot", "RunningWorld"]

S = TypeVar("S")


class RunningWorld:
    """Implements `ProfileWorld`. Only for the thread of the simulator's executor, at the present tick."""

    def __init__(self, node: Node, runner: WorldRunner, messages: MessageReports) -> None:
        """`node` is that of the profile."""
        self.runner = runner
        self._node, self._messages = node, messages
        self._robots: dict[str, RunningRobot] = {}

    @property
    def now_ns(self) -> int:
        """The simulated time."""
        return self.runner.world.now_ns

    @property
    def robots(self) -> Mapping[str, RunningRobot]:
        """The robots that have endpoints, by their names in the world."""
        return self._robots

    def add(self, name: str, names: RobotNames) -> RunningRobot:
        """Add a robot of the world."""
        self._robots[name] = robot = RunningRobot(self, name, names)
        return robot

    def forget(self, name: str) -> None:
        """Forget a robot that has gone."""
        self._robots.pop(name, None)

    def spawn(self, start: RobotStart) -> None:
        """Add a robot. Raises ValueError for a name or a place that is taken, or no ground."""
        self.runner.spawn(start)
        self.runner.update_robots()

    def remove(self, robot: str) -> None:
        """Remove a robot."""
        self.runner.engine.remove(robot)
        self.runner.update_robots()

    def reset(self) -> None:
        """Reset world, time and noise to the start."""
        self.runner.reset()

    def clear(self) -> None:
        """Erase everything that pens drew."""
        self.runner.engine.erase_drawings()

    def paint(self, color: Color) -> None:
        """Give the first ground of the playground another color, 0…1 each; a reset ends it."""
        self.runner.paint_ground(color)

    def report(self, about: str, reason: object) -> None:
        """Report that a request or a message was refused, in the log, on the page and to `thymio-sim doctor`."""
        self._messages.add_rejected(about, reason)

    def warn(self, text: str) -> None:
        """Log a warning."""
        self._node.get_logger().warning(text)


class RunningRobot:
    """Implements `ProfileRobot`."""

    def __init__(self, world: RunningWorld, name: str, names: RobotNames) -> None:
        self.world, self.name, self.names = world, name, names
        self.memory: dict[str, Any] = {}

    @property
    def pose(self) -> Pose:
        """The true pose, in m and rad."""
        return self._robot.pose

    @property
    def odometry(self) -> Pose:
        """The pose by odometry, in m and rad."""
        return self._robot.wheels.odometry

    @property
    def speeds(self) -> Twist:
        """The true speeds, in m/s and rad/s."""
        return self._robot.twist

    @property
    def is_fallen(self) -> bool:
        """Whether it fell off an edge."""
        return self._robot.is_fallen

    @property
    def is_lifted(self) -> bool:
        """Whether an operator holds it over the ground."""
        return self._robot.is_lifted

    @property
    def is_touching(self) -> bool:
        """Whether it touches something."""
        return bool(self._robot.body.touching)

    @property
    def contacts(self) -> Sequence[Contact]:
        """Where it touches something, in order of the names."""
        return sorted(self._robot.body.touching.values(), key=lambda contact: contact.other)

    @property
    def floor_color(self) -> Color | None:
        """The color of the ground below its middle, drawings included; None without ground."""
        pose = self.pose
        return self.world.runner.world.color_at(pose.x_m, pose.y_m)

    def read(self, sensor: str) -> Reading | None:
        """Return the present reading of a sensor without memory."""
        return self.world.runner.world.read(self.name, sensor)

    def state(self, kind: type[S]) -> S:
        """Return the state of an actuator or stimulus, by its type."""
        return self._robot.state(kind)

    def post(self, command: Command) -> None:
        """Post a command. Raises PlacementError for a place that is not free."""
        self.world.runner.post(self.name, command)

    @property
    def _robot(self) -> Robot:
        return self.world.runner.world.robots[self.name]
