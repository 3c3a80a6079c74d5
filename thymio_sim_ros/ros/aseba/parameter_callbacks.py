"""Checks and applies changes of the runtime's parameters while it runs."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

from rcl_interfaces.msg import SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter

from thymio_sim_ros.device.programs.program_assignment import Assignment, RobotId
from thymio_sim_ros.files.loading import check_behaviour
from thymio_sim_ros.ros.aseba import parameters as aseba_params
from thymio_sim_ros.ros.aseba import script_parameters
from thymio_sim_ros.ros.aseba.parameters import WrongValueError
from thymio_sim_ros.ros.aseba.robot_set import PROGRAM_ERRORS, ParameterChange, RobotSet
from thymio_sim_ros.ros.aseba.runtime_values import RuntimeValues
from thymio_sim_ros.ros.aseba.variable_timer import VariableTimer
from thymio_sim_ros.ros.rclpy_ext import parameters as params

__all__ = ["ParameterCallbacks"]


class ParameterCallbacks:
    """The parameter callbacks of the node.

    Programs are compiled while they are checked. A rejected set of parameters changes nothing, an accepted one is
    applied as a whole.
    """

    def __init__(self, node: Node, values: RuntimeValues, robots: RobotSet, variable_timer: VariableTimer) -> None:
        self._node, self._values, self._robots, self._variable_timer = node, values, robots, variable_timer
        self._accepted: ParameterChange | None = None
        """The parameters that were checked last, until they are applied."""
        self.has_started = False
        """Whether the last change started a program, also one of the same name."""
        self.started_again: frozenset[str] = frozenset()
        """The robots that the present change starts, even if it changes no value."""
        node.add_pre_set_parameters_callback(lambda given: aseba_params.exclusive(given, values.last_set_text))
        node.add_on_set_parameters_callback(self._check)
        node.add_post_set_parameters_callback(self._apply)

    def load(self, values: Mapping[str, Any], robots: Collection[str]) -> SetParametersResult:
        """Set parameters that choose the programs of these robots, and start them, all or none."""
        self.started_again = frozenset(robots)
        parameters = [Parameter(name, value=value) for name, value in values.items()]
        try:
            return self._node.set_parameters_atomically(parameters)
        finally:
            self.started_again = frozenset()

    def _check(self, parameters: list[Parameter]) -> SetParametersResult:
        if self._values.is_declaring:
            return SetParametersResult(successful=True)
        self.has_started = False
        changes = params.changes(parameters)
        named = script_parameters.named(changes, self._values.last_set_text)
        values = self._values.by_name | named
        try:
            for name, value in changes.items():
                aseba_params.check_value(name, value)
            if reason := params.refusal(self._values.params, parameters):
                raise WrongValueError(reason)
            check_behaviour(changes.get("behaviour", ""), self._values.params.layout)
            shares = self._checked_shares(values, named)
        except (WrongValueError, *PROGRAM_ERRORS) as error:
            self._accepted = None
            return SetParametersResult(successful=False, reason=str(error))
        self._accepted = ParameterChange(values, named, shares, self.started_again)
        return SetParametersResult(successful=True)

    def _checked_shares(self, values: dict[str, Any], changes: dict[str, Any]) -> dict[str, Assignment | None]:
        """Return the program of each robot if a script changes; programs of absent robots must compile too."""
        if not any(".script." in f".{name}" for name in changes):
            return {}
        layout = self._values.params.layout
        absent = set(script_parameters.named_robots(changes)) - set(self._robots.names)
        for name in sorted(absent):
            script_parameters.shares(values, [RobotId(name, self._values.params.first_id)], layout)
        return script_parameters.shares(values, self._robots.members, layout)

    def _apply(self, parameters: list[Parameter]) -> None:
        accepted, self._accepted = self._accepted, None
        if accepted is None:
            return
        old, self._values.by_name = self._values.by_name, accepted.values
        self._values.params = params.updated(self._values.params, parameters)
        self._robots.emitter.reaches_all = self._values.params.emit_reaches == "network"
        if "watch_rate" in accepted.changes:
            self._variable_timer.set_rate(self._values.params.watch_rate)
        self.has_started = self._robots.apply(old, accepted)
