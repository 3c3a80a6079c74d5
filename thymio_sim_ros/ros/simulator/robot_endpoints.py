"""The topics and services of one robot: made with it, destroyed with it.

Publishing turns readings into messages by the rows of `sensor_topics`; subscribing turns messages into commands and
posts them. Topics that nobody hears cost nothing but a look now and then.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from rclpy.node import Node
from std_msgs.msg import String
from std_srvs.srv import Empty as EmptyService
from std_srvs.srv import Trigger

from thymio_sim_ros.ros.interface import qos, sensor_topics
from thymio_sim_ros.ros.interface.cdr_templates import Template
from thymio_sim_ros.ros.interface.command_checks import CommandError
from thymio_sim_ros.ros.interface.convert_readings import ConvertOptions
from thymio_sim_ros.ros.interface.driver_topics import DriverTopics
from thymio_sim_ros.ros.interface.names import HIDDEN, RobotNames, full_name
from thymio_sim_ros.ros.interface.sensor_topics import Row
from thymio_sim_ros.ros.rclpy_ext import raw_publisher
from thymio_sim_ros.ros.rclpy_ext.throttled_log import ThrottledLog
from thymio_sim_ros.ros.simulator.robot_inputs import InputContext, RobotInput, robot_inputs
from thymio_sim_ros.ros.simulator.subscriber_demand import SubscriberDemand, TopicDemand
from thymio_sim_ros.ros.simulator.urdf import urdf
from thymio_sim_ros.sim import commands
from thymio_sim_ros.sim.commands import Command
from thymio_sim_ros.sim.model.geometry import Pose, Tilt, Twist
from thymio_sim_ros.sim.model.readings import PoseReading, Reading
from thymio_sim_ros.sim.playground.placement import PlacementError
from thymio_sim_ros.sim.sensors import all_sensors

__all__ = ["DESCRIPTION", "DESCRIPTION_TOPIC", "SERVICES", "EndpointOptions", "RobotEndpoints", "first_words"]

Post = Callable[[Command], None]

DESCRIPTION = "robot_description"
DESCRIPTION_TOPIC = (String, "the robot as URDF, made of primitives, with turning wheels")

SERVICES: Mapping[str, tuple[type, str]] = {
    "is_ready": (EmptyService, "answers when the robot is in the world"),
    "reset_odometry": (Trigger, "the odometry starts again from zero: `odom -> base_link` jumps once"),
}
"""Type and meaning of every service of a robot."""


def first_words() -> frozenset[str]:
    """First words of a robot's topics, where there is more than one, and of what a program adds.

    Of hidden ones also without the `_`: the driver's names.
    """
    rows = (row.topic for sensor in all_sensors() for row in sensor_topics.rows_of(sensor))
    topics = (*rows, *(one.topic for one in robot_inputs()), "aseba/")
    words = {topic.partition("/")[0] for topic in topics if "/" in topic}
    return frozenset(words | {word.removeprefix(HIDDEN) for word in words})


@dataclass(frozen=True, slots=True)
class EndpointOptions:
    """What a user may choose about the topics of all robots, once; `every_ns`: of topics with a rate of their own.

    `extra`: what there is besides.
    """

    stamped_cmd_vel: bool = False
    left_out: frozenset[str] = frozenset()
    every_ns: Mapping[str, int] = field(default_factory=dict)
    extra: DriverTopics = field(default_factory=DriverTopics)


@dataclass(slots=True)
class _SensorPublisher:
    """The publisher of a row, how the audience counts it, when it may send again; what it told last of what changes."""

    row: Row
    heard: TopicDemand
    next_ns: int
    publisher: Any = None
    send: Callable[[bytes], None] = lambda _data: None
    """Sends a serialised message."""
    count: Callable[[], int] = lambda: 0
    """Tells how many listen."""
    is_sent: bool = False
    last: Any = None
    is_stale: bool = False
    """Whether it has told what a reset undoes without a word of the sensor."""
    template: Template | None = None


class RobotEndpoints:
    """Publishers, subscriptions and services of one robot on the simulator's node."""

    def __init__(
        self,
        node: Node,
        names: RobotNames,
        post: Post,
        *,
        content: Callable[[], ConvertOptions],
        input_context: Callable[[], InputContext],
        options: EndpointOptions,
        demand: SubscriberDemand,
        on_refusal: Callable[[], None] = lambda: None,
        on_limit: Callable[[], None] = lambda: None,
    ) -> None:
        """`content` and `input_context` are asked with every message; `demand` is told which topics are sent.

        `on_refusal` is called for each that is refused, `on_limit` for each with something beyond the robot's limits.
        """
        self.names = names
        self._node = node
        self._post = post
        self._content, self._input_context = content, input_context
        self._on_refusal, self._on_limit = on_refusal, on_limit
        self._limited: set[str] = set()
        self._warn = ThrottledLog(node)
        self._demand = demand
        self._publishers: dict[str, list[_SensorPublisher]] = {sensor.name: [] for sensor in all_sensors()}
        self._sent: dict[str, tuple[_SensorPublisher, ...]] = {}
        """By sensor, what somebody hears or what is always sent."""
        for sensor in all_sensors():
            for row in (*sensor_topics.rows_of(sensor), *options.extra.rows.get(sensor.name, ())):
                if row.topic not in options.left_out:
                    every_ns = options.every_ns.get(row.topic, row.every_ns)
                    self._open(row, TopicDemand(sensor.name, every_ns, sensor_topics.is_periodic(sensor, row)))
        self._description: Any = None
        if DESCRIPTION not in options.left_out:
            self._description = node.create_publisher(
                DESCRIPTION_TOPIC[0], names.topic(DESCRIPTION), qos.TRANSIENT_LOCAL
            )
            self._description.publish(String(data=urdf(names)))
        self._subscriptions = [
            node.create_subscription(one.type, names.topic(one.topic), self._handler(one), one.profile)
            for one in (*robot_inputs(stamped_cmd_vel=options.stamped_cmd_vel), *options.extra.inputs)
        ]
        handlers = {"is_ready": lambda _request, response: response, "reset_odometry": self._reset_odometry}
        self._services = [
            node.create_service(kind, names.topic(word), handlers[word]) for word, (kind, _) in SERVICES.items()
        ]

    def publish(self, sensor: str, reading: Reading) -> None:
        """Send one reading on every topic made from it."""
        sent = self._sent.get(sensor)
        if not sent:
            return
        stamp_ns, content = reading.stamp_ns, self._content()
        for target in sent:
            every_ns = target.heard.every_ns
            if every_ns:
                if stamp_ns < target.next_ns:
                    continue
                target.next_ns = (stamp_ns // every_ns + 1) * every_ns
            if target.template is not None and target.template.options is content:
                target.send(target.template.fill(reading))
                continue
            row = target.row
            if row.on_change is not None:
                value = row.on_change(reading)
                if target.last == value:
                    continue
                target.last = value
            message = row.encode(reading, self.names, content)
            if message is None:
                continue
            if row.patch is not None:
                target.template = Template.checked(row.patch, message, reading, content)
            target.is_stale = row.profile == qos.TRANSIENT_LOCAL
            target.publisher.publish(message)

    @property
    def topics(self) -> int:
        """How many topics of sensors it has."""
        return sum(map(len, self._publishers.values()))

    def poll(self) -> None:
        """Find out which topics somebody hears now.

        It is asked for, since rclpy's events executor dies of a publisher with callbacks that is destroyed while one of
        them waits.
        """
        for publishers in self._publishers.values():
            for target in publishers:
                if not target.row.always:
                    self._send(target, wanted=target.count() > 0)

    def publish_pose(self, now_ns: int, pose: Pose, tilt: Tilt) -> None:
        """Say where the robot stands while time does, for those who come late."""
        still = Twist(0.0, 0.0)
        reading = PoseReading(now_ns, (), pose, still, pose, still, tilt)
        for target in self._publishers["pose"]:
            if target.row.topic == sensor_topics.TRUTH:
                target.publisher.publish(target.row.encode(reading, self.names, self._content()))

    def reset(self) -> None:
        """Send the next reading of every kind, also an unchanged one: the world was reset. What is latched ends now."""
        for sensor, publishers in self._publishers.items():
            for target in publishers:
                target.last, target.next_ns = None, target.heard.every_ns
                if target.is_stale and sensor in sensor_topics.AT_START:
                    target.is_stale = False
                    message = target.row.encode(sensor_topics.AT_START[sensor], self.names, self._content())
                    target.publisher.publish(message)

    def close(self) -> None:
        """Take all topics and services of this robot out of the graph."""
        for service in self._services:
            self._node.destroy_service(service)
        for subscription in self._subscriptions:
            self._node.destroy_subscription(subscription)
        for publishers in self._publishers.values():
            for target in publishers:
                self._send(target, wanted=False)
                self._node.destroy_publisher(target.publisher)
        if self._description is not None:
            self._node.destroy_publisher(self._description)

    def _open(self, row: Row, heard: TopicDemand) -> None:
        topic, target = self.names.topic(row.topic), _SensorPublisher(row, heard, next_ns=heard.every_ns)
        profile = qos.overridable(self._node, topic, row.profile)
        target.publisher = self._node.create_publisher(row.type, topic, **profile)
        target.send, target.count = raw_publisher.sender(target.publisher), raw_publisher.counter(target.publisher)
        self._publishers[heard.sensor].append(target)
        self._send(target, wanted=row.always)

    def _send(self, target: _SensorPublisher, *, wanted: bool) -> None:
        if target.is_sent == wanted:
            return
        target.is_sent = wanted
        (self._demand.add if wanted else self._demand.remove)(target.heard)
        sensor = target.heard.sensor
        self._sent[sensor] = tuple(one for one in self._publishers[sensor] if one.is_sent)

    def _handler(self, one: RobotInput) -> Callable[[Any], None]:
        def handle(message: Any) -> None:
            try:
                for command in one.commands(message, self._input_context()):
                    self._post(command)
                limit_check = one.limit_check(message)
                if limit_check:
                    self._report_limit(one, limit_check)
            except (CommandError, PlacementError) as error:
                self._on_refusal()
                self._warn(self._full_name(one), f"refused: {error}")

        return handle

    def _report_limit(self, one: RobotInput, limit_check: str) -> None:
        """Once for each topic: who means full speed by a large number does not want to hear it again and again."""
        self._on_limit()
        if one.topic not in self._limited:
            self._limited.add(one.topic)
            self._node.get_logger().warning(f"{self._full_name(one)} limited: {limit_check}; told once")

    def _full_name(self, one: RobotInput) -> str:
        return full_name(self._node, self.names.topic(one.topic))

    def _reset_odometry(self, _request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        self._post(commands.ResetOdometry())
        response.success = True
        response.message = "odometry starts again from zero: odom -> base_link jumps once"
        return response
