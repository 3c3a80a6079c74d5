"""The robots of a runtime: creates and closes their devices and starts their programs."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, overload

from rclpy.node import Node

from aseba_vm.targets import THYMIO_II
from thymio_sim_ros.device.behavior_host import MENU
from thymio_sim_ros.device.firmware.sd_card import SdCardError
from thymio_sim_ros.device.firmware.settings import SettingsError
from thymio_sim_ros.device.layout import THYMIO, described
from thymio_sim_ros.device.programs.program import ProgramError
from thymio_sim_ros.device.programs.program_assignment import Assignment, RobotId
from thymio_sim_ros.files import resources
from thymio_sim_ros.files.loading import check_behaviour
from thymio_sim_ros.network.robot_target import Target, TargetError, parse_target
from thymio_sim_ros.ros.aseba import script_parameters
from thymio_sim_ros.ros.aseba.bus import Bus
from thymio_sim_ros.ros.aseba.device_endpoints import DeviceEndpoints
from thymio_sim_ros.ros.aseba.diagnostics import RuntimeDiagnostics
from thymio_sim_ros.ros.aseba.real_robot import RealRobot
from thymio_sim_ros.ros.aseba.runtime_values import RuntimeValues
from thymio_sim_ros.ros.aseba.simulator_link import SimulatorLink
from thymio_sim_ros.ros.interface.names import RobotNames

__all__ = ["PROGRAM_ERRORS", "ROBOT_ERRORS", "ParameterChange", "RobotSet"]

PROGRAM_ERRORS = (ProgramError, resources.ResourceError, OSError)
"""Raised for a program that cannot be loaded."""

ROBOT_ERRORS = (SdCardError, SettingsError, TargetError, *PROGRAM_ERRORS)
"""Raised for a robot that cannot be created."""


@dataclass(frozen=True, slots=True)
class ParameterChange:
    """Checked parameters: all values, the changes, and the program of each robot if a script changes."""

    values: dict[str, Any]
    changes: dict[str, Any]
    shares: dict[str, Assignment | None]


class RobotSet(Sequence[DeviceEndpoints]):
    """One device per robot, in the order of the simulator. Invariant: a robot that stays keeps device and number."""

    def __init__(
        self, node: Node, values: RuntimeValues, diagnostics: RuntimeDiagnostics, link: SimulatorLink | None = None
    ) -> None:
        """Raises OptionError for unknown options, ResourceError for an unknown built-in behavior, TargetError for a
        wrong address of a real robot.
        """
        self._node, self._values = node, values
        self._options = values.params.options
        self._behaviour = check_behaviour(values.params.behaviour, values.params.layout)
        """The built-in behavior that robots are switched on with; empty: their program, or the menu."""
        self._diagnostics, self._link = diagnostics, link
        self._robots: list[DeviceEndpoints] = []
        self._is_fed = False
        self._target = parse_target(values.params.robot) if values.params.robot else None
        """The address of a real robot."""
        self._real: RealRobot | None = None
        if self._target is not None:
            values.set_layout(described(THYMIO_II))
            if len(values.params.robots) != 1:
                raise TargetError(f"robot {self._target}: found {len(values.params.robots)} robot_names, expected 1")
        self.bus = Bus(node, self, diagnostics.messages)
        self.on_change: Callable[[], None] = lambda: None
        """Called when robots have come or gone."""

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

    def feed(self, is_fed: bool) -> None:
        """Feed readings to all robots, also to later ones, by `DeviceEndpoints.feed` instead of their subscriptions."""
        self._is_fed = is_fed
        for endpoints in self._robots:
            endpoints.is_fed = is_fed

    def set_names(self, names: Sequence[str]) -> None:
        """Create one device for each of these namespaces; existing devices continue with their numbers.

        Raises one of `ROBOT_ERRORS`.
        """
        kept = []
        for endpoints in self._robots:
            if endpoints.names.name in names:
                kept.append(endpoints)
            else:
                endpoints.close()
        self._robots = kept
        known = self.names
        new = [name for name in names if name not in known]
        for name in new:
            self._robots.append(self._new_robot(name, self._free_number(names.index(name)), alone=len(names) == 1))
        self._robots.sort(key=lambda endpoints: names.index(endpoints.names.name))
        self._assign_programs(new)
        self.on_change()

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
        """Restart all robots, after a jump back in time."""
        for endpoints in self._robots:
            endpoints.restart()

    def poll_subscribers(self) -> None:
        """Publish earlier commands again for new subscribers."""
        for endpoints in self._robots:
            endpoints.poll_subscribers()

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
            endpoints.close()
        if self._real is not None:
            self._real.close()

    def _free_number(self, place: int) -> int:
        """Return the number by place in the order of robots, or the first one above all others if it is taken."""
        taken = {endpoints.number for endpoints in self._robots}
        wanted = self._values.params.first_id + place
        return wanted if wanted not in taken else max(taken) + 1

    def _new_robot(self, name: str, number: int, *, alone: bool) -> DeviceEndpoints:
        if name:
            self._values.declare_robot(name)
        if self._target is not None:
            return self._new_real_robot(RobotNames(name), number, self._target)
        return DeviceEndpoints(
            self._node,
            RobotNames(name),
            number=number,
            bus=self.bus,
            diagnostics=self._diagnostics,
            options=self._options.for_robot(name, alone=alone),
            debug_options=self._values.debug_options(name),
            has_driver=self._values.params.robot_topics == "driver",
            is_fed=self._is_fed,
            link=self._link,
        )

    def _new_real_robot(self, names: RobotNames, number: int, target: Target) -> DeviceEndpoints:
        timeout_s, messages = self._values.params.cmd_vel_timeout, self._diagnostics.messages
        real = RealRobot(self._node, names, target, number=number, timeout_s=timeout_s, messages=messages)
        endpoints = DeviceEndpoints(
            self._node,
            names,
            number=number,
            bus=self.bus,
            diagnostics=self._diagnostics,
            remote=real.robot,
            debug_options=self._values.debug_options(names.name),
            is_fed=True,
        )
        real.on_change = endpoints.run
        real.on_connected = lambda: self._load_real_robot(real, endpoints)
        self._real = real
        return endpoints

    def _load_real_robot(self, real: RealRobot, endpoints: DeviceEndpoints) -> None:
        """Load the program into a robot that has connected, for the layout that it describes."""
        self._values.set_layout(real.robot.device.layout)
        name = endpoints.names.name
        try:
            share = script_parameters.shares(self._values.by_name, self.members, self._values.params.layout)[name]
        except PROGRAM_ERRORS as error:
            share = Assignment(None, (f"not loaded: {error}",))
        self._start_program(endpoints, share)

    def _assign_programs(self, new: Sequence[str]) -> None:
        """Start new robots, and those whose program changes because the file is assigned differently."""
        shares = script_parameters.shares(self._values.by_name, self.members, self._values.params.layout)
        for endpoints in self._robots:
            share = shares[endpoints.names.name]
            if endpoints.names.name in new or _program(share) != _program(endpoints.share):
                self._start_program(endpoints, share)

    def _apply_program(
        self, endpoints: DeviceEndpoints, old: Mapping[str, Any], change: ParameterChange, *, is_switched: bool
    ) -> bool:
        """Start a robot whose program or built-in behavior changes; return whether it was started."""
        name = endpoints.names.name
        share = change.shares.get(name, endpoints.share)
        is_other = script_parameters.script_of(old, name) != script_parameters.script_of(change.values, name)
        is_replaced = name in change.shares and endpoints.program.is_foreign  # a tool has loaded another program since
        if is_other or is_replaced or _program(share) != _program(endpoints.share):
            if "behaviour" not in change.changes:
                self._behaviour = ""
            self._start_program(endpoints, share or Assignment(None))
            return True
        if is_switched:
            self._start_program(endpoints, share)
        return is_switched

    def _start_program(self, endpoints: DeviceEndpoints, share: Assignment | None) -> None:
        """Start a robot with its program or with a built-in behavior."""
        for note in share.notes if share is not None else ():
            self._node.get_logger().warning(f"{endpoints.names.name or 'robot'}: {note}")
        if share is None and self._values.params.layout != THYMIO:  # the reference playground has no menu
            share = Assignment(None)
        if share is None or self._behaviour:
            endpoints.start(self._behaviour or MENU, share)
        else:
            endpoints.load(share.program, share.notes)


def _program(share: Assignment | None) -> object:
    return None if share is None else share.program
