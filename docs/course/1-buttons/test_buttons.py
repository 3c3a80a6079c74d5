"""Lesson 1: the robot is driven by its buttons and shows what it does."""

import math

import pytest

from thymio_sim_ros.testing import no_contact, shows

pytestmark = pytest.mark.thymio(playground="parking.json", program="buttons.aesl")


def turned(thymio, button):
    """How far the robot turns within a second after a button was touched, in radians; positive is to the left."""
    thymio.place(0.0, -0.2, 0.0)
    thymio.touch(button)
    thymio.run(1)
    return thymio.pose.yaw_rad


def test_it_waits_for_a_button(thymio):
    thymio.run(2)
    assert thymio.speed == 0


def test_forward_drives_forward(thymio):
    thymio.touch("forward")
    thymio.until(lambda: thymio.pose.x_m > -0.28, seconds=2)


def test_forward_is_green(thymio):
    thymio.touch("forward")
    assert shows(thymio, "top", "green")


def test_backward_drives_backward(thymio):
    thymio.touch("backward")
    thymio.until(lambda: thymio.pose.x_m < -0.32, seconds=2)


def test_left_turns_left(thymio):
    assert turned(thymio, "left") > 0.3


def test_right_turns_right(thymio):
    assert turned(thymio, "right") < -0.3


@pytest.mark.points(2)
@pytest.mark.parametrize("button", ["forward", "left"])
def test_center_stops_it(thymio, button):
    thymio.touch(button)
    thymio.run(0.5)
    assert thymio["motor.left.target"] != 0
    thymio.touch("center")
    assert (thymio["motor.left.target"], thymio["motor.right.target"]) == (0, 0)


def test_center_is_red(thymio):
    thymio.touch("center")
    assert shows(thymio, "top", "red")


def test_it_can_be_driven_into_the_blue_bay(thymio):
    thymio.touch("forward")
    thymio.until(lambda: thymio.pose.x_m > 0.28, seconds=10)
    thymio.touch("center")
    thymio.touch("left")
    thymio.until(lambda: thymio.pose.yaw_rad > math.radians(88), seconds=10)
    thymio.touch("center")
    thymio.touch("forward")
    thymio.until(lambda: thymio.pose.y_m > 0.2, seconds=10)
    thymio.touch("center")
    thymio.run(1)
    assert thymio.speed == 0
    assert no_contact(thymio)
