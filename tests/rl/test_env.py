"""The environment of one robot: Gymnasium's own checker, spaces, rewards, ends, and the same bits for a seed."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

gymnasium = pytest.importorskip("gymnasium", reason="needs gymnasium (pip install gymnasium)")
from gymnasium.utils.env_checker import check_env

from thymio_sim_ros.rl import TASKS, Rewards, Task, TaskError, ThymioEnv

FORWARD = np.array([1.0, 1.0], np.float32)
FULL_STEP_M = 0.0166
"""Way of a step of 0.1 s at full speed."""


def playground(*shapes: dict[str, object], x_m: float = 0.0, size_m: float = 2.0) -> str:
    floor = {"kind": "rectangle", "name": "floor", "size_x_m": size_m, "size_y_m": 1.0, "color": "#ffffff"}
    robots = [{"name": "thymio", "x_m": x_m, "y_m": 0.0}]
    content = {"format": 1, "title": "t", "description": "d", "shapes": [floor, *shapes], "robots": robots}
    return json.dumps(content)


WALL = {"kind": "box", "name": "wall", "x_m": 0.2, "y_m": 0.0, "size_x_m": 0.1, "size_y_m": 1.0, "height_m": 0.1,
        "color": "#9fa3bd"}  # fmt: skip
TRACK = {"kind": "track", "name": "line", "points_m": [[-0.5, 0.0], [0.5, 0.0]], "width_m": 0.04, "color": "#000000"}
ALL = ("proximity", "ground", "motor")


def task(text: str, **values: object) -> Task:
    fixed = Task(text, "playground", ALL, Rewards(forward_m=1.0), noise=False)
    return replace(fixed, **values)  # type: ignore[arg-type]


@pytest.mark.parametrize("name", ["thymio/Avoid-v0", "thymio/Line-v0"])
def test_gymnasiums_checker_finds_nothing(name: str) -> None:
    check_env(gymnasium.make(f"thymio_sim_ros.rl:{name}").unwrapped)  # its warnings are errors here


def test_a_wall_is_observed_as_the_robot_measures_it() -> None:
    env = ThymioEnv(task(playground(WALL)))
    observation, info = env.reset(seed=1)
    assert info["pose"].tolist() == [0.0, 0.0, 0.0]
    center = observation[2] * 4505
    assert center == pytest.approx(round(float(center)), abs=1e-3)
    assert 2000 < center < 4505
    assert observation[5:7].tolist() == [0.0, 0.0]  # nothing behind it
    assert observation[7:9] * 1023 == pytest.approx([938, 938], abs=2)  # white floor
    assert observation[9:].tolist() == [0.0, 0.0]
    observation, *_ = env.step(np.array([-1.0, 0.5], np.float32))
    assert observation[9:] == pytest.approx([-1.0, 0.5], abs=0.01)


def test_forward_is_rewarded_by_the_way_and_backward_costs_it() -> None:
    env = ThymioEnv(task(playground()))
    env.reset(seed=1)
    _, reward, terminated, truncated, info = env.step(FORWARD)
    assert reward == pytest.approx(FULL_STEP_M, rel=0.02)
    assert (terminated, truncated) == (False, False)
    assert info["pose"][0] == pytest.approx(reward)
    assert env.step(-FORWARD)[1] == pytest.approx(-FULL_STEP_M, rel=0.02)


def test_an_angle_costs_the_same_in_both_directions_and_across_half_a_turn() -> None:
    env = ThymioEnv(task(playground(), rewards=Rewards(turned_rad=-1.0)))
    env.reset(seed=1)
    costs = [env.step(np.array([-1.0, 1.0], np.float32))[1] for _ in range(20)]  # more than half a turn
    costs.append(env.step(np.array([1.0, -1.0], np.float32))[1])
    assert costs == pytest.approx([-2 * FULL_STEP_M / 0.094] * 21, rel=0.02)


def test_a_contact_is_punished_and_ends_the_episode_where_the_task_says_so() -> None:
    def drive(*, ends: bool) -> list[tuple[float, bool]]:
        env = ThymioEnv(task(playground(WALL), rewards=Rewards(contact=-1.0), ends_at_contact=ends))
        env.reset(seed=1)
        return [env.step(FORWARD)[1:3] for _ in range(12)]

    assert drive(ends=True)[0] == (0.0, False)
    first = next(number for number, (reward, _) in enumerate(drive(ends=True)) if reward)
    assert drive(ends=True)[first] == (-1.0, True)
    assert drive(ends=False)[first:] == [(-1.0, False)] * (12 - first)  # it goes on touching the wall


def test_a_line_is_rewarded_while_it_is_below_a_sensor_and_its_loss_ends_the_episode() -> None:
    env = ThymioEnv(task(playground(TRACK), rewards=Rewards(line_m=1.0), line_lost_s=0.3))
    env.reset(seed=1)
    rewards = [env.step(FORWARD)[1] for _ in range(20)]
    assert rewards == pytest.approx([FULL_STEP_M] * 20, rel=0.02)
    ends = [env.step(FORWARD)[1:3] for _ in range(12)]
    lost = next(number for number, (reward, _) in enumerate(ends) if not reward)
    assert [end for _, end in ends[lost : lost + 3]] == [False, False, True]


def test_a_robot_that_falls_off_the_edge_has_ended() -> None:
    env = ThymioEnv(task(playground(x_m=0.9)))
    env.reset(seed=1)
    assert [env.step(FORWARD)[2] for _ in range(10)][-1]


def test_an_episode_is_truncated_after_its_time() -> None:
    env = ThymioEnv(task(playground(), seconds=0.5))
    for _ in range(2):
        env.reset()
        assert [env.step(FORWARD)[3] for _ in range(5)] == [False] * 4 + [True]


def test_a_seed_gives_the_same_bits_over_episodes_and_another_one_others() -> None:
    def run(seed: int) -> bytes:
        env = gymnasium.make("thymio_sim_ros.rl:thymio/Avoid-v0").unwrapped
        env.action_space.seed(3)
        results = [env.reset(seed=seed)[0].tobytes()]
        for _ in range(2):
            for _ in range(10):
                observation, reward, _, _, info = env.step(env.action_space.sample())
                results += [observation.tobytes(), np.float64(reward).tobytes(), info["pose"].tobytes()]
            results.append(env.reset()[0].tobytes())
        return b"".join(results)

    assert run(1) == run(1)
    assert run(1) != run(2)


@pytest.mark.parametrize("action", [[0.0], [0.0, np.nan], [[0.0, 0.0]]])
def test_an_invalid_action_is_rejected(action: list[float]) -> None:
    env = ThymioEnv(task(playground()))
    env.reset(seed=1)
    with pytest.raises(ValueError, match=r"actions: found .*, expected finite numbers of shape \(1, 2\)"):
        env.step(np.array(action, np.float32))


def test_actions_are_limited_to_the_full_speed() -> None:
    env = ThymioEnv(task(playground()))
    env.reset(seed=1)
    assert env.step(3 * FORWARD)[1] == pytest.approx(FULL_STEP_M, rel=0.02)


def test_a_step_before_the_first_reset_is_an_error() -> None:
    with pytest.raises(RuntimeError, match="call reset"):
        ThymioEnv("line").step(FORWARD)


def test_an_unknown_task_names_the_known_ones() -> None:
    with pytest.raises(TaskError, match="found 'avoyd', expected a Task or one of avoid, line"):
        ThymioEnv("avoyd")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"start": "there"}, "start: found 'there'"),
        ({"observed": ()}, r"observed: found \(\)"),
        ({"observed": ("sonar",)}, "expected some of proximity, ground, motor"),
        ({"step_s": 0.015}, "step_s: found 0.015, expected a multiple of 0.01 s"),
        ({"seconds": 0.05}, "seconds: found 0.05"),
        ({"line_lost_s": 0.0}, "line_lost_s: found 0.0"),
        ({"motor_model": "steam"}, "expected one of ideal, firmware"),
        ({"proximity_model": "radar"}, "expected one of default, enki, cone"),
        ({"rewards": Rewards(contact=float("nan"))}, "rewards.contact: found nan"),
    ],
)
def test_a_task_with_an_impossible_value_is_rejected(change: dict[str, object], message: str) -> None:
    with pytest.raises(TaskError, match=message):
        replace(TASKS["avoid"], **change)  # type: ignore[arg-type]
