"""The topics and services of one robot, created and destroyed with it.

Readings are converted to messages by the rows of `sensor_topics`; messages are converted to commands and posted to the
world. A topic without subscribers costs no more than being polled for them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Protocol

from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.publisher import Publisher
from std_msgs.msg import String
from std_srvs.srv import Empty as EmptyService
from std_srvs.srv import Trigger

from thymio_sim_ros.ros.interface import qos, sensor_topics
from thymio_sim_ros.ros.interface.command_checks import CommandError, NotFiniteError, tiny_field
from thymio_sim_ros.ros.interface.convert_readings import ConvertOptions
from thymio_sim_ros.ros.interface.extra_topics import ExtraTopics
from thymio_sim_ros.ros.interface.names import HIDDEN, RobotNames, full_name
from thymio_sim_ros.ros.interface.robot_inputs import InputContext, RobotInput, robot_inputs
from thymio_sim_ros.ros.interface.sensor_topics import Row, is_periodic
from thymio_sim_ros.ros.interface.subscriber_demand import SubscriberDemand, TopicDemand
from thymio_sim_ros.ros.rclpy_ext.local_node import LocalNode, LocalTopic
from thymio_sim_ros.ros.rclpy_ext.message_reports import MessageReports
from thymio_sim_ros.ros.rclpy_ext.subscription_count import counter
from thymio_sim_ros.ros.simulator.visualization.urdf import urdf
from thymio_sim_ros.sim import commands
from thymio_sim_ros.sim.commands import Command
from thymio_sim_ros.sim.model.geometry import Pose, Tilt, Twist
from thymio_sim_ros.sim.model.readings import PoseReading, Reading
from thymio_sim_ros.sim.playground.placement import PlacementError
from thymio_sim_ros.sim.sensors import Sensor, all_sensors

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.messages.message_class import Message, Service

__all__ = [
    "DESCRIPTION",
    "DESCRIPTION_TOPIC",
    "SERVICES",
    "EndpointOptions",
    "OtherEndpoints",
    "RobotEndpoints",
    "RobotOwner",
    "first_words",
]

DESCRIPTION = "robot_description"
DESCRIPTION_TOPIC = (String, "the robot as URDF, made of primitives, with turning wheels")

SERVICES: Mapping[str, tuple[type[Service[Any, Any]], str]] = {
    "is_ready": (EmptyService, "responds once the robot is in the world"),
    "reset_odometry": (Trigger, "reset the odometry to zero: `odom -> base_link` jumps once"),
}
"""Type and description of every service of a robot."""


_SUM_OF_RANGES = (
    "may be computed from ranges: one without an obstacle is +inf, and inf - inf is nan. For code written for the"
    " driver, where it is -1, start `thymio-sim --out-of-range driver`, or --ros-args -p out_of_range:=driver"
)
_ANY_TYPE = {"event_callbacks": SubscriptionEventCallbacks(incompatible_type=lambda _event: None)}
"""For topics that may have two types: rclpy would warn of publishers of the other one."""
_INT_IN_FLOAT = (
    "an int in a float field, such as linear.x = 1 in place of 1.0? ROS_PYTHON_CHECK_FIELDS=1 (thymio-sim env) shows"
    " the line"
)


def first_words() -> frozenset[str]:
    """Return the first words of a robot's topics with several words, including those that a program adds.

    For hidden topics the word is included without `_` too, as in the driver's names.
    """
    rows = (row.topic for sensor in all_sensors() for row in sensor_topics.rows_of(sensor))
    topics = (*rows, *(robot_input.topic for robot_input in robot_inputs()), "aseba/")
    words = {topic.partition("/")[0] for topic in topics if "/" in topic}
    return frozenset(words | {word.removeprefix(HIDDEN) for word in words})


@dataclass(frozen=True, slots=True)
class EndpointOptions:
    """Options for the topics of all robots, fixed at the start.

    `left_out`: topics that are not created; `every_ns`: shortest period by topic; `extra`: additional topics.
    """

    stamped_cmd_vel: bool = False
    left_out: frozenset[str] = frozenset()
    every_ns: Mapping[str, int] = field(default_factory=dict)
    extra: ExtraTopics = field(default_factory=ExtraTopics)


@dataclass(slots=True)
class _SensorPublisher:
    """The publisher of a row with its node and demand, the time of the next message, and the last published value."""

    node: Node | LocalNode
    row: Row
    topic_demand: TopicDemand
    next_ns: int
    publisher: Publisher[Any] | LocalTopic
    count: Callable[[], int]
    """Returns the number of subscriptions."""
    is_sent: bool = False
    last: object = None
    is_stale: bool = False
    """Whether the retained message is outdated after a reset, although the sensor reports nothing."""


class RobotOwner(Protocol):
    """The simulator as the endpoints of one robot use it."""

    messages: MessageReports
    """Takes what is wrong with messages."""

    @property
    def convert_options(self) -> ConvertOptions:
        """The current options for the content of messages."""

    def input_context(self) -> InputContext:
        """Return time, time-out and frames for a message that has arrived."""

    def post(self, command: Command) -> None:
        """Post a command to the robot. Raises PlacementError for a place that is not free."""


class OtherEndpoints(Protocol):
    """What a robot has besides its own endpoints."""

    node: Node
    """The node that has them."""
    rows: Mapping[str, Sequence[Row]]
    """Published topics by sensor."""
    inputs: Sequence[tuple[Node, RobotInput]]
    """Inputs with the nodes that have them."""

    def reset(self) -> None:
        """Follow a reset of the world, or another world."""

    def close(self) -> None:
        """Destroy what is not a topic."""


class RobotEndpoints:
    """Publishers, subscriptions and services of one robot on the simulator's node."""

    def __init__(
        self,
        node: Node,
        names: RobotNames,
        owner: RobotOwner,
        *,
        options: EndpointOptions,
        demand: SubscriberDemand,
        control: Node | LocalNode | None = None,
        other: OtherEndpoints | None = None,
    ) -> None:
        """Create all endpoints.

        Args:
            node: The node of the simulator.
            names: ROS names of the robot.
            owner: Takes commands and gives the context in which messages are converted.
            options: Which topics to create.
            demand: Counts the topics that are published.
            control: Has the topics of operators and the true pose, if not the node.
            other: What the robot has besides.
        """
        self.names = names
        self._node = node
        self._control = node if control is None else control
        self._owner = owner
        self._other = other
        self._reported: set[tuple[str, str]] = set()
        """Topics and first words of what is reported once."""
        self._is_cause_named = False
        self._demand = demand
        self._publishers: dict[str, list[_SensorPublisher]] = {sensor.name: [] for sensor in all_sensors()}
        self._sent: dict[str, tuple[_SensorPublisher, ...]] = {}
        """Publishers with subscribers, and those that always publish, by sensor."""
        for sensor in all_sensors():
            for row in (*sensor_topics.rows_of(sensor), *options.extra.rows.get(sensor.name, ())):
                if row.topic not in options.left_out:
                    self._open(self._node_of(row), row, sensor, options.every_ns.get(row.topic, row.every_ns))
            if other is not None:
                for row in other.rows.get(sensor.name, ()):
                    self._open(other.node, row, sensor, row.every_ns)
        self._description: Publisher[String] | None = None
        if DESCRIPTION not in options.left_out:
            self._description = node.create_publisher(
                DESCRIPTION_TOPIC[0], names.topic(DESCRIPTION), qos.TRANSIENT_LOCAL
            )
            self._description.publish(String(data=urdf(names, has_lidar=sensor_topics.SCAN not in options.left_out)))
        known = (*robot_inputs(stamped_cmd_vel=options.stamped_cmd_vel), *options.extra.inputs)
        inputs: list[tuple[Any, RobotInput]] = [
            (self._control if robot_input.is_of_operator else node, robot_input)
            for robot_input in known
            if robot_input.topic not in options.left_out
        ]
        others = () if other is None else other.inputs
        second = {robot_input.topic for _, robot_input in others}
        self._subscriptions: list[tuple[Any, Any]] = [
            (
                chosen,
                chosen.create_subscription(
                    robot_input.type,
                    names.topic(robot_input.topic),
                    self._handler(robot_input),
                    robot_input.profile,
                    **(_ANY_TYPE if robot_input.topic in second else {}),
                ),
            )
            for chosen, robot_input in (*inputs, *others)
        ]
        handlers = {"is_ready": lambda _request, response: response, "reset_odometry": self._reset_odometry}
        self._services = [
            node.create_service(kind, names.topic(word), handlers[word]) for word, (kind, _) in SERVICES.items()
        ]

    def publish(self, sensor: str, reading: Reading) -> None:
        """Publish one reading on all of its topics."""
        sent = self._sent.get(sensor)
        if not sent:
            return
        stamp_ns, content = reading.stamp_ns, self._owner.convert_options
        for target in sent:
            every_ns = target.topic_demand.every_ns
            if every_ns:
                if stamp_ns < target.next_ns:
                    continue
                target.next_ns = (stamp_ns // every_ns + 1) * every_ns
            row = target.row
            if row.on_change is not None:
                value = row.on_change(reading)
                if target.last == value:
                    continue
                target.last = value
            message = row.encode(reading, self.names, content)
            if message is None:
                continue
            target.is_stale = row.profile == qos.TRANSIENT_LOCAL
            target.publisher.publish(message)

    def _publish_on(self, target: _SensorPublisher, reading: Reading) -> None:
        message = target.row.encode(reading, self.names, self._owner.convert_options)
        if message is not None:
            target.publisher.publish(message)

    @property
    def topics(self) -> int:
        """Number of sensor topics."""
        return sum(map(len, self._publishers.values()))

    def poll(self) -> None:
        """Find out which topics have subscribers.

        Matched-event callbacks are not used: rclpy's events executor crashes if a publisher is destroyed while one of
        its callbacks is queued.
        """
        for publishers in self._publishers.values():
            for target in publishers:
                if not target.row.always:
                    self._send(target, wanted=target.count() > 0)

    def publish_pose(self, now_ns: int, pose: Pose, tilt: Tilt, height_m: float) -> None:
        """Publish the true pose of a paused robot for late subscribers."""
        still = Twist(0.0, 0.0)
        reading = PoseReading(now_ns, (), pose, still, pose, still, tilt, height_m)
        for target in self._publishers["pose"]:
            if target.row.topic == sensor_topics.TRUTH:
                self._publish_on(target, reading)

    def reset(self) -> None:
        """Publish the next reading of every sensor even if unchanged, and replace outdated retained messages."""
        if self._other is not None:
            self._other.reset()
        for sensor, publishers in self._publishers.items():
            for target in publishers:
                target.last, target.next_ns = None, target.topic_demand.every_ns
                if target.is_stale and sensor in sensor_topics.AT_START:
                    target.is_stale = False
                    self._publish_on(target, sensor_topics.AT_START[sensor])

    def close(self) -> None:
        """Destroy all topics and services of this robot."""
        if self._other is not None:
            self._other.close()
        for service in self._services:
            self._node.destroy_service(service)
        for chosen, subscription in self._subscriptions:
            chosen.destroy_subscription(subscription)
        for publishers in self._publishers.values():
            for target in publishers:
                self._send(target, wanted=False)
                creator: Any = target.node
                creator.destroy_publisher(target.publisher)
        if self._description is not None:
            self._node.destroy_publisher(self._description)

    def _open(self, node: Node | LocalNode, row: Row, sensor: Sensor, every_ns: int) -> None:
        topic, topic_demand = self.names.topic(row.topic), TopicDemand(sensor.name, every_ns, is_periodic(sensor, row))
        started = self._node if isinstance(node, LocalNode) else node
        profile, overrides = qos.overridable(started, topic, row.profile)
        publisher = node.create_publisher(row.type, topic, profile, qos_overriding_options=overrides)
        target = _SensorPublisher(node, row, topic_demand, every_ns, publisher, counter(publisher))
        self._publishers[topic_demand.sensor].append(target)
        self._send(target, wanted=row.always)

    def _node_of(self, row: Row) -> Node | LocalNode:
        return self._control if row.topic == sensor_topics.TRUTH else self._node

    def _send(self, target: _SensorPublisher, *, wanted: bool) -> None:
        if target.is_sent == wanted:
            return
        target.is_sent = wanted
        (self._demand.add if wanted else self._demand.remove)(target.topic_demand)
        sensor = target.topic_demand.sensor
        self._sent[sensor] = tuple(publisher for publisher in self._publishers[sensor] if publisher.is_sent)

    def _handler(self, robot_input: RobotInput) -> Callable[[Any], None]:
        def handle(message: Message) -> None:
            try:
                for command in robot_input.commands(message, self._owner.input_context()):
                    self._owner.post(command)
                limit_check = robot_input.limit_check(message)
                if limit_check:
                    self._report_limit(robot_input, limit_check)
                if field := tiny_field(message):
                    text = f"has a value near zero in {field}: {_INT_IN_FLOAT}"
                    self._owner.messages.add_suspect(self._full_name(robot_input), text)
                    self._warn_once(robot_input, text)
            except (CommandError, PlacementError) as error:
                self._owner.messages.add_rejected(self._full_name(robot_input), error)
                if isinstance(error, NotFiniteError) and not self._is_cause_named:
                    self._is_cause_named = not self._owner.convert_options.driver_ranges
                    if self._is_cause_named:
                        self._report(robot_input, _SUM_OF_RANGES)

        return handle

    def _report_limit(self, robot_input: RobotInput, limit_check: str) -> None:
        """Log a clamped message once per topic: programs use large numbers for full speed on purpose."""
        self._owner.messages.add_clamped(self._full_name(robot_input), limit_check)
        self._warn_once(robot_input, f"clamped: {limit_check}")

    def _warn_once(self, robot_input: RobotInput, text: str) -> None:
        reason = robot_input.topic, text.partition(":")[0]
        if reason not in self._reported:
            self._reported.add(reason)
            self._report(robot_input, f"{text} (reported once per topic)")

    def _report(self, robot_input: RobotInput, text: str) -> None:
        self._node.get_logger().warning(f"{self._full_name(robot_input)} {text}")

    def _full_name(self, robot_input: RobotInput) -> str:
        return full_name(self._node, self.names.topic(robot_input.topic))

    def _reset_odometry(self, _request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        self._owner.post(commands.ResetOdometry())
        response.success = True
        response.message = "odometry restarts at zero: odom -> base_link jumps once"
        return response
