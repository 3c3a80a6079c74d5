"""The access of one robot's endpoints to the simulator."""

from __future__ import annotations

from collections.abc import Mapping

from thymio_sim_ros.ros.interface.convert_readings import ConvertOptions
from thymio_sim_ros.ros.interface.headers import SECOND_NS
from thymio_sim_ros.ros.interface.names import RobotNames
from thymio_sim_ros.ros.interface.robot_inputs import InputContext
from thymio_sim_ros.ros.rclpy_ext.message_reports import MessageReports
from thymio_sim_ros.ros.simulator.parameters import CurrentParams
from thymio_sim_ros.ros.simulator.visualization.transforms import frames_of
from thymio_sim_ros.ros.simulator.world_runner import WorldRunner
from thymio_sim_ros.sim.commands import Command
from thymio_sim_ros.sim.model.geometry import Pose

__all__ = ["RobotAccess"]


class RobotAccess:
    """Implements `RobotOwner` for one robot. The robot may be removed while messages for it are still queued."""

    def __init__(
        self, robot: str, names: RobotNames, runner: WorldRunner, params: CurrentParams, messages: MessageReports
    ) -> None:
        """`robot`: name in the world."""
        self._robot, self._names = robot, names
        self._runner, self._params = runner, params
        self.messages = messages
        """Reports on what is wrong with messages."""

    @property
    def convert_options(self) -> ConvertOptions:
        """The current options for the content of messages."""
        return self._params.convert_options

    def input_context(self) -> InputContext:
        """Execute deferred ticks and return time, time-out and frames for a message that has arrived."""
        self._runner.catch_up()
        timeout_ns = round(self._params.values.cmd_vel_timeout * SECOND_NS)
        return InputContext(self._runner.world.now_ns, timeout_ns, self._frames)

    def post(self, command: Command) -> None:
        """Execute deferred ticks and post a command to the world; dropped if the robot has been removed."""
        self._runner.catch_up()
        if self._robot in self._runner.world.robots:
            self._runner.post(self._robot, command)

    def _frames(self) -> Mapping[str, Pose]:
        robot = self._runner.world.robots.get(self._robot)
        return {} if robot is None else frames_of(self._names, robot.pose, robot.wheels.odometry)
