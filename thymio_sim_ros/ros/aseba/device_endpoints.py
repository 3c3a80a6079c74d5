"""Connects the program of one robot to ROS: events, variables, status, run control.

Topics: docs/spec/ros-interface.md section 6.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import partial

from diagnostic_msgs.msg import DiagnosticStatus
from rclpy.node import Node
from std_msgs.msg import Empty
from std_srvs.srv import Trigger

from thymio_sim_ros.device.layout import target
from thymio_sim_ros.device.network_events import EmittedEvent
from thymio_sim_ros.device.programs.program import ThymioProgram, load_program
from thymio_sim_ros.device.programs.program_assignment import Assignment
from thymio_sim_ros.device.programs.status import OFF, RUNNING
from thymio_sim_ros.device.robot_device import RobotDevice, RobotHost
from thymio_sim_ros.engine.inputs import BreakpointsSet, Controlled, DeviceStart, Loaded
from thymio_sim_ros.ros.aseba.diagnostics import RuntimeDiagnostics
from thymio_sim_ros.ros.aseba.event_endpoints import EventEndpoints
from thymio_sim_ros.ros.aseba.program_owner import ProgramOwner
from thymio_sim_ros.ros.aseba.runtime_values import DebugOptions, RuntimeValues
from thymio_sim_ros.ros.aseba.status_endpoints import LoadedProgram, StatusEndpoints, describe_position
from thymio_sim_ros.ros.aseba.variable_endpoints import VariableEndpoints
from thymio_sim_ros.ros.interface import qos
from thymio_sim_ros.ros.interface.names import RobotNames
from thymio_sim_ros.ros.rclpy_ext.throttled_log import ThrottledLog

__all__ = ["DeviceEndpoints"]

SERVICES = ("run", "pause", "step", "step_line", "stop", "reset")
"""Run control by services, `aseba/<word>`."""

ALL = "*"
"""In `DebugOptions.local_events`: all there are."""


class DeviceEndpoints:
    """The topics and services of one robot's program, which an owner runs."""

    def __init__(
        self,
        node: Node,
        names: RobotNames,
        owner: ProgramOwner,
        robot: str,
        *,
        number: int,
        emit: Callable[[DeviceEndpoints, str, Sequence[int]], None],
        diagnostics: RuntimeDiagnostics,
        values: RuntimeValues,
        is_simulated: bool = True,
    ) -> None:
        """`robot`: its name for the owner; `emit` takes the events that are emitted on its topics.

        `values` have the layout of the variables of all robots, and debug options. `is_simulated`: whether the robot's
        machine is in this process.
        """
        self.names = names
        self.number = number
        self.robot = robot
        self.is_simulated = is_simulated
        self.share: Assignment | None = None
        self.on_program: Callable[[ThymioProgram], None] = lambda program: None
        """Called with each program that the robot begins to run."""
        self._node, self._owner, self._values = node, owner, values
        self._diagnostics = diagnostics
        self._debug_options = values.debug_options(names.name)
        self._program = self._own = load_program("", "none")
        self._device: RobotDevice | None = None
        """The device whose program was published last."""
        self._is_closed = False
        self._overload = ""
        self._warn = ThrottledLog(node)
        self._status = StatusEndpoints(node, names, number=number)
        self._events = EventEndpoints(node, names, partial(emit, self), warn=self._warn, messages=diagnostics.messages)
        self._variables = VariableEndpoints(node, names, owner, robot, language=self._debug_options.language)
        self._shutdown = node.create_subscription(Empty, names.topic("shutdown"), self._on_shutdown, qos.EVENTS)
        self._services = [
            node.create_service(Trigger, names.topic(f"aseba/{word}"), self._controller(word)) for word in SERVICES
        ]

    @property
    def host(self) -> RobotHost:
        """The selection of its program."""
        return self._owner.hosts[self.robot]

    @property
    def device(self) -> RobotDevice:
        """The robot's machine, which is another one in another world."""
        return self.host.device

    @property
    def status_message(self) -> DiagnosticStatus:
        """The status that was published last."""
        return self._status.message

    @property
    def program(self) -> ThymioProgram:
        """The program that the robot runs."""
        return self._program

    @property
    def has_event_subscribers(self) -> bool:
        """Whether another node receives its events."""
        return self._events.has_subscribers

    def begin(self, share: Assignment | None, behaviour: str) -> DeviceStart:
        """Return the start of the device: a program, or a built-in behavior; `share` has notes for the user."""
        self.share = share
        own = share.program if share is not None else None
        self._own = own or load_program("", "none", self._values.params.layout)
        return DeviceStart(self.number, self._own, behaviour, self._debug_options.breakpoints)

    def load(self, share: Assignment | None, behaviour: str = "") -> None:
        """Load a program, or none, and run its initialization; or start a built-in behavior, which can start it."""
        start = self.begin(share, behaviour)
        self._set_breakpoints(start.breakpoints)
        self._owner.apply(Loaded(self.robot, start.program, behaviour))
        self.publish()

    def set_debug_options(self, debug_options: DebugOptions) -> None:
        """Change the debug options of the running program."""
        old, self._debug_options = self._debug_options, debug_options
        if debug_options != old:
            self._set_program(with_events=debug_options.local_events != old.local_events)

    def reject_event(self, event: str, reason: str) -> None:
        """Report that an event from ROS was rejected."""
        robot = f"{self.names.name}: " if self.names.name else ""
        self._diagnostics.messages.add_rejected(f"{robot}event {event}", reason)

    def publish(self, events: Iterable[EmittedEvent] = ()) -> None:
        """Publish the results of the last run: emitted events, local events, notices, status."""
        if self._is_closed:
            return
        host = self.host
        for name in host.device.local_events.pop():
            self._events.publish(name, ())
        for event in events:
            self._events.publish(event.name, event.args)
        if host.program is not self._program or host.device is not self._device:
            self._device = host.device
            self._set_program()
        for notice in host.pop_notices():
            self._node.get_logger().warning(f"{self.names.name or 'robot'}: {notice}")
        self._publish_status()

    def observe_load(self) -> None:
        """Report whether the program exceeded the capacity since the last call."""
        overload = self.device.load_meter.pop().warning if self.device.status.state == RUNNING else ""
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

    def stop(self) -> None:
        """Stop the wheels and the program."""
        if not self._is_closed:
            self._is_closed = True
            if self.robot in self._owner.robots:
                self._owner.apply(Controlled(self.robot, "stop"))

    def close(self) -> None:
        """Stop the robot and destroy its topics and services."""
        self.stop()
        for endpoints in (self._events, self._variables, self._status):
            endpoints.close()
        for service in self._services:
            self._node.destroy_service(service)
        self._node.destroy_subscription(self._shutdown)

    def _set_program(self, *, with_events: bool = True) -> None:
        """Set up topics and status for a new or restarted program, or for new debug options."""
        debug_options, program = self._debug_options, self.host.program
        is_own = program is self._own
        local = {event.name for event in target(self.device.layout).local_events}
        local_events = local if ALL in debug_options.local_events else local & set(debug_options.local_events)
        if with_events:
            self.device.local_events.watch(local_events)
            self._events.open(program, sorted(local_events))
        self._program = program
        self.on_program(program)
        self._variables.language = debug_options.language
        self._variables.set_program(debug_options.watch)
        self._set_breakpoints(debug_options.breakpoints if self.host.user_program is self._own else ())
        points = self.device.run_control.breakpoints
        notes = self.share.notes if is_own and self.share is not None else ()
        self._status.set_program(LoadedProgram(program, self._events.words, notes, points), debug_options.language)

    def _set_breakpoints(self, lines: tuple[int, ...]) -> None:
        if lines != self.host.breakpoints and not self._owner.is_replaying:
            self._owner.apply(BreakpointsSet(self.robot, lines))

    def _on_shutdown(self, _message: Empty) -> None:
        self._owner.apply(Controlled(self.robot, "switch_off"))
        self.publish()

    def _controller(self, word: str) -> Callable[[Trigger.Request, Trigger.Response], Trigger.Response]:
        def callback(_request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
            self._owner.apply(Controlled(self.robot, word))
            self.publish()
            status = self.device.status
            response.success = status.state != OFF
            off = status.fault or "the robot is off; aseba/run switches it on"
            response.message = describe_position(status) if response.success else f"{word}: {off}"
            return response

        return callback
