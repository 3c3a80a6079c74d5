"""One robot's Aseba device joined to its topics: readings in, commands out, events both ways, run control.

Topics: ros-interface.md section 6. The integers of a sensor come on `raw/<sensor>`; commands leave on the
topics that any robot listens to.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Protocol

from diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from rclpy.node import Node
from std_msgs.msg import Empty, Int16MultiArray
from std_srvs.srv import Trigger

from thymio_sim_ros.device.behaviour_host import BehaviourHost, is_internal
from thymio_sim_ros.device.bindings import sensor_names
from thymio_sim_ros.device.device import AsebaDevice
from thymio_sim_ros.device.options import DEFAULTS, DeviceOptions
from thymio_sim_ros.device.program import ThymioProgram
from thymio_sim_ros.nodes import command_topics, convert, plugin_topics, qos
from thymio_sim_ros.nodes.names import RobotNames, topic_word
from thymio_sim_ros.nodes.robot_ports import WARN_EVERY_S
from thymio_sim_ros.sim.commands import Command

RUN_BUDGET = 5000
"""Instructions per turn; a handler that needs more goes on in the next (a robot does 65535 between polls)."""

INT16 = range(-32768, 32768)


class Bus(Protocol):
    """Where a robot's events go besides its topics."""

    def __call__(self, sender: DevicePorts, event: str, args: Sequence[int], /) -> None:
        """Tell the other robots."""


class DevicePorts:
    """An `AsebaDevice` with the topics and services of its robot."""

    def __init__(
        self, node: Node, names: RobotNames, *, node_id: int, bus: Bus, options: DeviceOptions = DEFAULTS
    ) -> None:
        self.names = names
        self.device = AsebaDevice(node_id=node_id, options=options)
        self._host = BehaviourHost(self.device)
        self._node = node
        self._bus = bus
        self._program = self._host.program
        self._status: DiagnosticStatus | None = None
        self._is_closed = False
        self._event_ports: list[tuple[Any, Any]] = []
        self._event_publishers: dict[str, Any] = {}
        topic = names.topic
        self._outputs = {
            row.topic: (row.encode, node.create_publisher(row.type, topic(row.topic), row.profile))
            for row in (*command_topics.ROWS, *plugin_topics.rows())
            if row.encode is not None
        }
        self._status_publisher = node.create_publisher(DiagnosticStatus, topic("aseba/status"), qos.LATCHED)
        self._any_event = node.create_publisher(Int16MultiArray, topic("aseba/events"), qos.EVENTS)
        self._subscriptions = [
            node.create_subscription(Int16MultiArray, topic(f"raw/{sensor}"), self._feeder(sensor), qos.SENSOR)
            for sensor in sensor_names()
        ]
        self._subscriptions.append(
            node.create_subscription(Int16MultiArray, topic("aseba/emit"), self._on_any_emit, qos.EVENTS)
        )
        self._subscriptions.append(node.create_subscription(Empty, topic("shutdown"), self._on_shutdown, qos.EVENTS))
        controls = {
            "run": self.device.resume,
            "pause": self.device.pause,
            "step": self.device.step,
            "stop": self.device.stop,
            "reset": self.device.reset,
        }
        self._services = [
            node.create_service(Trigger, topic(f"aseba/{word}"), self._controller(act))
            for word, act in controls.items()
        ]

    @property
    def is_busy(self) -> bool:
        """Whether a handler still has instructions to execute."""
        return self.device.is_busy

    @property
    def program(self) -> ThymioProgram:
        """What the machine runs."""
        return self._host.program

    def load(self, program: ThymioProgram) -> None:
        """Load the program and run its beginning."""
        self._host.load(program)
        self.run()

    def start(self, behaviour: str, own: ThymioProgram | None) -> None:
        """Switch the robot on with a built-in behaviour; a program of one's own waits in its menu."""
        self._host.start(behaviour, own)
        self.run()

    def restart(self) -> None:
        """Time went back: the robot begins anew."""
        self._host.restart()
        self.run()

    def hear(self, event: str, args: Sequence[int], *, source: int) -> None:
        """A global event arrives from the bus or a topic; unknown ones are not for this robot."""
        if event in dict(self._program.events):
            self.device.receive_event(event, args, source=source)
            self.run()

    def run(self) -> None:
        """Run what is pending, then send what came of it; nothing once it is closed, as messages may still come."""
        if self._is_closed:
            return
        now_ns = self._node.get_clock().now().nanoseconds
        self.device.advance(now_ns)
        self.device.run(RUN_BUDGET)
        events = self._host.take_events(now_ns)
        if self._host.program is not self._program:
            self._program = self._host.program
            self._open_events(self._program)
        for command in self.device.take_commands():
            self._send(command)
        for event in events:
            self._publish_event(event.name, event.args)
            self._bus(self, event.name, event.args)
        for notice in self._host.take_notices():
            self._node.get_logger().warning(f"{self.names.name or 'robot'}: {notice}")
        self._publish_status()

    def close(self) -> None:
        """The robot does not go on without its program: wheels stop; its topics and services go."""
        self._is_closed = True
        self.device.stop()
        for command in self.device.take_commands():
            self._send(command)
        self._close_events()
        for service in self._services:
            self._node.destroy_service(service)
        for subscription in self._subscriptions:
            self._node.destroy_subscription(subscription)
        publishers = [publisher for _, publisher in self._outputs.values()]
        for publisher in (*publishers, self._status_publisher, self._any_event):
            self._node.destroy_publisher(publisher)

    def _feeder(self, sensor: str) -> Callable[[Int16MultiArray], None]:
        def callback(message: Int16MultiArray) -> None:
            try:
                self.device.feed(sensor, message.data)
            except ValueError as error:
                self._warn(f"raw/{sensor} refused: {error}")
                return
            self.run()

        return callback

    def _on_shutdown(self, _message: Empty) -> None:
        self.device.switch_off()
        self.run()

    def _controller(self, act: Callable[[], None]) -> Callable[[Trigger.Request, Trigger.Response], Trigger.Response]:
        def callback(_request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
            act()
            self.run()
            response.success, response.message = True, self.device.status.state
            return response

        return callback

    def _send(self, command: Command) -> None:
        topic = command_topics.topic_of(command) or plugin_topics.topic_of(command)
        if topic is not None:
            encode, publisher = self._outputs[topic]
            publisher.publish(encode(command))

    def _close_events(self) -> None:
        for publisher, subscription in self._event_ports:
            self._node.destroy_publisher(publisher)
            self._node.destroy_subscription(subscription)
        self._event_ports.clear()
        self._event_publishers.clear()

    def _open_events(self, program: ThymioProgram) -> None:
        self._close_events()
        events = [event for event, _ in program.events if not is_internal(event)]
        words = [topic_word(event) for event in events]
        for event, word in zip(events, words, strict=True):
            if words.count(word) > 1:
                self._warn(f"event {event} shares the topic name {word} with another: use aseba/events and aseba/emit")
                continue
            topic = self.names.topic
            publisher = self._node.create_publisher(Int16MultiArray, topic(f"aseba/events/{word}"), qos.EVENTS)
            subscription = self._node.create_subscription(
                Int16MultiArray, topic(f"aseba/emit/{word}"), self._emitter(event), qos.EVENTS
            )
            self._event_ports.append((publisher, subscription))
            self._event_publishers[event] = publisher

    def _emitter(self, event: str) -> Callable[[Int16MultiArray], None]:
        return lambda message: self._emit(event, list(message.data))

    def _on_any_emit(self, message: Int16MultiArray) -> None:
        if len(message.layout.dim) != 1:
            self._warn("aseba/emit refused: layout.dim[0].label must be the name of the event")
            return
        self._emit(message.layout.dim[0].label, list(message.data))

    def _emit(self, event: str, args: list[int]) -> None:
        """An event from ROS reaches every robot that declares it; too much data is refused."""
        size = dict(self._program.events).get(event)
        if size is None or is_internal(event):
            self._warn(f"event {event} refused: the program declares {self._declared()}")
        elif len(args) > size:
            self._warn(f"event {event} refused: {len(args)} values found, expected at most {size}")
        else:
            filled = args + [0] * (size - len(args))
            self.hear(event, filled, source=0)

    def _declared(self) -> str:
        events = [event for event, _ in self._program.events if not is_internal(event)]
        return ", ".join(events) or "no events"

    def _publish_event(self, event: str, args: Sequence[int]) -> None:
        data = list(args)
        self._any_event.publish(Int16MultiArray(layout=convert.layout([(event, len(data))]), data=data))
        publisher = self._event_publishers.get(event)
        if publisher is not None:
            publisher.publish(Int16MultiArray(data=data))

    def _publish_status(self) -> None:
        status = self.device.status
        fault = status.state == "fault"
        message = DiagnosticStatus(
            level=DiagnosticStatus.ERROR if fault else DiagnosticStatus.OK,
            name=f"aseba: {self.names.name or 'robot'}",
            hardware_id=f"node {self.device.node_id}",
            message=status.fault or status.state,
            values=[
                KeyValue(key="state", value=status.state),
                KeyValue(key="program", value=self._program.name),
                KeyValue(key="event", value=status.event if fault else ""),
                KeyValue(key="line", value=str(status.line) if fault and status.line else ""),
            ],
        )
        if message != self._status:
            if fault:
                self._node.get_logger().error(f"{message.name}: line {status.line}: {status.fault}")
            self._status = message
            self._status_publisher.publish(message)

    def _warn(self, text: str) -> None:
        self._node.get_logger().warning(text, throttle_duration_sec=WARN_EVERY_S)
