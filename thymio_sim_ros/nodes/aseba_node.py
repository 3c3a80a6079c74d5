"""The Aseba runtime as a ROS node: feeds readings to devices, sends their commands, carries their events.

It knows topics, not simulators: any robot that has them will do (ros-interface.md section 6). Devices keep
simulated time by the node's clock. The program is a parameter; a text that does not compile is refused with
its place, and the old program goes on. A robot without a program is switched on with its menu.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from rcl_interfaces.msg import SetParametersResult
from rclpy.clock import ClockChange, JumpThreshold, TimeJump
from rclpy.context import Context
from rclpy.duration import Duration
from rclpy.executors import Executor
from rclpy.node import Node
from rclpy.parameter import Parameter
from std_msgs.msg import String

from thymio_sim_ros import resources
from thymio_sim_ros.device.behaviour_host import MENU
from thymio_sim_ros.device.card import CardError
from thymio_sim_ros.device.layout import THYMIO
from thymio_sim_ros.device.options import DeviceOptions, OptionError
from thymio_sim_ros.device.program import ProgramError, ThymioProgram, load_program
from thymio_sim_ros.device.settings import SettingsError
from thymio_sim_ros.loading import NO_PROGRAM, check_behaviour, read_program, shipped_behaviours
from thymio_sim_ros.nodes import params, qos
from thymio_sim_ros.nodes.device_ports import DevicePorts
from thymio_sim_ros.nodes.life import SPIN_SLICE_S, StartError, deliver, run_main
from thymio_sim_ros.nodes.names import RobotNames
from thymio_sim_ros.nodes.params import param

SIMULATOR_STATE = "/simulator/state"


@dataclass(frozen=True)
class RuntimeParams:
    """Parameters of the Aseba runtime node."""

    robots: list[str] = param(
        [""], "Namespaces of the robots that run the program at first; '' is the only robot", fixed=True
    )
    follow_simulator: bool = param(
        True, "Whether the robots are those of /simulator/state, once there is one", fixed=True
    )
    path: str = param("", "Program: a built-in behaviour's name or an .aesl file", name="script.path")
    source: str = param("", "Program: text of an .aesl file or of one Aseba program", name="script.source")
    name: str = param("", "Name shown for a program given as text", name="script.name")
    behaviour: str = param(
        "", "Built-in behaviour, such as menu, that the robot is switched on with; '' is the program, or the menu"
    )
    layout: str = param(
        "thymio", "Order of variables and natives: thymio (firmware 14) or playground (the reference's)", fixed=True
    )
    events: str = param(
        "firmware", "How events meet: firmware (they wait) or playground (they end a handler that runs)", fixed=True
    )
    card: str = param("", "Folder that stands for the memory card; '' is no card", fixed=True)
    settings: str = param("", "Folder that keeps the robot's settings; '' forgets them", fixed=True)

    @property
    def options(self) -> DeviceOptions:
        """What these say about the robots; OptionError for a choice that does not exist."""
        folders = (Path(text).expanduser() if text else None for text in (self.card, self.settings))
        return DeviceOptions(self.layout, self.events, *folders)


class AsebaRuntime:
    """The runtime node: one device per robot, all on one Aseba bus."""

    def __init__(
        self, context: Context, defaults: RuntimeParams | None = None, *, use_sim_time: bool | None = None
    ) -> None:
        overrides = [] if use_sim_time is None else [Parameter("use_sim_time", value=use_sim_time)]
        self.node = Node("aseba_runtime", context=context, parameter_overrides=overrides)
        self.params = params.declare(self.node, defaults or RuntimeParams())
        try:
            self._options = self.params.options
            self._program = self._first_program()
            self._behaviour = check_behaviour(self.params.behaviour, self.params.layout)
        except (OptionError, ProgramError, resources.ResourceError, OSError) as error:
            self.node.destroy_node()
            raise StartError(str(error)) from error
        self._accepted: ThymioProgram | None = None
        self._behaviours = self.node.create_publisher(String, "~/behaviours", qos.LATCHED)
        listed = [{"name": name, "description": text} for name, text in shipped_behaviours().items()]
        self._behaviours.publish(String(data=json.dumps(listed)))
        self.robots: list[DevicePorts] = []
        try:
            self._set_robots(self.params.robots)
        except (CardError, SettingsError) as error:
            self.node.destroy_node()
            raise StartError(str(error)) from error
        if self.params.follow_simulator:
            self.node.create_subscription(String, SIMULATOR_STATE, self._on_simulator_state, qos.LATCHED)
        self.node.add_on_set_parameters_callback(self._check_parameters)
        self.node.add_post_set_parameters_callback(self._apply_parameters)
        self._jumps = self.node.get_clock().create_jump_callback(
            JumpThreshold(min_forward=None, min_backward=Duration(nanoseconds=-1), on_clock_change=False),
            post_callback=self._on_jump,
        )

    def load(self, program: ThymioProgram) -> None:
        """Run this program on every robot, from its start."""
        self._program, self._behaviour = program, ""
        self._begin()

    def turn(self, executor: Executor) -> None:
        """Handle messages; let handlers that used up their budget go on."""
        busy = any(ports.is_busy for ports in self.robots)
        if not busy:
            executor.spin_once(timeout_sec=SPIN_SLICE_S)
        else:
            deliver(executor)
            for ports in self.robots:
                ports.run()

    def close(self) -> None:
        """Stop the wheels that a program drives, then destroy the node."""
        self._jumps.unregister()
        for ports in self.robots:
            ports.close()
        self.node.destroy_node()

    def _begin(self) -> None:
        """Let every robot begin with the program, or with the behaviour that it is to be switched on with."""
        for ports in self.robots:
            if self._program is None or self._behaviour:
                ports.start(self._behaviour or MENU, self._program)
            else:
                ports.load(self._program)

    def _first_program(self) -> ThymioProgram | None:
        if self.params.source:
            return load_program(self.params.source, self.params.name or "program", self.params.layout)
        if self.params.path or self.params.layout != THYMIO:  # the reference playground has no menu
            return read_program(self.params.path or NO_PROGRAM, self.params.layout)
        return None

    def _set_robots(self, names: Sequence[str]) -> None:
        """One device for each of these namespaces, numbered in their order; all begin anew."""
        for ports in self.robots:
            ports.close()
        alone = len(names) == 1
        self.robots = [
            DevicePorts(
                self.node,
                RobotNames(name),
                node_id=number,
                bus=self._pass_on,
                options=self._options.for_robot(name, alone=alone),
            )
            for number, name in enumerate(names, start=1)
        ]
        self._begin()

    def _on_simulator_state(self, message: String) -> None:
        """Another playground may have other robots."""
        names = [robot["name"] for robot in json.loads(message.data)["robots"]]
        if names != [ports.names.name for ports in self.robots]:
            self._set_robots(names)

    def _pass_on(self, sender: DevicePorts, event: str, args: Sequence[int]) -> None:
        """Robots of one runtime hear each other directly, as on an Aseba network."""
        for ports in self.robots:
            if ports is not sender and ports.device.hears(sender.device):
                ports.hear(event, args, source=sender.device.node_id)

    def _on_jump(self, jump: TimeJump) -> None:
        """Time went back: the simulator was reset, and so are the robots' machines."""
        if jump.clock_change in (ClockChange.ROS_TIME_NO_CHANGE, ClockChange.SYSTEM_TIME_NO_CHANGE):
            for ports in self.robots:
                ports.restart()

    def _check_parameters(self, parameters: list[Parameter]) -> SetParametersResult:
        changed = params.changes(parameters)
        try:
            if "script.source" in changed:
                name = changed.get("script.name", self.params.name)
                self._accepted = load_program(changed["script.source"], name or "program", self.params.layout)
            elif "script.path" in changed:
                self._accepted = read_program(changed["script.path"] or NO_PROGRAM, self.params.layout)
            check_behaviour(changed.get("behaviour", ""), self.params.layout)
        except (ProgramError, resources.ResourceError, OSError) as error:
            self._accepted = None
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def _apply_parameters(self, parameters: list[Parameter]) -> None:
        changed = params.changes(parameters)
        if "script.name" in changed:
            self.params = replace(self.params, name=changed["script.name"])
        accepted, self._accepted = self._accepted, None
        if accepted is not None or "behaviour" in changed:
            self._program = accepted or self._program
            self._behaviour = changed.get("behaviour", "")
            self._begin()


def main(args: Sequence[str] | None = None) -> int:
    """The executable `aseba_runtime`."""
    return run_main(lambda context: [AsebaRuntime(context)], args)
