"""The environment of one robot for Gymnasium."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
import numpy.typing as npt
from gymnasium import spaces

from thymio_sim_ros.rl.observations import observation_space
from thymio_sim_ros.rl.simulation import Outcome, Simulation
from thymio_sim_ros.rl.tasks import Task, task_of

__all__ = ["Array", "ThymioEnv", "action_space"]

Array = npt.NDArray[np.float32]


def action_space() -> spaces.Box:
    """The space of actions: targets of the left and right wheel as parts of 500, -1…1."""
    return spaces.Box(-1.0, 1.0, (2,), np.float32)


class ThymioEnv(gymnasium.Env[Any, Any]):
    """One robot with a task. `info["pose"]` is its true pose: x, y in m and heading in rad.

    After `reset(seed=…)` the same actions give the same bits, over any number of episodes.
    """

    metadata: dict[str, Any] = {"render_modes": []}  # noqa: RUF012  # Gymnasium's declaration

    def __init__(self, task: str | Task = "avoid") -> None:
        """`task`: a name in `tasks.TASKS`, or a task of your own. Raises TaskError if it is not possible."""
        self._simulation = Simulation(task_of(task))
        self.observation_space = observation_space(self._simulation.task.observed)
        self.action_space = action_space()

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Array, dict[str, Any]]:
        """Begin an episode; there are no options."""
        super().reset(seed=seed)
        outcome = self._simulation.begin(self.np_random)
        return outcome.observations[0], _info(outcome)

    def step(self, action: Array) -> tuple[Array, float, bool, bool, dict[str, Any]]:
        """Act for one step. Raises RuntimeError before the first `reset`, ValueError for an invalid action."""
        outcome = self._simulation.act(np.asarray(action)[np.newaxis], random=self.np_random)
        terminated, truncated = bool(outcome.terminated[0]), bool(outcome.truncated[0])
        return outcome.observations[0], float(outcome.rewards[0]), terminated, truncated, _info(outcome)


def _info(outcome: Outcome) -> dict[str, Any]:
    return {"pose": outcome.poses[0]}
