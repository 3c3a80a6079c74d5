"""Several robots in one playground: PettingZoo's own checkers, and ends of single robots."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("pettingzoo", reason="needs pettingzoo (pip install pettingzoo)")
from pettingzoo.test import parallel_api_test, parallel_seed_test

from thymio_sim_ros.rl import TASKS
from thymio_sim_ros.rl.parallel_env import ThymioParallelEnv, parallel_env

SHORT = replace(TASKS["avoid"], seconds=1.0)
FORWARD = np.ones(2, np.float32)


def test_pettingzoos_checkers_find_nothing() -> None:
    parallel_api_test(parallel_env(task=SHORT, robots=3), num_cycles=30)  # its warnings are errors here
    parallel_seed_test(lambda: parallel_env(task=SHORT), num_cycles=8)


def test_robots_see_each_other() -> None:
    task = replace(SHORT, playground="two_robots", start="playground", noise=False)
    env = ThymioParallelEnv(task, robots=2)  # they face each other at half a meter
    first, _ = env.reset(seed=1)
    for _ in range(9):
        observations, *_ = env.step(dict.fromkeys(env.agents, FORWARD))
    for agent in env.possible_agents:
        assert not first[agent].any()
        assert observations[agent][2] > 0.3


def test_a_robot_that_has_ended_rests_while_the_others_go_on() -> None:
    env = ThymioParallelEnv(replace(TASKS["avoid"], playground="base", seconds=1000), robots=3)
    _, infos = env.reset(seed=1)
    while len(env.agents) == 3:
        _, _, terminated, _, infos = env.step(dict.fromkeys(env.agents, FORWARD))
    assert [agent for agent, ended in terminated.items() if not ended] == env.agents
    before = {agent: infos[agent]["pose"] for agent in env.agents}
    observations, _, _, _, infos = env.step(dict.fromkeys(env.agents, FORWARD))
    assert observations.keys() == before.keys() == infos.keys()
    assert all((infos[agent]["pose"] != before[agent]).any() for agent in before)


def test_a_missing_action_is_an_error() -> None:
    env = ThymioParallelEnv(SHORT)
    env.reset(seed=1)
    with pytest.raises(KeyError, match="robot_1"):
        env.step({"robot_0": FORWARD})
