"""turtle_teleop_key: keys as a terminal sends them, and what they do to a turtle."""

from __future__ import annotations

import itertools
import math

import pytest

from tests import ros_graph

pytestmark = ros_graph.needs_package("turtlesim")

turtle_teleop_key = ros_graph.module("thymio_sim_ros.turtlesim.turtle_teleop_key")

UNIT_M = 0.04


@pytest.fixture
def sim(simulation):
    return simulation(like="turtlesim")


@pytest.fixture
def teleop(ros, sim):
    node = ros.add(turtle_teleop_key.Teleop(ros.context))
    ros.until(lambda: node.count_subscribers("/turtle1/cmd_vel") and node._turn.server_is_ready())
    return node


@pytest.mark.parametrize(
    ("sent", "keys"),
    [
        (["g"], ["g"]),
        (["\x1b[A", "\x1b[B\x1bOC", "\x1b[D"], ["up", "down", "right", "left"]),
        (["\x1b", "[", "Aq"], ["up", "q"]),
        (["\x1b[Z", "f"], ["", "f"]),
    ],
)
def test_keys_are_read_whole_however_they_arrive(sent, keys):
    texts = iter(sent)
    read = turtle_teleop_key.keys_of(lambda: next(texts, ""))
    found = list(itertools.islice((key for key in read), 12))
    assert [key for key in found if key] == [key for key in keys if key]


def test_arrows_drive_two_units_and_turn_two_radians(sim, teleop):
    robot = sim.world.robots["turtle1"]
    start = robot.pose
    assert teleop.press("up")
    sim.step(1.5)
    assert (robot.pose.x_m - start.x_m) / UNIT_M == pytest.approx(2.0, abs=0.1)
    assert teleop.press("left")
    sim.step(1.5)
    assert robot.pose.yaw_rad == pytest.approx(2.0, abs=0.1)


@pytest.mark.parametrize(("key", "degrees"), [("G", 0), ("t", 45), ("r", 90), ("e", 135), ("c", -135), ("v", -90)])
def test_letters_turn_to_a_heading(sim, teleop, key, degrees):
    assert teleop.press("b")
    sim.step(2.0)
    robot = sim.world.robots["turtle1"]
    assert math.degrees(robot.pose.yaw_rad) == pytest.approx(-45, abs=2)
    assert teleop.press(key)
    sim.until(lambda: abs(math.degrees(robot.pose.yaw_rad) - degrees) < 2, 10.0)


def test_f_ends_the_turn_and_q_the_program(sim, teleop):
    assert teleop.press("e")
    sim.step(0.5)
    assert teleop.press("f")
    sim.step(0.2)
    yaw = sim.world.robots["turtle1"].pose.yaw_rad
    assert 0.2 < yaw < 1.5
    sim.step(0.5)
    assert sim.world.robots["turtle1"].pose.yaw_rad == pytest.approx(yaw, abs=0.02)
    assert not teleop.press("q")


def test_without_a_terminal_it_says_so(capsys, monkeypatch):
    monkeypatch.setattr("sys.stdin.isatty", lambda: False)
    assert turtle_teleop_key.main() == 2
    assert capsys.readouterr().err == "turtle_teleop_key: found no terminal, expected one with a keyboard\n"
