"""The action `~/simulate_steps` of simulation_interfaces: ticks one by one, each told, until done or cancelled."""

from __future__ import annotations

from collections.abc import Generator
from typing import Any

from rclpy.action.server import ActionServer, CancelResponse
from rclpy.node import Node

from thymio_sim_ros.ros.simulator.simulation_interfaces.answers import FAILED, OK
from thymio_sim_ros.ros.simulator.world_services import WORLD_STOPPED, SimulatorControl

__all__ = ["StepsAction"]


class StepsAction:
    """The action on the simulator's node; `kind` is `simulation_interfaces.action.SimulateSteps`."""

    def __init__(self, node: Node, simulator: SimulatorControl, kind: Any) -> None:
        self._simulator, self._kind = simulator, kind
        self._server = ActionServer(
            node, kind, "~/simulate_steps", self._execute, cancel_callback=lambda _goal: CancelResponse.ACCEPT
        )

    def close(self) -> None:
        """Take it out of the graph."""
        self._server.destroy()

    async def _execute(self, goal: Any) -> Any:
        steps, result = goal.request.steps, self._kind.Result()
        for done in range(steps):
            if goal.is_cancel_requested:
                goal.canceled()
                return self._told(result, f"cancelled after {done} of {steps} steps")
            if not self._simulator.paused:
                goal.abort()
                return self._told(result, f"the world is running after {done} of {steps} steps: pause it first")
            if not self._simulator.step(1):
                goal.abort()
                return self._told(result, f"{WORLD_STOPPED}, after {done} of {steps} steps")
            goal.publish_feedback(self._kind.Feedback(completed_steps=done + 1, remaining_steps=steps - done - 1))
            await _YieldToExecutor()
        goal.succeed()
        result.result.result = OK
        return result

    def _told(self, result: Any, reason: str) -> Any:
        result.result.result, result.result.error_message = FAILED, reason
        return result


class _YieldToExecutor:
    """Whoever awaits it lets the executor do everything else that is due."""

    def __await__(self) -> Generator[None, None, None]:
        yield
