"""Current and integrator of the motors as they are read."""

from __future__ import annotations

import pytest

from tests.sim.builders import FLOOR, make, post_wall, readings, run, send
from thymio_sim_ros.sim.commands import MotorTargets, SetMotorModel
from thymio_sim_ros.sim.world import World


def test_a_free_wheel_draws_nothing_and_its_integrator_holds_the_pwm() -> None:
    world = World(make([FLOOR]), noise=False)
    send(world, MotorTargets(100, -500))
    found = readings(run(world, 0.5), "current")
    assert [reading.words for reading in found] == [(0, 0, -480, 2400)]


def test_a_wheel_that_is_held_draws_current_until_it_is_let_go() -> None:
    world = World(make([FLOOR, post_wall(0.01)]), noise=False)
    send(world, MotorTargets(500, 500))
    held = readings(run(world, 5.0), "current")[-1].words
    send(world, MotorTargets(0, 0))
    rest = readings(run(world, 10.0), "current")[-1].words
    assert held[:2] == pytest.approx((800, 800), abs=5)
    assert rest == (0, 0, 0, 0)


def test_motors_that_follow_at_once_again_tell_their_integrator_at_once() -> None:
    world = World(make([FLOOR]), noise=False)
    send(world, MotorTargets(100, 100))
    run(world, 0.5)
    send(world, SetMotorModel("firmware"))
    run(world, 0.7)
    send(world, SetMotorModel("ideal"))
    assert readings(run(world, 0.05), "current")[-1].words[2:] == (-480, -480)


def test_the_current_is_filtered_over_64_ticks() -> None:
    world = World(make([FLOOR, post_wall(0.0005)]), noise=False)
    send(world, MotorTargets(500, 500))
    run(world, 0.1)
    before = readings(run(world, 0.01), "current")[-1].words[0]
    after = readings(run(world, 0.64), "current")[-1].words[0]
    assert 800 - after == pytest.approx((800 - before) / 2.74, rel=0.05)  # (1 + 1/63) ** 64


def test_it_is_published_once_a_second_while_nothing_changes() -> None:
    world = World(make([FLOOR]), noise=False)
    send(world, MotorTargets(100, 100))
    assert len(readings(run(world, 5.0), "current")) == 5
