"""Lesson 3: a bus that follows its line, starts and stops by a button, and waits for people."""

import pytest

from thymio_sim_ros.sim.commands import SetProximity
from thymio_sim_ros.testing import followed_line, no_contact

pytestmark = pytest.mark.thymio(playground="bus.json", program="bus.aesl")

ROAD_FREE = (0,) * 7
PERSON = (0, 0, 3500, 0, 0, 0, 0)


def fastest(thymio):
    """The highest speed of the last two seconds, m/s."""
    now = thymio.path[-1].at_s
    thymio.run(2)
    return max(moment.speed_m_s for moment in thymio.record.since(now))


def test_it_waits_for_its_button(thymio):
    thymio.run(2)
    assert no_contact(thymio)
    assert (thymio["motor.left.target"], thymio["motor.right.target"]) == (0, 0)


def test_the_center_button_starts_it(thymio):
    thymio.run(1)
    assert thymio.speed == 0
    thymio.touch("center")
    thymio.until(lambda: thymio.pose.x_m > -0.05, seconds=3)


@pytest.mark.points(3)
@pytest.mark.parametrize("seed", range(3))
def test_it_follows_the_line_for_a_lap(thymio, seed):
    thymio.touch("center")
    lap = followed_line(thymio)
    thymio.until(lap | ~no_contact(thymio), seconds=90)
    assert lap


@pytest.mark.points(2)
def test_the_center_button_stops_it_again(thymio):
    thymio.touch("center")
    thymio.run(1)
    assert thymio.speed > 0
    thymio.touch("center")
    thymio.run(1)
    assert (thymio["motor.left.target"], thymio["motor.right.target"]) == (0, 0)


def test_the_forward_button_makes_it_faster(thymio):
    thymio.touch("center")
    before = fastest(thymio)
    assert before > 0.02
    thymio.touch("forward")
    assert fastest(thymio) > before + 0.01


@pytest.mark.points(2)
def test_it_waits_for_people_and_drives_on(thymio):
    thymio.touch("center")
    thymio.run(1)
    thymio.post(SetProximity(PERSON))
    thymio.run(1)
    assert (thymio["motor.left.target"], thymio["motor.right.target"]) == (0, 0)
    thymio.post(SetProximity(ROAD_FREE))
    thymio.until(lambda: thymio.speed > 0.02, seconds=2)
