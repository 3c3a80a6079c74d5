"""Many independent episodes at once for Gymnasium: one world with a robot in each of many copies of the playground."""

from __future__ import annotations

from typing import Any

import gymnasium.vector
import numpy as np
import numpy.typing as npt
from gymnasium.vector.utils import batch_space

from thymio_sim_ros.rl.env import Array, action_space
from thymio_sim_ros.rl.observations import observation_space
from thymio_sim_ros.rl.simulation import Outcome, Simulation
from thymio_sim_ros.rl.tasks import Task, task_of

__all__ = ["ThymioVectorEnv"]


class ThymioVectorEnv(gymnasium.vector.VectorEnv[Array, Array, npt.NDArray[Any]]):
    """Robots with the same task, each in its own episode.

    A robot whose episode has ended begins another in the next step, whatever its action (`AutoresetMode.NEXT_STEP`).
    After `reset(seed=…)` the same actions give the same bits; an episode is not the one that `ThymioEnv` has with this
    seed. `infos["pose"]` has the true poses in the frame of the playground, shape (num_envs, 3).
    """

    metadata: dict[str, Any] = {  # noqa: RUF012  # Gymnasium's declaration
        "render_modes": [],
        "autoreset_mode": gymnasium.vector.AutoresetMode.NEXT_STEP,
    }

    def __init__(self, num_envs: int, task: str | Task = "avoid") -> None:
        """`task`: as for `ThymioEnv`. Raises TaskError if it is not possible, or not in copies of its playground."""
        self._simulation = Simulation(task_of(task), copies=num_envs)
        self.num_envs = num_envs
        self.single_observation_space = observation_space(self._simulation.task.observed)
        self.single_action_space = action_space()
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._ended: list[int] = []
        """Numbers of the robots whose episode ended in the last step."""

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Array, dict[str, Any]]:
        """Begin all episodes, in a new world; there are no options."""
        super().reset(seed=seed)
        self._ended = []
        outcome = self._simulation.begin(self.np_random)
        return outcome.observations, self._infos(outcome)

    def step(
        self, actions: Array
    ) -> tuple[Array, npt.NDArray[Any], npt.NDArray[Any], npt.NDArray[Any], dict[str, Any]]:
        """Act for one step. Raises RuntimeError before the first `reset`, ValueError for invalid actions."""
        outcome = self._simulation.act(actions, restarted=self._ended, random=self.np_random)
        self._ended = np.flatnonzero(outcome.terminated | outcome.truncated).tolist()
        return (
            outcome.observations,
            outcome.rewards,
            outcome.terminated,
            outcome.truncated,
            self._infos(outcome),
        )

    def _infos(self, outcome: Outcome) -> dict[str, Any]:
        return {"pose": outcome.poses, "_pose": np.ones(self.num_envs, np.bool_)}
