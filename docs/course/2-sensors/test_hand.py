"""Lesson 2: the robot follows a hand, and does not fall off the table."""

import pytest

from thymio_sim_ros.sim.commands import SetProximity
from thymio_sim_ros.testing import Check

pytestmark = pytest.mark.thymio(playground="island.json", program="hand.aesl")

PLACES = {"front": 2, "left": 0, "right": 4}
NEAR, FAR = 3500, 0
TOWARD_THE_EDGE = {"ahead": (0.3, 0.0, 0.0), "right": (0.3, 0.0, -1.2), "along": (-0.3, 0.32, 0.09)}
"""Poses from which the robot drives to the edge; in the last one it drives almost along it."""


def hold_hand(thymio, place=None):
    """Hold a hand before one of the sensors, or take it away."""
    counts = [FAR] * 7
    if place is not None:
        counts[PLACES[place]] = NEAR
    thymio.post(SetProximity(tuple(counts)))
    thymio.run(0.3)


def turned(thymio, place):
    """How far the robot turns within a second toward a hand, in radians; positive is to the left."""
    thymio.run(0.3)
    hold_hand(thymio, place)
    thymio.run(1)
    return thymio.pose.yaw_rad


def on_the_table(thymio):
    """The robot has not fallen off the table."""

    def judge():
        here = thymio.pose
        return abs(here.x_m) < 0.5 and abs(here.y_m) < 0.35, f"the robot is at ({here.x_m:.2f}, {here.y_m:.2f}) m"

    return Check(judge)


def test_it_waits_for_a_hand(thymio):
    thymio.run(2)
    assert thymio.speed == 0


@pytest.mark.points(2)
def test_it_comes_to_a_hand_in_front(thymio):
    thymio.run(0.3)
    hold_hand(thymio, "front")
    thymio.until(lambda: thymio.pose.x_m > -0.17, seconds=2)


@pytest.mark.points(2)
@pytest.mark.parametrize("place", ["front", "left"])
def test_it_stops_when_the_hand_is_gone(thymio, place):
    thymio.run(0.3)
    hold_hand(thymio, place)
    assert (thymio["motor.left.target"], thymio["motor.right.target"]) != (0, 0)
    hold_hand(thymio)
    assert (thymio["motor.left.target"], thymio["motor.right.target"]) == (0, 0)


def test_it_turns_left_to_a_hand_at_the_left(thymio):
    assert turned(thymio, "left") > 0.3


def test_it_turns_right_to_a_hand_at_the_right(thymio):
    assert turned(thymio, "right") < -0.3


@pytest.mark.points(3)
@pytest.mark.parametrize(
    "start", [(0.3, 0.0, 0.0), (0.3, 0.0, -1.2), (-0.3, 0.32, 0.09)], ids=["ahead", "right", "along"]
)
def test_it_stops_at_the_edge(thymio, start):
    thymio.place(*start)
    thymio.run(0.3)
    hold_hand(thymio, "front")
    thymio.run(1)
    assert thymio.speed > 0
    thymio.run(10)
    assert thymio.speed == 0
    assert on_the_table(thymio)
