"""Connects one robot's Aseba device to its topics: readings, commands, events, run control.

Topics: docs/spec/ros-interface.md section 6. The integer readings of a sensor arrive on `_raw/<sensor>`, or are derived
from topics of the ROS driver; commands are published on the topics that every robot subscribes to.
"""

from __future__ import annotations

import time
import uuid
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

from diagnostic_msgs.msg import DiagnosticStatus
from rclpy.node import Node
from std_msgs.msg import Empty
from std_srvs.srv import Trigger

from aseba_vm.protocol import Message
from thymio_sim_ros.device.behavior_host import BehaviorHost
from thymio_sim_ros.device.device import AsebaDevice
from thymio_sim_ros.device.layout import target
from thymio_sim_ros.device.network_node import QUESTIONS, NetworkNode
from thymio_sim_ros.device.options import DEFAULTS, DeviceOptions
from thymio_sim_ros.device.programs.program import ThymioProgram, load_program
from thymio_sim_ros.device.programs.program_assignment import Assignment
from thymio_sim_ros.device.programs.status import OFF, RUNNING
from thymio_sim_ros.device.remote.remote_robot import RemoteRobot
from thymio_sim_ros.device.robot_device import RobotDevice, RobotHost, RobotNode
from thymio_sim_ros.ros.aseba.diagnostics import RuntimeDiagnostics
from thymio_sim_ros.ros.aseba.event_endpoints import EventEndpoints
from thymio_sim_ros.ros.aseba.output_endpoints import OutputEndpoints
from thymio_sim_ros.ros.aseba.sensor_subscriptions import SensorSubscriptions
from thymio_sim_ros.ros.aseba.simulator_link import SimulatorLink
from thymio_sim_ros.ros.aseba.status_endpoints import Loaded, StatusEndpoints, describe_position
from thymio_sim_ros.ros.aseba.variable_endpoints import VariableEndpoints
from thymio_sim_ros.ros.interface import qos
from thymio_sim_ros.ros.interface.names import RobotNames, full_name, raw_topic
from thymio_sim_ros.ros.rclpy_ext.throttled_log import ThrottledLog

__all__ = ["DebugOptions", "DeviceEndpoints", "RobotBus"]

RUN_BUDGET = 5000
"""Instructions per slice; a longer handler continues in the next one (a robot executes 65535 between polls)."""
CONTINUE_S = 0.01
"""Wall time after which an unfinished handler continues without a message; the shortest sensor period."""
MAX_COMMANDS = 64
"""Largest number of commands of one slice that are all published; beyond it, or if the budget ended the slice, only the
latest command of each kind is published."""

ALL = "*"
"""In describe_position of the names of local events: all there are."""


@dataclass(frozen=True, slots=True)
class DebugOptions:
    """Debug options of one robot: breakpoint lines, variables and local events with topics, language of help texts."""

    breakpoints: tuple[int, ...] = ()
    watch: tuple[str, ...] = ()
    local_events: tuple[str, ...] = ()
    language: str = "en"


class RobotBus(Protocol):
    """The connection of a robot to the others; implemented by `Bus`."""

    def run_until_idle(self, *robots: DeviceEndpoints) -> None:
        """Run these robots, and those that receive their events."""

    def forward(self, sender: DeviceEndpoints, event: str, args: Sequence[int], /) -> None:
        """Send an event that a robot emitted to the others."""

    def emit(self, endpoints: DeviceEndpoints, event: str, args: Sequence[int], /) -> None:
        """Send an event that was emitted on this robot's topics."""

    def remove(self, robot: DeviceEndpoints, /) -> None:
        """Remove a robot from the schedule."""


class DeviceEndpoints:
    """An `AsebaDevice` with the topics and services of its robot."""

    def __init__(
        self,
        node: Node,
        names: RobotNames,
        *,
        number: int,
        bus: RobotBus,
        diagnostics: RuntimeDiagnostics,
        options: DeviceOptions = DEFAULTS,
        remote: RemoteRobot | None = None,
        debug_options: DebugOptions | None = None,
        has_driver: bool = False,
        is_fed: bool = False,
        link: SimulatorLink | None = None,
    ) -> None:
        """`has_driver`: the robot has the topics of the ROS driver; `is_fed`: see the property.

        `remote`: the robot behind a network, with sensors and actuators of its own; None: a device with these
        `options`.
        """
        self.names = names
        self.number = number
        self.is_simulated = remote is None
        """Whether the robot's machine is in this process."""
        self.share: Assignment | None = None
        self._host: RobotHost
        self.network_node: RobotNode
        """The robot as a node of an Aseba network."""
        if remote is None:
            host = BehaviorHost(AsebaDevice(node_id=number, options=options))
            self._host, self.network_node = host, NetworkNode(host, name=names.name, uuid=uuid.uuid4().bytes)
        else:
            self._host, self.network_node = remote.host, remote.gateway
        self.device: RobotDevice = self._host.device
        """The robot's machine."""
        self.send_to_network: Callable[[Sequence[Message]], None] | None = None
        """Takes the messages of the node for all clients, while there are clients."""
        self.on_program: Callable[[ThymioProgram], None] = lambda program: None
        """Called with each program that the robot begins to run."""
        self._node = node
        self._bus, self._diagnostics = bus, diagnostics
        self._debug_options = debug_options or DebugOptions()
        self._program = self._own = self._host.program
        self._is_closed = False
        self._last_slice_s = 0.0
        self._replaced = 0
        self._overload = ""
        rows = None if remote is None else ()
        self._outputs = OutputEndpoints(node, names, has_driver=has_driver, post=link.post if link else None, rows=rows)
        self._warn = ThrottledLog(node)
        self._status = StatusEndpoints(node, names, number=number)
        self._events = EventEndpoints(
            node,
            names,
            lambda event, args: bus.emit(self, event, args),
            warn=self._warn,
            messages=diagnostics.messages,
        )
        self._variables = VariableEndpoints(node, names, self.device, self.run, language=self._debug_options.language)
        self._shutdown = node.create_subscription(Empty, names.topic("shutdown"), self._on_shutdown, qos.EVENTS)
        self._sensors = SensorSubscriptions(
            node, names, self._on_reading, has_driver=has_driver, is_fed=is_fed, link=link
        )
        controls = {
            "run": self._host.resume,
            "pause": self.device.run_control.pause,
            "step": self.device.run_control.step,
            "step_line": self.device.run_control.step_line,
            "stop": self.device.run_control.stop,
            "reset": self.device.run_control.reset,
        }
        self._services = [
            node.create_service(Trigger, names.topic(f"aseba/{word}"), self._controller(word, act))
            for word, act in controls.items()
        ]

    @property
    def is_fed(self) -> bool:
        """Whether the owner feeds readings with `feed`; otherwise subscriptions of this robot do."""
        return self._sensors.is_fed

    @is_fed.setter
    def is_fed(self, is_fed: bool) -> None:
        self._sensors.is_fed = is_fed

    @property
    def status_message(self) -> DiagnosticStatus:
        """The status that was published last."""
        return self._status.message

    @property
    def is_busy(self) -> bool:
        """Whether a handler still has instructions to execute."""
        return self.device.is_busy

    @property
    def resumes_s(self) -> float:
        """The `time.monotonic` time at which a busy robot runs again unless it is scheduled earlier."""
        return self._last_slice_s + CONTINUE_S

    @property
    def program(self) -> ThymioProgram:
        """The program that the robot runs."""
        return self._program

    def load(self, program: ThymioProgram | None, notes: Sequence[str] = ()) -> None:
        """Load a program, or none, and run its initialization; `notes` are shown to the user."""
        self.share = Assignment(program, tuple(notes))
        self._own = program or load_program("", "none", self.device.layout)
        self._host.load(self._own)
        self._set_program()
        self.run()

    def start(self, behaviour: str, share: Assignment | None) -> None:
        """Switch the robot on with a built-in behavior; the user's program can be started from its menu."""
        self.share = share
        own = share.program if share is not None else None
        self._own = own or load_program("", "none", self.device.layout)
        self._host.start(behaviour, own)
        self._set_program()
        self.run()

    def restart(self) -> None:
        """Restart the robot, after a jump back in time."""
        self._host.restart()
        self._set_program()
        self.run()

    def set_debug_options(self, debug_options: DebugOptions) -> None:
        """Change the debug options of the running program."""
        old, self._debug_options = self._debug_options, debug_options
        if debug_options != old:
            self._set_program(with_events=debug_options.local_events != old.local_events)
            self.run()

    def receive_event(self, event: str, args: Sequence[int], *, source: int) -> bool:
        """Queue a global event; return False if the program does not declare it."""
        if not self.device.declares(event):
            return False
        self.device.receive_event(event, args, source=source)
        return True

    def reject_event(self, event: str, reason: str) -> None:
        """Report that an event from ROS was rejected."""
        robot = f"{self.names.name}: " if self.names.name else ""
        self._diagnostics.messages.add_rejected(f"{robot}event {event}", reason)

    def handle_messages(
        self, client: int, messages: Sequence[Message], send: Callable[[Sequence[Message], int | None], None]
    ) -> None:
        """Execute messages of a client of the robot's network, then run, unless they were questions only.

        `send` takes the resulting messages in order, each group with the client that it is for, or None for all.
        """
        node = self.network_node
        for message in messages:
            replies = node.handle(client, message)
            for group, receiver in ((node.pop_messages(), None), (replies, client)):
                if group:
                    send(group, receiver)
        node.install_bytecode()
        if not all(isinstance(message, QUESTIONS) for message in messages):
            self.run()

    def remember(self, program: ThymioProgram) -> None:
        """Remember the text of a program whose bytecode may come from the network."""
        self._host.remember(replace(program, layout=self.device.layout))

    def feed(self, sensor: str, words: Sequence[int]) -> None:
        """Store a reading; the caller then calls `run` or `is_due`. An invalid reading is reported."""
        try:
            self.device.feed(sensor, words)
        except ValueError as error:
            topic = full_name(self._node, self.names.topic(raw_topic(sensor)))
            self._diagnostics.messages.add_rejected(topic, error)

    def is_due(self, now_ns: int) -> bool:
        """Advance the device to `now_ns` and return whether it has work to do."""
        self.device.advance(now_ns)
        return self.device.is_due

    def run(self) -> None:
        """Schedule the robot after a change. Does nothing once it is closed, when late messages may still arrive."""
        if not self._is_closed:
            self._bus.run_until_idle(self)

    def run_slice(self) -> None:
        """Run pending work up to the budget, then publish the resulting commands, events and status."""
        if self._is_closed:
            return
        now_ns = self._node.get_clock().now().nanoseconds
        self.device.advance(now_ns)
        self.device.run(RUN_BUDGET)
        is_cut = self.device.is_busy
        events = self._host.pop_events()
        commands = self.device.pop_commands()
        self._replaced += self._outputs.send_all(commands, latest=is_cut or len(commands) > MAX_COMMANDS)
        for name in self.device.local_events.pop():
            self._events.publish(name, ())
        for event in events:
            self._events.publish(event.name, event.args)
            self._bus.forward(self, event.name, event.args)
        if self._host.program is not self._program:
            self._set_program()
        if self.send_to_network is not None and (messages := self.network_node.pop_messages()):
            self.send_to_network(messages)
        for notice in self._host.pop_notices():
            self._node.get_logger().warning(f"{self.names.name or 'robot'}: {notice}")
        self._publish_status()
        self._last_slice_s = time.monotonic()

    def observe_load(self) -> None:
        """Report whether the program exceeded the capacity since the last call."""
        load = replace(self.device.load_meter.pop(), replaced=self._replaced)
        self._replaced = 0
        overload = load.warning if self.device.status.state == RUNNING else ""
        if overload and not self._overload:
            self._warn(f"{self.names.name or 'robot'}:", overload)
        self._overload = overload
        self._publish_status()

    def _publish_status(self) -> None:
        if self._status.publish_if_changed(self.device.status, self._overload):
            self._diagnostics.publish_changed(self)

    def publish_variables(self) -> None:
        """Publish variables that changed."""
        self._variables.publish_changes()

    def poll_subscribers(self) -> None:
        """Publish earlier commands again for new subscribers."""
        self._outputs.resend()

    def stop(self) -> None:
        """Stop the wheels and the program."""
        if not self._is_closed:
            self._is_closed = True
            self._bus.remove(self)
            self.device.run_control.stop()
            self._outputs.send_all(self.device.pop_commands(), latest=True)

    def close(self) -> None:
        """Stop the robot and destroy its topics and services."""
        self.stop()
        for endpoints in (self._events, self._variables, self._status, self._outputs, self._sensors):
            endpoints.close()
        for service in self._services:
            self._node.destroy_service(service)
        self._node.destroy_subscription(self._shutdown)

    def _set_program(self, *, with_events: bool = True) -> None:
        """Set up topics and status for a new or restarted program, or for new debug options."""
        debug_options, program = self._debug_options, self._host.program
        is_own = program is self._own
        local = {event.name for event in target(self.device.layout).local_events}
        local_events = local if ALL in debug_options.local_events else local & set(debug_options.local_events)
        self._outputs.start_program()
        if with_events:
            self.device.local_events.watch(local_events)
            self._events.open(program, sorted(local_events))
        self._program = program
        self.on_program(program)
        self._variables.language = debug_options.language
        self._variables.set_program(debug_options.watch)
        points = self.device.run_control.set_breakpoints(debug_options.breakpoints if is_own else ())
        notes = self.share.notes if is_own and self.share is not None else ()
        self._status.set_program(Loaded(program, self._events.words, notes, points), debug_options.language)

    def _on_reading(self, sensor: str, words: Sequence[int]) -> None:
        self.feed(sensor, words)
        self.run()

    def _on_shutdown(self, _message: Empty) -> None:
        self.device.run_control.switch_off()
        self.run()

    def _controller(
        self, word: str, act: Callable[[], None]
    ) -> Callable[[Trigger.Request, Trigger.Response], Trigger.Response]:
        def callback(_request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
            act()
            self.run_slice()  # at once, before robots that are already waiting
            self._bus.run_until_idle()
            status = self.device.status
            response.success = status.state != OFF
            off = status.fault or "the robot is off; aseba/run switches it on"
            response.message = describe_position(status) if response.success else f"{word}: {off}"
            return response

        return callback
