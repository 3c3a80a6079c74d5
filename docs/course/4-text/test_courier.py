"""Lesson 4: a courier that measures its floor and then follows the line, on light and dark floors."""

import pytest

from thymio_sim_ros.testing import emitted, followed_line, no_contact, reached

pytestmark = pytest.mark.thymio(playground="dusk.json", program="courier.aesl")

FLOORS = {"dusk.json": (540, 890), "night.json": (90, 315)}
"""What the ground sensors read on the line and beside it, about."""


def press_and_measure(thymio):
    """Start the robot by its button; return the arguments of the event with which it reports what it has measured."""
    thymio.touch("center")
    thymio.until(emitted(thymio, "measured"), seconds=15)
    return next(event.args for event in thymio.events if event.name == "measured")


def test_it_waits_for_its_button(thymio):
    thymio.run(2)
    assert thymio.speed == 0
    assert reached(thymio, (-0.1, -0.3, 0.0), tolerance=0.001)


@pytest.mark.points(2)
def test_it_reports_what_it_has_measured(thymio):
    press_and_measure(thymio)
    assert reached(thymio, (-0.1, -0.3), tolerance=0.05)


@pytest.mark.points(2)
@pytest.mark.parametrize("playground", FLOORS)
def test_it_knows_the_line_and_the_floor(thymio, playground):
    black, white = press_and_measure(thymio)
    assert (black, white) == pytest.approx(FLOORS[playground], abs=40)


@pytest.mark.points(4)
@pytest.mark.parametrize("playground", FLOORS)
def test_it_follows_the_line_for_a_lap(thymio, playground):
    thymio.touch("center")
    thymio.run(15)  # to measure, and to find the line
    lap = followed_line(thymio, since=thymio.path[-1].at_s)
    thymio.until(lap | ~no_contact(thymio), seconds=90)
    assert lap


def test_the_button_stops_it_again(thymio):
    thymio.touch("center")
    thymio.run(1)
    assert (thymio["motor.left.target"], thymio["motor.right.target"]) != (0, 0)
    thymio.touch("center")
    thymio.run(1)
    assert (thymio["motor.left.target"], thymio["motor.right.target"]) == (0, 0)
