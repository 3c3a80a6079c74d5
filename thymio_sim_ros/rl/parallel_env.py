"""Several robots in one playground for PettingZoo."""

from __future__ import annotations

from typing import Any

import numpy as np
from gymnasium import spaces
from gymnasium.utils import seeding
from pettingzoo import ParallelEnv

from thymio_sim_ros.rl.env import Array, action_space
from thymio_sim_ros.rl.observations import observation_space
from thymio_sim_ros.rl.simulation import Outcome, Simulation
from thymio_sim_ros.rl.tasks import Task, task_of

__all__ = ["ThymioParallelEnv", "parallel_env"]


class ThymioParallelEnv(ParallelEnv):  # type: ignore[misc]  # PettingZoo has no types
    """Robots with the same task that meet and see each other; agents are `robot_0`, `robot_1`, …

    A robot whose episode has ended stays where it is, at rest. After `reset(seed=…)` the same actions give the same
    bits. `infos[agent]["pose"]` is the true pose: x, y in m and heading in rad.
    """

    metadata: dict[str, Any] = {  # noqa: RUF012  # PettingZoo's declaration
        "name": "thymio_v0",
        "render_modes": [],
        "is_parallelizable": True,
    }

    def __init__(self, task: str | Task = "avoid", *, robots: int = 2) -> None:
        """`task`: as for `ThymioEnv`; `robots`: their number. Raises TaskError if it is not possible."""
        self.render_mode = None
        self._simulation = Simulation(task_of(task), robots=robots)
        self.possible_agents = list(self._simulation.names)
        self.agents: list[str] = []
        self._observation_spaces = {
            agent: observation_space(self._simulation.task.observed) for agent in self.possible_agents
        }
        self._action_spaces = {agent: action_space() for agent in self.possible_agents}
        self._random, _ = seeding.np_random()

    def observation_space(self, agent: str) -> spaces.Box:
        """The space of the observations of an agent."""
        return self._observation_spaces[agent]

    def action_space(self, agent: str) -> spaces.Box:
        """The space of the actions of an agent."""
        return self._action_spaces[agent]

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Array], dict[str, dict[str, Any]]]:
        """Begin an episode of all robots; there are no options."""
        if seed is not None:
            self._random, _ = seeding.np_random(seed)
        self.agents = list(self.possible_agents)
        outcome = self._simulation.begin(self._random)
        return self._by_agent(outcome.observations), self._infos(outcome)

    def step(
        self, actions: dict[str, Array]
    ) -> tuple[dict[str, Array], dict[str, float], dict[str, bool], dict[str, bool], dict[str, dict[str, Any]]]:
        """Act for one step, with an action of each agent. Raises KeyError if one is missing, and as `ThymioEnv`."""
        targets = np.zeros((len(self.possible_agents), 2))
        for number, agent in enumerate(self.possible_agents):
            if agent in self.agents:
                targets[number] = actions[agent]
        outcome = self._simulation.act(targets, random=self._random)
        terminated = self._by_agent(outcome.terminated.tolist())
        truncated = self._by_agent(outcome.truncated.tolist())
        result = (
            self._by_agent(outcome.observations),
            self._by_agent(outcome.rewards.tolist()),
            terminated,
            truncated,
            self._infos(outcome),
        )
        self.agents = [agent for agent in self.agents if not (terminated[agent] or truncated[agent])]
        return result

    def _infos(self, outcome: Outcome) -> dict[str, dict[str, Any]]:
        return {agent: {"pose": pose} for agent, pose in self._by_agent(outcome.poses).items()}

    def _by_agent(self, values: Any) -> dict[str, Any]:
        """The values of the agents that take part, of values in the order of all agents."""
        return {agent: value for agent, value in zip(self.possible_agents, values, strict=True) if agent in self.agents}


def parallel_env(**options: Any) -> ThymioParallelEnv:
    """A `ThymioParallelEnv`, under the name by which PettingZoo's tools create environments."""
    return ThymioParallelEnv(**options)
