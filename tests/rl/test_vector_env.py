"""Many robots in one world: independent episodes, next-step resets, the same bits for a seed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

gymnasium = pytest.importorskip("gymnasium", reason="needs gymnasium (pip install gymnasium)")

from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.files.loading import load_playground
from thymio_sim_ros.rl import TASKS, TaskError, ThymioVectorEnv
from thymio_sim_ros.rl.tiling import tiled

ROBOTS = 4
SHORT = replace(TASKS["avoid"], playground="base", seconds=0.5)
NO_FLOOR = """{"format": 1, "title": "t", "description": "d", "shapes": [],
    "robots": [{"name": "thymio", "x_m": 0, "y_m": 0}]}"""
FORWARD = np.ones((ROBOTS, 2), np.float32)


def test_make_vec_uses_one_world() -> None:
    envs = gymnasium.make_vec("thymio_sim_ros.rl:thymio/Avoid-v0", num_envs=ROBOTS, task=SHORT)
    assert isinstance(envs, ThymioVectorEnv)
    observations, infos = envs.reset(seed=1)
    assert envs.observation_space.contains(observations)
    assert infos["pose"].shape == (ROBOTS, 3)
    assert (np.abs(infos["pose"][:, :2]) < 0.5).all()  # each in its own square of a meter
    observations, rewards, terminated, truncated, infos = envs.step(envs.action_space.sample())
    assert envs.observation_space.contains(observations)
    assert rewards.shape == terminated.shape == truncated.shape == (ROBOTS,)
    assert infos["_pose"].all()


def test_an_episode_that_ended_begins_again_in_the_next_step_elsewhere_and_at_rest() -> None:
    envs = ThymioVectorEnv(ROBOTS, replace(SHORT, ends_at_contact=False, observed=("motor",)))
    envs.reset(seed=1)
    for _ in range(4):
        assert not envs.step(FORWARD)[3].any()
    *_, truncated, last = envs.step(FORWARD)
    assert truncated.all()
    observations, rewards, terminated, truncated, first = envs.step(FORWARD)
    assert not rewards.any()
    assert not terminated.any()
    assert not truncated.any()
    assert not observations.any()
    ways = np.hypot(*(first["pose"] - last["pose"])[:, :2].T)
    assert (ways > 0.02).all()
    assert [envs.step(FORWARD)[3].all() for _ in range(5)] == [False] * 4 + [True]


def test_one_robot_begins_again_while_the_others_go_on() -> None:
    envs = ThymioVectorEnv(ROBOTS, replace(TASKS["avoid"], playground="base", seconds=1000))
    envs.reset(seed=1)
    for _ in range(400):
        _, rewards, terminated, _, _ = envs.step(FORWARD)
        if terminated.any():
            break
    assert terminated.any()
    assert not terminated.all()
    assert (rewards[terminated] < -0.9).all()
    _, rewards, after, _, _ = envs.step(FORWARD)
    assert not rewards[terminated].any()
    assert not after[terminated].any()
    assert rewards[~terminated].all()


def test_a_seed_gives_the_same_bits_over_resets_and_another_one_others() -> None:
    def run(seed: int) -> bytes:
        envs = ThymioVectorEnv(ROBOTS, SHORT)
        results = [envs.reset(seed=seed)[0].tobytes()]
        for _ in range(15):
            observations, rewards, *_, infos = envs.step(FORWARD)
            results += [observations.tobytes(), rewards.tobytes(), infos["pose"].tobytes()]
        results.append(envs.reset()[1]["pose"].tobytes())
        return b"".join(results)

    assert run(1) == run(1)
    assert run(1) != run(2)


def test_a_copy_measures_what_the_original_does() -> None:
    _, original = load_playground("obstacle")
    copies, offsets = tiled(original, 5)
    start = original.robots[0]
    places = [(start.x_m + x, start.y_m + y) for x, y in offsets]
    robots = [replace(start, name=f"robot_{number}", x_m=x, y_m=y) for number, (x, y) in enumerate(places)]
    alone = Engine(original, noise=False)
    together = Engine(replace(copies, robots=tuple(robots)), noise=False)
    for engine in (alone, together):
        engine.run(0.1)
    for sensor in ("proximity", "ground"):
        expected = alone.world.read(start.name, sensor)
        assert expected is not None
        for robot in robots:
            found = together.world.read(robot.name, sensor)
            assert found is not None
            assert found.words == pytest.approx(expected.words, abs=2), (robot.name, sensor)


@pytest.mark.parametrize(
    ("playground", "found"),
    [("arena", "'box_1', which moves"), ("gate", "moves"), (NO_FLOOR, "no floor")],
)
def test_a_playground_that_cannot_be_copied_is_rejected(playground: str, found: str) -> None:
    task = replace(SHORT, playground=playground, start="playground")
    with pytest.raises(TaskError, match=f"{found}, expected a floor and fixed objects"):
        ThymioVectorEnv(2, task)
    ThymioVectorEnv(1, task)


def test_a_number_below_one_is_rejected() -> None:
    with pytest.raises(TaskError, match="copies: found 0, expected at least 1"):
        ThymioVectorEnv(0)


@pytest.mark.process
def test_processes_take_what_cannot_be_copied() -> None:
    task = replace(SHORT, playground="arena")
    options = {"vectorization_mode": "async", "vector_kwargs": {"context": "spawn"}, "task": task}
    envs = gymnasium.make_vec("thymio_sim_ros.rl:thymio/Avoid-v0", num_envs=2, **options)
    try:
        envs.reset(seed=3)
        _, rewards, *_ = envs.step(np.ones((2, 2), np.float32))
    finally:
        envs.close()
    single = gymnasium.make("thymio_sim_ros.rl:thymio/Avoid-v0", task=task)
    single.reset(seed=4)  # the second environment gets the next seed
    assert rewards[1] == single.step(np.ones(2, np.float32))[1]
