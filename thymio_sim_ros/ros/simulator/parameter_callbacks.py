"""Checks and applies changes of the simulator's parameters while it runs."""

from __future__ import annotations

import traceback

from rcl_interfaces.msg import SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter

from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.ros.rclpy_ext.parameters import by_name, changes, refusal, updated
from thymio_sim_ros.ros.simulator.parameters import CurrentParams
from thymio_sim_ros.ros.simulator.prepared_playground import LOAD_ERRORS, PreparedPlayground, new_engine
from thymio_sim_ros.ros.simulator.world_runner import WorldRunner

__all__ = ["ParameterCallbacks", "reject_sim_time"]

USE_SIM_TIME = "use_sim_time"
SIM_TIME_REASON = "the simulator is the source of simulated time, it cannot follow /clock"


def reject_sim_time(node: Node) -> None:
    """Reset `use_sim_time`, which launch files often set for all nodes: this node is the source of time."""
    if node.get_parameter(USE_SIM_TIME).value is True:
        node.get_logger().warning(f"{USE_SIM_TIME} is ignored: {SIM_TIME_REASON}")
        node.set_parameters([Parameter(USE_SIM_TIME, value=False)])


class ParameterCallbacks:
    """The parameter callbacks of the node.

    A changed playground becomes an engine while it is checked, so that applying it cannot fail; a rejected value
    changes nothing.
    """

    def __init__(self, node: Node, params: CurrentParams, runner: WorldRunner) -> None:
        self._node, self._params, self._runner = node, params, runner
        self._accepted: tuple[PreparedPlayground, Engine] | None = None
        """The playground that was checked last, if it differs from the current one."""
        self.has_loaded = False
        """Whether the last change created a world, also from a file of the same name."""
        node.add_on_set_parameters_callback(self._check)
        node.add_post_set_parameters_callback(self._apply)

    def load_playground(self, playground: str) -> str:
        """Load a playground (name, path or text) or restart the current one; return the reason if it is rejected."""
        before = self._runner.world
        result = self._node.set_parameters_atomically([Parameter("playground", value=playground)])
        if result.successful and self._runner.world is before:
            self._runner.reset()
        return "" if result.successful else str(result.reason)

    def _has_own(self, parameters: list[Parameter]) -> bool:
        """Whether any is declared in SimulatorParams; QoS overrides are declared while a robot's topics are created."""
        own = by_name(self._params.values).keys()
        return not own.isdisjoint(parameter.name for parameter in parameters)

    def _check(self, parameters: list[Parameter]) -> SetParametersResult:
        changed = changes(parameters)
        if changed.get(USE_SIM_TIME) is True:
            return _rejected(f"{USE_SIM_TIME} is rejected: {SIM_TIME_REASON}")
        if not self._has_own(parameters):
            return SetParametersResult(successful=True)
        self._runner.catch_up()
        self.has_loaded = False
        if reason := refusal(self._params.values, parameters):
            return _rejected(reason)
        playground = changed.get("playground")
        if playground is None:
            return SetParametersResult(successful=True)
        try:
            self._accepted = self._runner.run_beside(lambda: self._new_engine(playground, parameters))
        except LOAD_ERRORS as error:
            return _rejected(str(error))
        except Exception as error:  # internal error while reading a file: the node continues
            self._node.get_logger().error(
                f"internal error (please report): the playground cannot be read:\n{traceback.format_exc()}"
            )
            return _rejected(f"{type(error).__name__}: {error}")
        return SetParametersResult(successful=True)

    def _new_engine(self, value: str, parameters: list[Parameter]) -> tuple[PreparedPlayground, Engine] | None:
        """Return a playground and its engine, or None if it is the current one. Raises one of `LOAD_ERRORS`."""
        present = self._params.values
        prepared = PreparedPlayground.load(value, present)
        if value == present.playground and prepared.playground == self._runner.world.playground:
            return None
        chosen = updated(present, parameters)
        return prepared, new_engine(prepared.playground, chosen, prepared.ground)

    def _apply(self, parameters: list[Parameter]) -> None:
        if not self._has_own(parameters):
            return
        changed = changes(parameters)
        self._params.values = values = updated(self._params.values, parameters)
        if "real_time_factor" in changed:
            self._runner.scheduler.set_factor(values.real_time_factor)
        if "playground" in changed and self._accepted is not None:
            (prepared, engine), self._accepted = self._accepted, None
            self._runner.replace(prepared, engine)
            self.has_loaded = True
        elif "seed" in changed:
            self._runner.replace(self._runner.prepared, new_engine(self._runner.world.playground, values))
            self.has_loaded = True
        self._runner.publish_state()


def _rejected(reason: str) -> SetParametersResult:
    return SetParametersResult(successful=False, reason=reason)
