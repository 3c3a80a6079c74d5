"""The topics and services of one robot: made with it, destroyed with it.

Publishing turns readings into messages by the rows of `convert`; subscribing turns messages into
commands and posts them. Topics that nobody listens to cost a count, nothing more.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from geometry_msgs.msg import PoseWithCovarianceStamped, TwistStamped
from geometry_msgs.msg import Twist as TwistMsg
from rclpy.node import Node
from rclpy.qos import QoSProfile
from std_msgs.msg import Bool, Empty, Float64MultiArray, String
from std_srvs.srv import Empty as EmptyService
from std_srvs.srv import Trigger

from thymio_sim_ros.nodes import command_topics, convert, operator_topics, plugin_topics, qos
from thymio_sim_ros.nodes.command_topics import CommandRow
from thymio_sim_ros.nodes.convert import CommandError, ConvertOptions, Row
from thymio_sim_ros.nodes.description import urdf
from thymio_sim_ros.nodes.headers import SECOND_NS
from thymio_sim_ros.nodes.names import RobotNames
from thymio_sim_ros.sim import commands
from thymio_sim_ros.sim.commands import Command
from thymio_sim_ros.sim.placement import PlacementError
from thymio_sim_ros.sim.readings import Reading
from thymio_sim_ros.sim.sensors import all_sensors

Post = Callable[[Command], None]

WARN_EVERY_S = 5.0


class RobotPorts:
    """Publishers, subscriptions and services of one robot on the simulator's node."""

    def __init__(
        self,
        node: Node,
        names: RobotNames,
        post: Post,
        *,
        options: ConvertOptions,
        now_ns: Callable[[], int],
        timeout_ns: Callable[[], int],
    ) -> None:
        self.names = names
        self.options = options
        self._node = node
        self._post = post
        self._timeout_ns = timeout_ns
        self._now_ns = now_ns
        self._publishers: dict[str, list[tuple[Row, Any]]] = {
            sensor.name: [
                (row, node.create_publisher(row.type, names.topic(row.topic), row.profile))
                for row in convert.rows_of(sensor)
            ]
            for sensor in all_sensors()
        }
        self._last: dict[str, Any] = {}
        self._description = node.create_publisher(String, names.topic("robot_description"), qos.LATCHED)
        self._description.publish(String(data=urdf(names)))
        self._subscriptions = [
            node.create_subscription(kind, names.topic(topic), self._guarded(topic, handle), profile)
            for topic, kind, handle, profile in self._inputs()
        ]
        self._services = [
            node.create_service(EmptyService, names.topic("is_ready"), lambda _request, response: response),
            node.create_service(Trigger, names.topic("reset_odometry"), self._reset_odometry),
        ]

    def publish(self, sensor: str, reading: Reading) -> None:
        """Send one reading on every topic made from it."""
        for row, publisher in self._publishers[sensor]:
            if row.every_ns and reading.stamp_ns % row.every_ns:
                continue
            if not row.always and not publisher.get_subscription_count():
                continue
            message = row.encode(reading, self.names, self.options)
            if message is None:
                continue
            if row.on_change:
                if self._last.get(row.topic) == message:
                    continue
                self._last[row.topic] = message
            publisher.publish(message)

    def forget(self) -> None:
        """Send the next reading of every kind, also an unchanged one: the world was reset."""
        self._last.clear()

    def close(self) -> None:
        """Take all topics and services of this robot out of the graph."""
        for service in self._services:
            self._node.destroy_service(service)
        for subscription in self._subscriptions:
            self._node.destroy_subscription(subscription)
        for ports in self._publishers.values():
            for _, publisher in ports:
                self._node.destroy_publisher(publisher)
        self._node.destroy_publisher(self._description)

    def _inputs(self) -> list[tuple[str, type, Callable[[Any], None], QoSProfile]]:
        """Topic, type, handler and profile of everything this robot listens to (ros-interface.md section 4.2)."""
        return [
            ("cmd_vel", TwistMsg, self._on_twist, qos.COMMAND),
            ("cmd_vel_stamped", TwistStamped, self._on_stamped_twist, qos.COMMAND),
            ("wheels/command", Float64MultiArray, self._on_wheels, qos.COMMAND),
            *(
                (row.topic, row.type, self._poster(row), row.profile)
                for row in (*command_topics.ROWS, *operator_topics.ROWS, *plugin_topics.rows())
            ),
            ("led/off", Empty, self._on_leds_off, qos.LEDS),
            *((f"press/{button}", Bool, self._press(button), qos.EVENTS) for button in commands.BUTTONS),
            ("initialpose", PoseWithCovarianceStamped, self._on_pose, qos.COMMAND),
        ]

    def _guarded(self, topic: str, handle: Callable[[Any], None]) -> Callable[[Any], None]:
        def callback(message: Any) -> None:
            try:
                handle(message)
            except (CommandError, PlacementError) as error:
                self._node.get_logger().warning(
                    f"{self.names.topic(topic)} refused: {error}", throttle_duration_sec=WARN_EVERY_S
                )

        return callback

    def _on_twist(self, message: TwistMsg) -> None:
        self._post(convert.body_twist(message, self._timeout_ns()))

    def _on_stamped_twist(self, message: TwistStamped) -> None:
        timeout_ns = self._timeout_ns()
        sent_ns = message.header.stamp.sec * SECOND_NS + message.header.stamp.nanosec
        age_ns = self._now_ns() - sent_ns
        if timeout_ns and sent_ns and age_ns > timeout_ns:
            raise CommandError(f"stamp is {age_ns / 1e9:.3f} s old, expected at most {timeout_ns / 1e9:.3f} s")
        self._post(convert.body_twist(message.twist, timeout_ns))

    def _on_wheels(self, message: Float64MultiArray) -> None:
        self._post(convert.wheel_velocities(message.data, self._timeout_ns()))

    def _poster(self, row: CommandRow) -> Callable[[Any], None]:
        return lambda message: self._post(row.decode(message))

    def _on_leds_off(self, _message: Empty) -> None:
        for group, size in commands.LED_GROUPS.items():
            self._post(commands.SetLeds(group, (0,) * size))

    def _press(self, button: str) -> Callable[[Bool], None]:
        return lambda message: self._post(commands.PressButton(button, bool(message.data)))

    def _on_pose(self, message: PoseWithCovarianceStamped) -> None:
        pose = message.pose.pose
        yaw = convert.yaw_of(pose.orientation)
        if not all(map(math.isfinite, (pose.position.x, pose.position.y, yaw))):
            raise CommandError("pose has a value that is not finite")
        self._post(commands.MoveRobot(pose.position.x, pose.position.y, yaw))

    def _reset_odometry(self, _request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        self._post(commands.ResetOdometry())
        response.success = True
        response.message = "odometry starts again from zero: odom -> base_link jumps once"
        return response
