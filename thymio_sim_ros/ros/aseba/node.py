"""The Aseba runtime as a ROS node: feeds readings to devices, publishes their commands, exchanges their events.

It uses topics only and works with every robot that has them (docs/spec/ros-interface.md section 6, docs/aseba_ros.md).
Devices follow the clock of the node. Programs are parameters; a text that does not compile is rejected with its
position, and the current program continues. A robot without a program is switched on with its menu.
"""

from __future__ import annotations

import json
import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import inf
from types import MappingProxyType
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rcl_interfaces.msg import SetParametersResult
from rclpy.clock import Clock, ClockChange, JumpThreshold, TimeJump
from rclpy.clock_type import ClockType
from rclpy.context import Context
from rclpy.duration import Duration
from rclpy.executors import Executor
from rclpy.parameter import Parameter
from std_msgs.msg import Int16MultiArray, String

from thymio_sim_ros import resources
from thymio_sim_ros.device.behavior_host import MENU
from thymio_sim_ros.device.bindings import sensor_names
from thymio_sim_ros.device.firmware.sd_card import SdCardError
from thymio_sim_ros.device.firmware.settings import SettingsError
from thymio_sim_ros.device.layout import THYMIO
from thymio_sim_ros.device.options import OptionError
from thymio_sim_ros.device.programs.program import ProgramError
from thymio_sim_ros.device.programs.program_assignment import Assignment, RobotId
from thymio_sim_ros.loading import check_behaviour, shipped_behaviours
from thymio_sim_ros.ros.aseba import parameters as aseba_params
from thymio_sim_ros.ros.aseba import script_parameters
from thymio_sim_ros.ros.aseba.bus import SLICE_S, Bus
from thymio_sim_ros.ros.aseba.check_service import CheckService
from thymio_sim_ros.ros.aseba.device_endpoints import DebugOptions, DeviceEndpoints
from thymio_sim_ros.ros.aseba.parameters import RuntimeParams, WrongValueError
from thymio_sim_ros.ros.interface import qos
from thymio_sim_ros.ros.interface.names import RobotNames, full_name
from thymio_sim_ros.ros.interface.raw_topic import RawDecoder
from thymio_sim_ros.ros.rclpy_ext import parameters as params
from thymio_sim_ros.ros.rclpy_ext.node_runner import SPIN_SLICE_S, StartError, announce, deliver, run_main
from thymio_sim_ros.ros.rclpy_ext.parameter_node import parameter_node
from thymio_sim_ros.ros.rclpy_ext.throttled_log import ThrottledLog
from thymio_sim_ros.ros.rclpy_ext.type_mismatch import TypeMismatches

__all__ = ["AsebaRuntime", "RuntimeParams", "main"]

SIMULATOR_STATE, SIMULATOR_RAW = "simulator/_state", "simulator/_raw"
"""Relative names: topics of the simulator in the same namespace."""
DIAGNOSTICS_S = 1.0
SUBSCRIBERS_S = 0.25
"""Period of polling for new subscribers of commands."""

NO_OVERRIDES: Mapping[str, Any] = MappingProxyType({})
_SENSORS = frozenset(sensor_names())
PROGRAM_ERRORS = (ProgramError, resources.ResourceError, OSError)


@dataclass(frozen=True, slots=True)
class _Accepted:
    """Checked parameters: all values, the changes, and the program of each robot."""

    values: dict[str, Any]
    changes: dict[str, Any]
    shares: dict[str, Assignment | None]


class AsebaRuntime:
    """The runtime node: one device per robot, all on one Aseba bus."""

    def __init__(
        self,
        context: Context,
        defaults: RuntimeParams | None = None,
        *,
        use_sim_time: bool | None = None,
        overrides: Mapping[str, Any] = NO_OVERRIDES,
    ) -> None:
        """`overrides`: parameter values by name, like those of a command line."""
        given = dict(overrides) | ({} if use_sim_time is None else {"use_sim_time": use_sim_time})
        self.node = parameter_node(
            "aseba_runtime",
            context=context,
            names_file=lambda name: name.endswith("script.path"),
            parameter_overrides=[Parameter(name, value=value) for name, value in given.items()],
            allow_undeclared_parameters=True,
        )
        self.robots: list[DeviceEndpoints] = []
        self._accepted: _Accepted | None = None
        self._is_declaring = False
        self._raw: Any = None
        """The subscription to the integer readings of all robots of the simulator."""
        self._decoder, self._warn = RawDecoder(), ThrottledLog(self.node)
        try:
            self._start(defaults or RuntimeParams())
        except (OptionError, WrongValueError, SdCardError, SettingsError, *PROGRAM_ERRORS) as error:
            self.node.destroy_node()
            raise StartError(str(error)) from error

    @property
    def startup_message(self) -> str:
        """The programs, for the user; the robots are unknown until the simulator publishes its state."""
        programs = dict.fromkeys(endpoints.program.name for endpoints in self.robots if endpoints.program.name)
        return f"Program: {', '.join(programs) or 'none'}"

    def run_once(self, executor: Executor) -> None:
        """Handle messages, then run ready robots for one slice of wall time.

        If endless programs used up the previous slice, other threads of the process get the interpreter for one slice
        first.
        """
        with self._bus.slice():
            busy = [endpoints for endpoints in self.robots if endpoints.is_busy]
            if busy and self._bus.has_ready_robots:
                self._spin_only(executor)
            wait_s = min((endpoints.resumes_s for endpoints in busy), default=inf) - time.monotonic()
            if wait_s > 0.0 and not self._bus.has_ready_robots:
                executor.spin_once(timeout_sec=min(wait_s, SPIN_SLICE_S))
                return
            deliver(executor)
            now_s = time.monotonic()
            self._bus.run_until_idle(
                *[endpoints for endpoints in busy if endpoints.is_busy and endpoints.resumes_s <= now_s]
            )

    @staticmethod
    def _spin_only(executor: Executor) -> None:
        """Handle messages for one slice without running robots."""
        end_s = time.monotonic() + SLICE_S
        while (wait_s := end_s - time.monotonic()) > 0.0:
            executor.spin_once(timeout_sec=wait_s)

    def stop(self) -> None:
        """Stop the wheels and programs of all robots."""
        for endpoints in self.robots:
            endpoints.stop()

    def close(self) -> None:
        """Stop the wheels, then destroy the node."""
        self._jumps.unregister()
        for endpoints in self.robots:
            endpoints.close()
        self.node.destroy_node()

    # -- start

    def _start(self, defaults: RuntimeParams) -> None:
        node = self.node
        self._values = aseba_params.adopt_overrides(node)
        self.params = params.declare(node, defaults)
        self._values |= params.by_name(self.params)
        for name, value in self._values.items():
            aseba_params.check_value(name, value)
        self._options = self.params.options
        self._behaviour = check_behaviour(self.params.behaviour, self.params.layout)
        self._bus = Bus(node, lambda: self.robots, self._on_status_changed)
        self._bus.reaches_all = self.params.emit_reaches == "network"
        self._diagnostics = node.create_publisher(DiagnosticArray, "/diagnostics", qos.SENSOR)
        self._type_mismatches = TypeMismatches(node)
        self._behaviours = node.create_publisher(String, "~/_behaviours", qos.TRANSIENT_LOCAL)
        listed = [{"name": name, "description": text} for name, text in shipped_behaviours().items()]
        self._behaviours.publish(String(data=json.dumps(listed)))
        self._check = CheckService(
            node, layout=self.params.layout, robots=lambda: [endpoints.names.name for endpoints in self.robots]
        )
        if (
            self.params.follow_simulator
            and self.params.robot_topics != "driver"
            and node.count_publishers(SIMULATOR_RAW)
        ):
            self._subscribe_raw(
                SIMULATOR_RAW
            )  # avoids creating subscriptions per robot, which _on_simulator_state would replace
        self._set_robots(self.params.robots)
        if self.params.follow_simulator:
            node.create_subscription(String, SIMULATOR_STATE, self._on_simulator_state, qos.TRANSIENT_LOCAL)
        node.add_pre_set_parameters_callback(lambda given: aseba_params.exclusive(given, self._last_set_text))
        node.add_on_set_parameters_callback(self._check_parameters)
        node.add_post_set_parameters_callback(self._apply_parameters)
        self._jumps = node.get_clock().create_jump_callback(
            JumpThreshold(min_forward=None, min_backward=Duration(nanoseconds=-1), on_clock_change=False),
            post_callback=self._on_jump,
        )
        self._wall = Clock(clock_type=ClockType.STEADY_TIME)
        node.create_timer(DIAGNOSTICS_S, self._publish_diagnostics, clock=self._wall)
        node.create_timer(DIAGNOSTICS_S, self._check_raw_publisher, clock=self._wall)
        node.create_timer(SUBSCRIBERS_S, self._poll_subscribers, clock=self._wall)
        self._variable_timer = node.create_timer(
            1.0 / self.params.watch_rate, self._publish_variables, clock=self._wall
        )

    # -- robots

    def _set_robots(self, names: Sequence[str]) -> None:
        """Create one device for each of these namespaces; existing devices continue with their numbers."""
        here = {endpoints.names.name: endpoints for endpoints in self.robots}
        for name, endpoints in here.items():
            if name not in names:
                endpoints.close()
        kept = {name: endpoints for name, endpoints in here.items() if name in names}
        self.robots = list(kept.values())
        new = [name for name in names if name not in kept]
        for name in new:
            self.robots.append(self._new_robot(name, self._free_number(names.index(name)), alone=len(names) == 1))
        self.robots.sort(key=lambda endpoints: names.index(endpoints.names.name))
        self._share_out(new)

    def _free_number(self, place: int) -> int:
        taken = {endpoints.number for endpoints in self.robots}
        wanted = self.params.first_id + place
        return wanted if wanted not in taken else max(taken) + 1

    def _new_robot(self, name: str, number: int, *, alone: bool) -> DeviceEndpoints:
        if name:
            self._is_declaring = True
            self._values |= aseba_params.declare_robot(self.node, name)
            self._is_declaring = False
        return DeviceEndpoints(
            self.node,
            RobotNames(name),
            number=number,
            bus=self._bus,
            options=self._options.for_robot(name, alone=alone),
            debug_options=self._debug_options(name),
            has_driver=self.params.robot_topics == "driver",
            is_fed=self._raw is not None,
        )

    def _share_out(self, new: Sequence[str]) -> None:
        """Start new robots, and those whose program changes because the file is assigned differently."""
        shares = script_parameters.shares(self._values, self._members(), self.params.layout)
        for endpoints in self.robots:
            share = shares[endpoints.names.name]
            if endpoints.names.name in new or _program(share) != _program(endpoints.share):
                self._start_program(endpoints, share)

    def _start_program(self, endpoints: DeviceEndpoints, share: Assignment | None) -> None:
        """Start a robot with its program or with a built-in behavior."""
        for note in share.notes if share is not None else ():
            self.node.get_logger().warning(f"{endpoints.names.name or 'robot'}: {note}")
        if share is None and self.params.layout != THYMIO:  # the reference playground has no menu
            share = Assignment(None)
        if share is None or self._behaviour:
            endpoints.start(self._behaviour or MENU, share)
        else:
            endpoints.load(share.program, share.notes)

    def _members(self) -> list[RobotId]:
        return [RobotId(endpoints.names.name, endpoints.number) for endpoints in self.robots]

    def _on_simulator_state(self, message: String) -> None:
        """Follow the robots of the simulator."""
        try:
            told = json.loads(message.data)
            names, raw = [str(robot["name"]) for robot in told["robots"]], str(told.get("raw", ""))
        except (ValueError, KeyError, TypeError) as error:
            self._warn(full_name(self.node, SIMULATOR_STATE), f"rejected: {error!r}")
            return
        self._subscribe_raw("" if self.params.robot_topics == "driver" else raw)
        if names != [endpoints.names.name for endpoints in self.robots]:
            try:
                self._set_robots(names)
            except (SdCardError, SettingsError, *PROGRAM_ERRORS) as error:
                self.node.get_logger().error(f"robots {', '.join(names)}: {error}")

    def _subscribe_raw(self, topic: str) -> None:
        """Subscribe to the readings of all robots in one topic; "" selects one topic per robot and sensor."""
        topic = topic and self.node.resolve_topic_name(topic)
        if self._raw is not None and self._raw.topic_name != topic:
            self.node.destroy_subscription(self._raw)
            self._raw = None
        if self._raw is None and topic:
            self._raw = self.node.create_subscription(Int16MultiArray, topic, self._on_raw, qos.EVENTS, raw=True)
        for endpoints in self.robots:
            endpoints.is_fed = self._raw is not None

    def _check_raw_publisher(self) -> None:
        """Return to the topics of each robot if the simulator has ended."""
        if self._raw is not None and not self.node.count_publishers(self._raw.topic_name):
            self._subscribe_raw("")

    def _poll_subscribers(self) -> None:
        for endpoints in self.robots:
            endpoints.poll_subscribers()

    def _on_raw(self, data: bytes) -> None:
        """Feed all readings of one tick, then run robots with work to do, in the order of headless runs."""
        robots = {endpoints.names.name: endpoints for endpoints in self.robots if endpoints.is_fed}
        fed: dict[DeviceEndpoints, None] = {}
        try:
            for robot, sensor, words in self._decoder.decode(data):
                if robot in robots and sensor in _SENSORS:
                    robots[robot].feed(sensor, words)
                    fed[robots[robot]] = None
        except (ValueError, RuntimeError) as error:
            self._warn(full_name(self.node, SIMULATOR_RAW), f"rejected: {error}")
        now_ns = self.node.get_clock().now().nanoseconds
        self._bus.run_until_idle(*[endpoints for endpoints in fed if endpoints.is_due(now_ns)])

    def _on_jump(self, jump: TimeJump) -> None:
        """Restart all robots when time jumps back, as at a reset of the simulator."""
        if jump.clock_change in (ClockChange.ROS_TIME_NO_CHANGE, ClockChange.SYSTEM_TIME_NO_CHANGE):
            for endpoints in self.robots:
                endpoints.restart()

    # -- status and variables

    def _publish_variables(self) -> None:
        for endpoints in self.robots:
            endpoints.publish_variables()

    def _on_status_changed(self, endpoints: DeviceEndpoints) -> None:
        self._publish_statuses([endpoints.status.message])

    def _publish_diagnostics(self) -> None:
        for endpoints in self.robots:
            endpoints.observe_load()
        self._type_mismatches.poll()
        self._publish_statuses(
            [*(endpoints.status.message for endpoints in self.robots), self._type_mismatches.status()]
        )

    def _publish_statuses(self, statuses: Iterable[DiagnosticStatus]) -> None:
        if self._diagnostics.get_subscription_count():
            message = DiagnosticArray(status=list(statuses))
            message.header.stamp = self.node.get_clock().now().to_msg()
            self._diagnostics.publish(message)

    # -- parameters

    def _check_parameters(self, parameters: list[Parameter]) -> SetParametersResult:
        if self._is_declaring:
            return SetParametersResult(successful=True)
        changes = params.changes(parameters)
        named = script_parameters.named(changes, self._last_set_text)
        values = self._values | named
        try:
            for name, value in changes.items():
                if not (self.node.has_parameter(name) or aseba_params.is_free(name)):
                    raise WrongValueError(f"found unknown parameter {name}")
                aseba_params.check_value(name, value)
            if reason := params.refusal(self.params, parameters):
                raise WrongValueError(reason)
            check_behaviour(changes.get("behaviour", ""), self.params.layout)
            shares = self._checked_shares(values, named)
        except (WrongValueError, *PROGRAM_ERRORS) as error:
            self._accepted = None
            return SetParametersResult(successful=False, reason=str(error))
        self._accepted = _Accepted(values, named, shares)
        return SetParametersResult(successful=True)

    def _last_set_text(self, name: str) -> str:
        """Return the value of a text parameter as set last, or an empty text."""
        return str(self.node.get_parameter_or(name, Parameter(name, value="")).value)

    def _checked_shares(self, values: dict[str, Any], changes: dict[str, Any]) -> dict[str, Assignment | None]:
        """Return the program of each robot if a script changes; programs of absent robots must compile too."""
        if not any(".script." in f".{name}" for name in changes):
            return {}
        absent = set(script_parameters.named_robots(changes)) - {endpoints.names.name for endpoints in self.robots}
        for name in sorted(absent):
            script_parameters.shares(values, [RobotId(name, self.params.first_id)], self.params.layout)
        return script_parameters.shares(values, self._members(), self.params.layout)

    def _apply_parameters(self, parameters: list[Parameter]) -> None:
        accepted, self._accepted = self._accepted, None
        if accepted is None:
            return
        old, self._values = self._values, accepted.values
        before = self._behaviour
        changes = accepted.changes
        self.params = params.updated(self.params, parameters)
        self._bus.reaches_all = self.params.emit_reaches == "network"
        if "watch_rate" in changes:
            self.node.destroy_timer(self._variable_timer)
            self._variable_timer = self.node.create_timer(
                1.0 / self.params.watch_rate, self._publish_variables, clock=self._wall
            )
        if "behaviour" in changes:
            self._behaviour = self.params.behaviour
        for endpoints in self.robots:
            endpoints.set_debug_options(self._debug_options(endpoints.names.name))
            self._apply_script(endpoints, old, accepted, is_switched=self._behaviour != before)

    def _apply_script(
        self, endpoints: DeviceEndpoints, old: dict[str, Any], accepted: _Accepted, *, is_switched: bool
    ) -> None:
        name = endpoints.names.name
        share = accepted.shares.get(name, endpoints.share)
        is_other = script_parameters.script_of(old, name) != script_parameters.script_of(accepted.values, name)
        if is_other or _program(share) != _program(endpoints.share):
            if "behaviour" not in accepted.changes:
                self._behaviour = ""
            self._start_program(endpoints, share or Assignment(None))
        elif is_switched:
            self._start_program(endpoints, share)

    def _debug_options(self, robot: str) -> DebugOptions:
        """Return the options of one robot: its breakpoints replace those for all, its watches are added to them."""
        values = self._values
        own = f"robots.{robot}."
        return DebugOptions(
            breakpoints=tuple(values.get(f"{own}breakpoints") or values.get("breakpoints") or ()),
            watch=(*(values.get("watch") or ()), *(values.get(f"{own}watch") or ())),
            local_events=tuple(values.get("local_events") or ()),
            language=str(values.get("language", "en")),
        )


def _program(share: Assignment | None) -> object:
    return None if share is None else share.program


def main(args: Sequence[str] | None = None) -> int:
    """Run the executable `aseba_runtime`."""
    return run_main(lambda context: announce([AsebaRuntime(context)]), args)
