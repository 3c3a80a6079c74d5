"""A robot behind an Aseba network on ROS: its topics, its transforms, and the link by which it is reached.

In a simulation, the simulator's node has the topics of the robot's body. Here the runtime's node has those that a real
robot can serve, by the same tables; the others do not exist, which is logged once.
"""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Mapping
from typing import Any

from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.node import Node
from std_msgs.msg import String

from aseba_vm.protocol import encode
from thymio_sim_ros.device.remote.commands import LED_NATIVES, MOTORS
from thymio_sim_ros.device.remote.remote_robot import RemoteRobot
from thymio_sim_ros.device.remote.ros_handlers import served_natives
from thymio_sim_ros.device.remote.sensing import POSE
from thymio_sim_ros.network.robot_link import LinkEvent, LinkLost, LinkOpened, LinkReceived, RobotLink
from thymio_sim_ros.network.robot_target import Target
from thymio_sim_ros.ros.interface import qos, sensor_topics
from thymio_sim_ros.ros.interface.command_checks import CommandError
from thymio_sim_ros.ros.interface.command_topics import led_topic
from thymio_sim_ros.ros.interface.convert_readings import ConvertOptions
from thymio_sim_ros.ros.interface.headers import SECOND_NS
from thymio_sim_ros.ros.interface.names import RobotNames
from thymio_sim_ros.ros.interface.robot_inputs import InputContext, robot_inputs
from thymio_sim_ros.ros.interface.subscriber_demand import SubscriberDemand
from thymio_sim_ros.ros.rclpy_ext.mailbox import Mailbox
from thymio_sim_ros.ros.rclpy_ext.message_reports import MessageReports
from thymio_sim_ros.ros.simulator.robot_endpoints import EndpointOptions, RobotEndpoints
from thymio_sim_ros.ros.simulator.sensor_list import displayed_sensors
from thymio_sim_ros.ros.simulator.visualization.transforms import Transforms
from thymio_sim_ros.sim.commands import Command, MotorTargets
from thymio_sim_ros.sim.sensors import all_sensors

__all__ = ["RealRobot", "left_out"]

POLL_S = 0.05
"""Period of polls of the variables, and for subscribers: that of odometry in the simulation."""
SHUTDOWN = "shutdown"
"""The input that run control subscribes to, for simulated robots too."""
SENSORS = "simulator/_sensors"
"""Topic on which viewers expect the list of sensors."""
LONGEST_STEP_NS = SECOND_NS // 4
"""Longest time that passes for the link between two calls."""
CAPACITY = 4096
"""Messages of the robot that wait; while there are more, the link does not read."""

NEEDED: Mapping[str, tuple[str, ...]] = {
    **dict.fromkeys(("cmd_vel", "cmd_vel_stamped", "cmd_vel_unstamped", "_wheels/command", "_motor/target"), MOTORS),
    **{led_topic(group): (native,) for group, native in LED_NATIVES.items()},
    "_led/single": ("_leds.set",),
    "_led/off": ("leds.top",),
    "sound/tone": ("sound.freq",),
    "_sound/system": ("sound.system",),
    "_sound_threshold": ("mic.threshold",),
    "_comm/enable": ("prox.comm.enable",),
    "_comm/tx": ("prox.comm.tx",),
}
"""Variables and native functions that a robot needs for an input; it never has the other inputs."""


def left_out(robot: RemoteRobot) -> frozenset[str]:
    """Return the topics of a simulated robot that a real one does not have."""
    sensors = robot.sensing.sensors
    missing = [sensor for sensor in all_sensors() if sensor.name not in sensors]
    rows = {row.topic for sensor in missing for row in sensor_topics.rows_of(sensor)}
    known = robot.device.variables.addresses().keys() | served_natives(robot.target).keys()
    absent = {
        robot_input.topic
        for robot_input in robot_inputs()
        if not known.issuperset(NEEDED.get(robot_input.topic, ("",)))
    }
    return frozenset(rows | absent | {sensor_topics.TRUTH})


class RealRobot:
    """One robot that is reached by a link. Invariant: its topics are those that it can serve, once it has connected."""

    def __init__(
        self,
        node: Node,
        names: RobotNames,
        target: Target,
        *,
        number: int,
        timeout_s: float,
        messages: MessageReports,
    ) -> None:
        """`timeout_s`: time after which a velocity ends."""
        self.robot = RemoteRobot(number)
        """The robot without ROS."""
        self.robot.device.on_run = self.flush
        self.on_connected: Callable[[], None] = lambda: None
        """Called when the robot has connected, and may have another layout."""
        self.on_change: Callable[[], None] = lambda: None
        """Called after each message of the robot."""
        self.convert_options = ConvertOptions()
        """Options for the content of messages."""
        self.messages = messages
        """Takes what is wrong with messages."""
        self._node, self._names, self._target = node, names, target
        self._timeout_ns = round(timeout_s * SECOND_NS)
        self._left_out: frozenset[str] | None = None
        self._endpoints: RobotEndpoints | None = None
        self._demand = SubscriberDemand({sensor.name: sensor.period_ns for sensor in all_sensors()})
        self._transforms = Transforms(node, self._demand)
        self._sensors = node.create_publisher(String, SENSORS, qos.TRANSIENT_LOCAL)
        self._connections = 0
        self._problem = self.robot.problem
        self._clock_ns, self._wall_ns = 0, time.monotonic_ns()
        self._mailbox: Mailbox[LinkEvent] = Mailbox(
            node, self._on_event, weight=lambda event: len(getattr(event, "messages", (event,))), capacity=CAPACITY
        )
        self._link = RobotLink(target, self._mailbox.post, self._mailbox.is_full)
        wall = Clock(clock_type=ClockType.STEADY_TIME)
        self._timer = node.create_timer(POLL_S, self._on_poll, clock=wall)

    def input_context(self) -> InputContext:
        """Return time and time-out for a message that has arrived."""
        return InputContext(self._node.get_clock().now().nanoseconds, self._timeout_ns)

    def post(self, command: Command) -> None:
        """Send a command to the robot. Raises CommandError if it cannot do that, or cannot do it now."""
        try:
            self.robot.execute(command, self._now_ns())
        except ValueError as error:
            raise CommandError(str(error)) from error
        self.flush()

    def flush(self) -> None:
        """Send what waits to be sent."""
        data = b"".join(map(encode, self.robot.pop_messages()))
        if data:
            self._link.send(data)

    def close(self) -> None:
        """Stop the wheels, end the link, destroy the topics."""
        if self.robot.can_drive:
            self.robot.execute(MotorTargets(0, 0), self._now_ns())
        self._mailbox.close()
        self._link.close(b"".join(map(encode, self.robot.pop_messages())))
        self._node.destroy_timer(self._timer)
        if self._endpoints is not None:
            self._endpoints.close()
            self._endpoints = None
        self._node.destroy_publisher(self._sensors)

    def _now_ns(self) -> int:
        """Time of the link; while this thread is late, it passes slower than wall time: messages wait, too."""
        wall_ns = time.monotonic_ns()
        self._clock_ns += min(wall_ns - self._wall_ns, LONGEST_STEP_NS)
        self._wall_ns = wall_ns
        return self._clock_ns

    def _on_event(self, event: LinkEvent) -> None:
        match event:
            case LinkOpened():
                self.robot.start(self._now_ns())
            case LinkReceived(messages=messages):
                for message in messages:
                    self.robot.receive(message)
            case LinkLost(reason=reason):
                self.robot.end(reason)
        self._process()

    def _on_poll(self) -> None:
        self._mailbox.drain()
        if self._endpoints is not None:
            self._endpoints.poll()
            self._transforms.poll()
        self.robot.poll(self._now_ns())
        self._process()

    def _process(self) -> None:
        """Publish and send what the last messages or the time have caused."""
        if self.robot.connections != self._connections:
            self._connections = self.robot.connections
            self._connect()
        self._report_problem()
        self._publish_readings()
        self.on_change()
        self.flush()

    def _connect(self) -> None:
        self._link.confirm()
        self._node.get_logger().info(f"robot {self._target}: connected to {self.robot.name}")
        absent = left_out(self.robot)
        if absent != self._left_out:
            self._left_out = absent
            self._open(absent)
        self.on_connected()

    def _open(self, absent: frozenset[str]) -> None:
        if self._endpoints is not None:
            self._endpoints.close()
        options = EndpointOptions(left_out=absent)
        self._endpoints = RobotEndpoints(self._node, self._names, self, options=options, demand=self._demand)
        self._sensors.publish(String(data=json.dumps(self._displayed())))
        self._transforms.set_robots([self._names] if POSE in self.robot.sensing.sensors else [])
        self._node.get_logger().info(
            f"robot {self._target}: without ground truth, clock and playground, and without these topics of simulated "
            f"robots: {_listed(absent - {SHUTDOWN})}"
        )

    def _displayed(self) -> list[dict[str, Any]]:
        """The sensors that viewers show by their declarations."""
        return [sensor for sensor in displayed_sensors() if sensor["name"] in self.robot.sensing.sensors]

    def _report_problem(self) -> None:
        """Log why the robot is not connected, once for each reason in a row."""
        problem = "" if self.robot.is_connected else self.robot.problem
        if problem != self._problem:
            self._problem = problem
            if problem:
                self._node.get_logger().warning(f"robot {self._target}: not connected ({problem}); trying again")

    def _publish_readings(self) -> None:
        if self._endpoints is None:
            return
        for sensor, reading in self.robot.pop_readings(self._node.get_clock().now().nanoseconds):
            self._endpoints.publish(sensor, reading)
            if sensor == POSE:
                self._transforms.add_reading(self._names, reading, self.robot.sensing.angles_rad)
        self._transforms.flush()


def _listed(topics: frozenset[str]) -> str:
    """Return the topics in order, those of one folder together."""
    return ", ".join(sorted({topic.partition("/")[0] + "/…" if topic.count("/") else topic for topic in topics}))
