"""Knocks as they are read."""

from __future__ import annotations

import pytest

from tests.sim.builders import FLOOR, make, post_wall, readings, run, send
from tests.sim.fake_view import FakeView
from thymio_sim_ros.sim.commands import MotorTargets, MoveRobot, Tap
from thymio_sim_ros.sim.physics import Contact
from thymio_sim_ros.sim.sensors import tap
from thymio_sim_ros.sim.stimuli.handling import HandlingState
from thymio_sim_ros.sim.world import World


@pytest.mark.parametrize(
    ("speed_m_s", "is_new", "taps"), [(0.021, True, 1), (0.02, True, 0), (0.1, False, 0), (0.0, True, 0)]
)
def test_a_contact_that_begins_faster_than_two_centimetres_per_second_is_a_tap(
    speed_m_s: float, is_new: bool, taps: int
) -> None:
    view = FakeView(states=(HandlingState(),), contacts=(Contact("thymio", "wall", 0.08, 0.0, speed_m_s, is_new),))
    reading = tap.SENSOR.measure(view)
    assert (0 if reading is None else reading.words[0]) == taps


def test_the_operator_s_knocks_are_read_in_the_next_tick() -> None:
    world = World(make([FLOOR]), noise=False)
    run(world, 0.05)
    send(world, Tap())
    assert [reading.words for reading in readings(run(world, 0.01), "tap")] == [(1,)]
    assert readings(run(world, 1.03), "tap") == []  # it does not measure in the next tick by itself
    send(world, Tap())
    send(world, Tap())
    assert len(readings(run(world, 0.01), "tap")) == 1
    assert readings(run(world, 1.0), "tap") == []


def test_driving_into_a_wall_is_one_tap() -> None:
    world = World(make([FLOOR, post_wall(0.05)]), noise=False)
    send(world, MotorTargets(300, 300))
    assert len(readings(run(world, 3.0), "tap")) == 1


def test_creeping_to_a_wall_is_none() -> None:
    world = World(make([FLOOR, post_wall(0.01)]), noise=False)
    send(world, MotorTargets(50, 50))
    steps = run(world, 3.0)
    assert readings(steps, "tap") == []
    assert any(step.contacts for step in steps)


def test_a_knock_on_a_robot_that_leans_on_a_wall_is_read() -> None:
    world = World(make([FLOOR, post_wall(0.01)]), noise=False)
    send(world, MotorTargets(50, 50))
    assert run(world, 3.0)[-1].contacts
    for _ in range(8):  # in one of these ticks it measures anyway
        send(world, Tap())
        assert len(readings(run(world, 0.01), "tap")) == 1


def test_a_landing_is_one_tap() -> None:
    world = World(make([{**FLOOR, "size_x_m": 0.5, "size_y_m": 0.5}]), noise=False)
    send(world, MotorTargets(500, 500))
    assert len(readings(run(world, 4.0), "tap")) == 1


def test_a_robot_that_is_caught_in_the_air_feels_no_landing() -> None:
    world = World(make([{**FLOOR, "size_x_m": 0.5, "size_y_m": 0.5}]), noise=False)
    send(world, MotorTargets(500, 500))
    while not world.robots["thymio"].is_falling:
        world.step()
    run(world, 0.1)
    send(world, MotorTargets(0, 0))
    send(world, MoveRobot(0.0, 0.0, 0.0))
    steps = run(world, 0.5)
    assert readings(steps, "tap") == []
    assert {reading.words for reading in readings(steps, "accelerometer")} == {(0, 0, 23)}
