"""The robots of a runtime: creates and closes their devices and starts their programs."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence, Set
from dataclasses import dataclass
from functools import partial
from typing import Any, overload

from rclpy.node import Node

from aseba_vm.targets import THYMIO_II
from thymio_sim_ros.device.behavior_host import MENU
from thymio_sim_ros.device.firmware.sd_card import SdCardError
from thymio_sim_ros.device.firmware.settings import SettingsError
from thymio_sim_ros.device.layout import THYMIO, described
from thymio_sim_ros.device.network_events import EmittedEvent
from thymio_sim_ros.device.programs.program import ProgramError
from thymio_sim_ros.device.programs.program_assignment import Assignment, RobotId
from thymio_sim_ros.engine.devices import SentMessages
from thymio_sim_ros.engine.inputs import DevicesAdded
from thymio_sim_ros.files import resources
from thymio_sim_ros.files.loading import check_behaviour
from thymio_sim_ros.network.robot_target import Target, TargetError, parse_target
from thymio_sim_ros.ros.aseba import script_parameters
from thymio_sim_ros.ros.aseba.device_endpoints import DeviceEndpoints
from thymio_sim_ros.ros.aseba.diagnostics import RuntimeDiagnostics
from thymio_sim_ros.ros.aseba.emitter import Emitter
from thymio_sim_ros.ros.aseba.engine_owner import EngineOwner
from thymio_sim_ros.ros.aseba.outside.outside_robot import OutsideRobot
from thymio_sim_ros.ros.aseba.outside.real_robot import RealRobot
from thymio_sim_ros.ros.aseba.outside.standalone_owner import StandaloneOwner
from thymio_sim_ros.ros.aseba.program_owner import ProgramOwner
from thymio_sim_ros.ros.aseba.runtime_values import RuntimeValues
from thymio_sim_ros.ros.interface.names import RobotNames
from thymio_sim_ros.ros.simulator.world_runner import WorldRunner
from thymio_sim_ros.sim.commands import Command

__all__ = ["PROGRAM_ERRORS", "ROBOT_ERRORS", "ParameterChange", "RobotSet"]

PROGRAM_ERRORS = (ProgramError, resources.ResourceError, OSError)
"""Raised for a program that cannot be loaded."""

ROBOT_ERRORS = (SdCardError, SettingsError, TargetError, *PROGRAM_ERRORS)
"""Raised for a robot that cannot be created."""


@dataclass(frozen=True, slots=True)
class ParameterChange:
    """Checked parameters: all values, the changes, and the program of each robot if a script changes.

    The robots `started_again` start also if nothing changes for them.
    """

    values: dict[str, Any]
    changes: dict[str, Any]
    shares: dict[str, Assignment | None]
    started_again: frozenset[str] = frozenset()


class RobotSet(Sequence[DeviceEndpoints]):
    """One device per robot, in the order of the simulator. Invariant: a robot that stays keeps device and number."""

    def __init__(
        self, node: Node, values: RuntimeValues, diagnostics: RuntimeDiagnostics, runner: WorldRunner | None = None
    ) -> None:
        """`runner`: of the simulator in the same process, whose engine runs the programs.

        Raises OptionError for unknown options, ResourceError for an unknown built-in behavior, TargetError for a wrong
        address of a real robot.
        """
        self._node, self._values, self._runner = node, values, runner
        params = values.params
        self._options = params.options
        self._behaviour = check_behaviour(params.behaviour, params.layout)
        """The built-in behavior that robots are switched on with; empty: their program, or the menu."""
        self._diagnostics = diagnostics
        self._robots: list[DeviceEndpoints] = []
        self._target = parse_target(params.robot) if params.robot else None
        """The address of a real robot."""
        self._real: RealRobot | None = None
        if self._target is not None:
            values.set_layout(described(THYMIO_II))
            if len(params.robots) != 1:
                raise TargetError(f"robot {self._target}: found {len(params.robots)} robot_names, expected 1")
        self._outside: dict[str, OutsideRobot] = {}
        """The topics of robots outside of this process."""
        self.owner: ProgramOwner
        """Runs the programs."""
        if runner is None:
            self.standalone: StandaloneOwner | None = StandaloneOwner(
                lambda: node.get_clock().now().nanoseconds, send=self._send, publish=self.publish
            )
            self.owner = self.standalone
        else:
            self.standalone = None
            self.owner = EngineOwner(runner, self.publish)
        self.emitter = Emitter(node, self.owner, self, diagnostics.messages)
        self._published_runs = 0
        self.on_change: Callable[[], None] = lambda: None
        """Called when robots have come or gone."""
        self.on_sent: Callable[[Sequence[SentMessages]], None] = lambda sent: None
        """Called with messages of the robots for the clients of their networks."""

    @overload
    def __getitem__(self, index: int) -> DeviceEndpoints: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[DeviceEndpoints]: ...
    def __getitem__(self, index: int | slice) -> DeviceEndpoints | Sequence[DeviceEndpoints]:
        return self._robots[index]

    def __iter__(self) -> Iterator[DeviceEndpoints]:
        return iter(self._robots)

    def __len__(self) -> int:
        return len(self._robots)

    @property
    def names(self) -> list[str]:
        """ROS names of the robots."""
        return [endpoints.names.name for endpoints in self._robots]

    @property
    def members(self) -> list[RobotId]:
        """Names and numbers of the robots, for the assignment of programs."""
        return [RobotId(endpoints.names.name, endpoints.number) for endpoints in self._robots]

    def follow(self, names: Mapping[str, RobotNames], *, is_new: bool = False) -> None:
        """Serve these robots; those that stay keep their numbers, and their devices unless the world is new.

        In a replay, these are the robots that have devices in the log.
        Raises one of `ROBOT_ERRORS`.
        """
        if self.owner.is_replaying:
            names = {robot: ros_names for robot, ros_names in names.items() if robot in self.owner.hosts}
        kept = []
        for endpoints in self._robots:
            if names.get(endpoints.robot) == endpoints.names:
                kept.append(endpoints)
            else:
                self._remove(endpoints)
        self._robots = kept
        known = {endpoints.robot for endpoints in kept}
        order = list(names)
        for robot, ros_names in names.items():
            if robot not in known:
                self._robots.append(self._new_robot(robot, ros_names, self._free_number(order.index(robot))))
        self._robots.sort(key=lambda endpoints: order.index(endpoints.robot))
        self._assign_programs(new=names.keys() if is_new else names.keys() - known)
        self.on_change()

    def publish(self) -> None:
        """Publish the results of the last run of the programs."""
        owner = self.owner
        events: dict[str, list[EmittedEvent]] = {}
        ran: Set[str] = frozenset()
        if owner.runs != self._published_runs:
            self._published_runs, ran = owner.runs, owner.ran
            for robot, event in owner.emitted:
                events.setdefault(robot, []).append(event)
        hosts = owner.hosts  # a tick may be executed while a new robot gets its device
        for endpoints in self._robots:
            if endpoints.robot not in hosts:
                continue
            if endpoints.robot in ran or endpoints.device.local_events.has_occurred:
                emitted = events.get(endpoints.robot, ())
                endpoints.publish(emitted)
                self.emitter.forward(endpoints, emitted)
        if sent := owner.pop_sent():
            self.on_sent(sent)

    def apply(self, old: Mapping[str, Any], change: ParameterChange) -> bool:
        """Apply accepted parameters to all robots: debug options, programs, built-in behavior.

        Returns whether a robot was started again.
        """
        before = self._behaviour
        if "behaviour" in change.changes:
            self._behaviour = self._values.params.behaviour
        is_switched = self._behaviour != before  # not by a robot that gets a program of its own
        has_started = False
        for endpoints in self._robots:
            endpoints.set_debug_options(self._values.debug_options(endpoints.names.name))
            has_started |= self._apply_program(endpoints, old, change, is_switched=is_switched)
        return has_started

    def restart(self) -> None:
        """Restart the programs of robots outside of this process, after a jump back in time."""
        if self.standalone is not None:
            self.standalone.restart()

    def refresh(self) -> None:
        """Publish the state of all programs after a reset of the world."""
        self.publish()
        for endpoints in self._robots:
            endpoints.publish()

    def poll_subscribers(self) -> None:
        """Publish earlier commands again for new subscribers; defer no ticks while events have receivers."""
        if self._runner is not None:
            is_prompt = self._runner.engine.has_clients or any(
                endpoints.has_event_subscribers for endpoints in self._robots
            )
            self._runner.scheduler.is_prompt = is_prompt
        for outside in self._outside.values():
            outside.outputs.resend()

    def publish_variables(self) -> None:
        """Publish variables that changed."""
        for endpoints in self._robots:
            endpoints.publish_variables()

    def stop(self) -> None:
        """Stop the wheels and programs of all robots."""
        for endpoints in self._robots:
            endpoints.stop()
        if self._real is not None:
            self._real.flush()

    def close(self) -> None:
        """Stop all robots and destroy their topics and services."""
        for endpoints in self._robots:
            self._remove(endpoints)
        if self._real is not None:
            self._real.close()

    def _remove(self, endpoints: DeviceEndpoints) -> None:
        endpoints.close()
        outside = self._outside.pop(endpoints.robot, None)
        if outside is not None:
            outside.close()
        if self.standalone is not None:
            self.standalone.devices.remove(endpoints.robot)

    def _send(self, robot: str, command: Command) -> None:
        if robot in self._outside:
            self._outside[robot].outputs.send(command)

    def _free_number(self, place: int) -> int:
        """Return the number by place in the order of robots, or the first one above all others if it is taken."""
        taken = {endpoints.number for endpoints in self._robots}
        wanted = self._values.params.first_id + place
        return wanted if wanted not in taken else max(taken) + 1

    def _new_robot(self, robot: str, names: RobotNames, number: int) -> DeviceEndpoints:
        if names.name:
            self._values.declare_robot(names.name)
        endpoints = DeviceEndpoints(
            self._node,
            names,
            self.owner,
            robot,
            number=number,
            emit=self.emitter.emit,
            diagnostics=self._diagnostics,
            values=self._values,
            is_simulated=self._target is None,
        )
        if self.standalone is not None and self._target is not None:
            self._connect(endpoints, self.standalone, self._target)
        elif self.standalone is not None:
            feed = partial(self.standalone.feed, robot)
            self._outside[robot] = OutsideRobot(self._node, names, feed)
        return endpoints

    def _connect(self, endpoints: DeviceEndpoints, owner: StandaloneOwner, target: Target) -> None:
        """Reach the robot of these endpoints by a link."""
        timeout_s, messages = self._values.params.cmd_vel_timeout, self._diagnostics.messages
        real = RealRobot(
            self._node, endpoints.names, target, number=endpoints.number, timeout_s=timeout_s, messages=messages
        )
        owner.devices.add(endpoints.robot, real.robot.host, real.robot.gateway)
        real.on_change = owner.run
        real.on_connected = lambda: self._load_real_robot(real, endpoints)
        self._real = real

    def _load_real_robot(self, real: RealRobot, endpoints: DeviceEndpoints) -> None:
        """Load the program into a robot that has connected, for the layout that it describes."""
        self._values.set_layout(real.robot.device.layout)
        name = endpoints.names.name
        try:
            share = script_parameters.shares(self._values.by_name, self.members, self._values.params.layout)[name]
        except PROGRAM_ERRORS as error:
            share = Assignment(None, (f"not loaded: {error}",))
        self._start_program(endpoints, share)

    def _assign_programs(self, new: Collection[str]) -> None:
        """Start new robots, and those whose program changes because the file is assigned differently."""
        if self.owner.is_replaying:
            for endpoints in self._robots:
                endpoints.publish()
            return
        shares = script_parameters.shares(self._values.by_name, self.members, self._values.params.layout)
        starts = {}
        for endpoints in self._robots:
            share = shares[endpoints.names.name]
            if endpoints.robot in new:
                share, behaviour = self._started(endpoints, share)
                starts[endpoints.robot] = endpoints.begin(share, behaviour)
            elif _program(share) != _program(endpoints.share):
                self._start_program(endpoints, share)
        if starts and self._real is None:
            self.owner.apply(DevicesAdded(starts, self._options, self._values.params.network.aseba_shared))
        for endpoints in self._robots:
            if endpoints.robot in new:
                endpoints.publish()

    def _apply_program(
        self, endpoints: DeviceEndpoints, old: Mapping[str, Any], change: ParameterChange, *, is_switched: bool
    ) -> bool:
        """Start a robot whose program or built-in behavior changes; return whether it was started."""
        name = endpoints.names.name
        share = change.shares.get(name, endpoints.share)
        is_other = script_parameters.script_of(old, name) != script_parameters.script_of(change.values, name)
        is_replaced = name in change.shares and endpoints.program.is_foreign  # a tool has loaded another program since
        is_again = name in change.started_again
        is_of_program = is_again and "behaviour" not in change.changes
        if is_other or is_replaced or is_of_program or _program(share) != _program(endpoints.share):
            if "behaviour" not in change.changes:
                self._behaviour = ""
            self._start_program(endpoints, share or Assignment(None))
            return True
        if is_switched or is_again:
            self._start_program(endpoints, share)
        return is_switched or is_again

    def _start_program(self, endpoints: DeviceEndpoints, share: Assignment | None) -> None:
        """Start a robot with its program or with a built-in behavior."""
        endpoints.load(*self._started(endpoints, share))

    def _started(self, endpoints: DeviceEndpoints, share: Assignment | None) -> tuple[Assignment | None, str]:
        """Return the program of a robot and the built-in behavior that it is switched on with, if any."""
        if endpoints.robot in self._outside:
            self._outside[endpoints.robot].outputs.start_program()
        for note in share.notes if share is not None else ():
            self._node.get_logger().warning(f"{endpoints.names.name or 'robot'}: {note}")
        if share is None and self._values.params.layout != THYMIO:  # the reference playground has no menu
            share = Assignment(None)
        return share, self._behaviour or ("" if share is not None else MENU)


def _program(share: Assignment | None) -> object:
    return None if share is None else share.program
