"""The action `~/simulate_steps` of simulation_interfaces: single ticks with feedback, until done or canceled."""

from __future__ import annotations

from collections.abc import Generator
from typing import Any

from rclpy.action.server import ActionServer, CancelResponse
from rclpy.node import Node

from thymio_sim_ros.ros.simulator.simulation_interfaces.answers import FAILED, OK
from thymio_sim_ros.ros.simulator.world_runner import WorldRunner
from thymio_sim_ros.ros.simulator.world_services import WORLD_STOPPED

__all__ = ["StepsAction"]


class StepsAction:
    """The action server; `kind` is `simulation_interfaces.action.SimulateSteps`."""

    def __init__(self, node: Node, runner: WorldRunner, kind: Any) -> None:
        self._runner, self._kind = runner, kind
        self._server = ActionServer(
            node, kind, "~/simulate_steps", self._execute, cancel_callback=lambda _goal: CancelResponse.ACCEPT
        )

    def close(self) -> None:
        """Destroy the action server."""
        self._server.destroy()

    async def _execute(self, goal: Any) -> Any:
        steps, result = goal.request.steps, self._kind.Result()
        for done in range(steps):
            if goal.is_cancel_requested:
                goal.canceled()
                return self._failed(result, f"canceled after {done} of {steps} steps")
            if not self._runner.paused:
                goal.abort()
                return self._failed(result, f"the simulation is running after {done} of {steps} steps: pause it first")
            if not self._runner.step(1):
                goal.abort()
                return self._failed(result, f"{WORLD_STOPPED}, after {done} of {steps} steps")
            goal.publish_feedback(self._kind.Feedback(completed_steps=done + 1, remaining_steps=steps - done - 1))
            await _YieldToExecutor()
        goal.succeed()
        result.result.result = OK
        return result

    def _failed(self, result: Any, reason: str) -> Any:
        result.result.result, result.result.error_message = FAILED, reason
        return result


class _YieldToExecutor:
    """Awaitable that yields to the executor once."""

    def __await__(self) -> Generator[None, None, None]:
        yield
