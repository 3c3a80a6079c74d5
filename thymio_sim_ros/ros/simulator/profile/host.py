"""The endpoints of a profile: its node with parameters, and topics, services and actions of each robot."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, make_dataclass
from functools import partial
from typing import Any

from rclpy.context import Context
from rclpy.node import Node
from rclpy.parameter import Parameter

from thymio_sim_ros.ros.interface import qos
from thymio_sim_ros.ros.interface.command_checks import CommandError
from thymio_sim_ros.ros.interface.convert_readings import ConvertOptions
from thymio_sim_ros.ros.interface.names import RobotNames, full_name
from thymio_sim_ros.ros.interface.robot_inputs import InputContext, RobotInput
from thymio_sim_ros.ros.interface.sensor_topics import Row
from thymio_sim_ros.ros.profiles import InputRow, ParameterRow, Profile, ProfileError, ServiceRow, TopicRow
from thymio_sim_ros.ros.rclpy_ext import parameters
from thymio_sim_ros.ros.rclpy_ext.message_reports import MessageReports
from thymio_sim_ros.ros.rclpy_ext.node_runner import StartError
from thymio_sim_ros.ros.rclpy_ext.parameter_node import parameter_node
from thymio_sim_ros.ros.rclpy_ext.peers import PeerContext
from thymio_sim_ros.ros.simulator.profile.goals import RobotGoals
from thymio_sim_ros.ros.simulator.profile.types import UsableProfile, usable
from thymio_sim_ros.ros.simulator.profile.world import RunningRobot, RunningWorld
from thymio_sim_ros.ros.simulator.world_runner import WorldRunner
from thymio_sim_ros.ros.simulator.world_services import at_current_tick
from thymio_sim_ros.sim.commands import Command

__all__ = ["ProfileHost"]


@dataclass(slots=True)
class _RobotEndpoints:
    """Implements `OtherEndpoints` for one robot."""

    host: ProfileHost
    node: Node
    rows: Mapping[str, Sequence[Row]]
    inputs: Sequence[tuple[Node, RobotInput]]
    robot: RunningRobot
    services: list[Any]
    goals: RobotGoals | None

    def reset(self) -> None:
        """Forget what the rows keep, abort the goal, and begin anew."""
        self.robot.memory.clear()
        self.begin()
        if self.goals is not None:
            self.goals.abort("the world was reset")

    def begin(self) -> None:
        """Post the commands with which the robot begins; those of a replay come from its log."""
        begin, runner = self.host.profile.begin, self.robot.world.runner
        if begin is not None and not runner.is_replaying:
            for command in begin(self.robot):
                self.robot.post(command)

    def close(self) -> None:
        """Destroy services and actions."""
        for service in self.services:
            self.node.destroy_service(service)
        if self.goals is not None:
            self.goals.close()
        self.host.forget(self)


class ProfileHost:
    """The endpoints of a profile beside those of the simulator, on a node of their own if the profile names one.

    `node` is that node, or the simulator's. Invariant: only the thread of the simulator's executor uses it.
    """

    def __init__(self, context: Context, simulator: Node, profile: Profile) -> None:
        """Raises StartError for a profile that cannot be used, and for wrong values of its parameters."""
        try:
            self._usable: UsableProfile = usable(profile)
        except ProfileError as error:
            raise StartError(str(error)) from error
        self.profile = self._usable.profile
        self._has_node = bool(profile.node)
        self._peers: PeerContext | None = None
        missing = profile.missing_parameter
        self.node = parameter_node(profile.node, context=context, missing=missing) if self._has_node else simulator
        try:
            _declare(self.node, self.profile.node_parameters)
        except StartError:
            self.close()
            raise
        self._second = self.node
        """Has the topics of which another node has the name: a participant has one type for a name."""
        if any(row.is_second for row in self.profile.inputs):
            self._peers = PeerContext([], simulator.context.get_domain_id())
            self._second = self._peers.node(f"_{profile.name}")
        without_effect = {name: missing(name) for name in parameters.overrides(self.node)} if self._has_node else {}
        for sentence in (
            *self._usable.left_out,
            *(f"parameter {name} has no effect: {reason}" for name, reason in without_effect.items() if reason),
        ):
            self.node.get_logger().warning(sentence)
        self._world: RunningWorld
        self._robots: list[_RobotEndpoints] = []
        self._services: list[Any] = []

    @property
    def nodes(self) -> tuple[Node, ...]:
        """The nodes that it has besides the simulator's."""
        own = (self.node,) if self._has_node else ()
        return own if self._second is self.node else (*own, self._second)

    def actions(self) -> Mapping[str, str]:
        """Return the types of the actions of all robots, by their full names."""
        rows = self.profile.actions
        return {full_name(self.node, one.robot.names.topic(row.name)): row.type for one in self._robots for row in rows}

    def attach(self, runner: WorldRunner, messages: MessageReports) -> None:
        """Serve the world of a runner, before it starts."""
        self._world = RunningWorld(self.node, runner, messages)
        runner.on_tick.append(self._step)
        runner.on_start.append(self._act)
        self._services = [self._serve(row, row.name, self._world) for row in self.profile.services if row.is_of_world]
        self.node.add_post_set_parameters_callback(self._act_on)

    def open(self, robot: str, names: RobotNames) -> _RobotEndpoints:
        """Create the services and actions of a robot, and return them with its topics."""
        running, profile, types = self._world.add(robot, names), self.profile, self._usable.types
        rows: dict[str, list[Row]] = {}
        for topic in profile.topics:
            rows.setdefault(topic.sensor, []).append(_row(topic, types[topic.type], running))
        inputs = [
            (self._second if row.is_second else self.node, _input(row, types[row.type], running))
            for row in profile.inputs
        ]
        services = [self._serve(row, names.topic(row.name), running) for row in profile.services if not row.is_of_world]
        goals = RobotGoals(self.node, running, profile.actions, types) if profile.actions else None
        made = _RobotEndpoints(self, self.node, rows, inputs, running, services, goals)
        self._robots.append(made)
        made.begin()
        return made

    def forget(self, endpoints: _RobotEndpoints) -> None:
        """Forget the endpoints of a robot that has gone."""
        self._robots.remove(endpoints)
        self._world.forget(endpoints.robot.name)

    def close(self) -> None:
        """Destroy the node."""
        if self._peers is not None:
            self._peers.close()
        if self._has_node:
            self.node.destroy_node()

    # --- callbacks ---

    def _serve(self, row: ServiceRow, name: str, of: RunningRobot | RunningWorld) -> Any:
        handle = partial(self._answer, row, name, of)
        return self.node.create_service(self._usable.types[row.type], name, at_current_tick(self._world.runner, handle))

    def _answer(self, row: ServiceRow, name: str, of: RunningRobot | RunningWorld, request: Any, response: Any) -> Any:
        try:
            row.answer(request, response, of)
        except ValueError as error:
            self._world.report(full_name(self.node, name), error)
        return response

    def _step(self) -> None:
        if self.profile.each_tick is not None:
            self.profile.each_tick(self._world)
        for endpoints in self._robots:
            if endpoints.goals is not None:
                endpoints.goals.step()

    def _act_on(self, changed: list[Parameter]) -> None:
        names = {row.name for row in self.profile.node_parameters}
        if any(parameter.name in names for parameter in changed):
            self._world.runner.catch_up()
            self._act()

    def _act(self) -> None:
        if self._world.runner.is_replaying:
            return
        rows = self.profile.node_parameters
        values = {row.name: self.node.get_parameter(row.name).value for row in rows}
        for act in dict.fromkeys(row.act for row in rows):
            act(self._world, values)


def _row(row: TopicRow, kind: Any, robot: RunningRobot) -> Row:
    def encode(reading: Any, _names: RobotNames, _options: ConvertOptions) -> Any:
        return row.encode(kind, reading, robot)

    return Row(
        row.topic,
        kind,
        encode,
        row.about,
        profile=qos.KINDS[row.kind][0],
        every_ns=row.every_ns,
        on_change=row.on_change,
        is_event=row.is_event,
    )


def _input(row: InputRow, kind: Any, robot: RunningRobot) -> RobotInput:
    def commands(message: Any, context: InputContext) -> Sequence[Command]:
        try:
            return row.commands(message, context, robot)
        except CommandError:
            raise
        except ValueError as error:
            raise CommandError(str(error)) from error

    profile = qos.KINDS[row.kind][0]
    if row.is_best_effort:
        profile = qos.best_effort(profile)
    return RobotInput(row.topic, kind, commands, row.about, profile, row.limit_check)


def _declare(node: Node, rows: Sequence[ParameterRow]) -> None:
    """Declare parameters. Raises StartError for a start value of another type, or out of range."""
    made = [
        (row.name, type(row.default), parameters.param(row.default, row.about, low=row.low, high=row.high))
        for row in rows
    ]
    parameters.declare(node, make_dataclass("ProfileParams", made, frozen=True)())
