"""Lights follow the buttons."""

from __future__ import annotations

import pytest

from thymio_sim_ros.testing import shows

NODE = "thymio_sim_ros.examples.button_lights"


@pytest.fixture
def sim(ros, simulation):
    """A robot with the node; its firmware shows nothing on the lights."""
    sim = simulation(playground="base")
    ros.start(NODE)
    return sim


@pytest.mark.parametrize(("arrow", "light"), [("forward", 0), ("right", 2), ("backward", 4), ("left", 6)])
def test_an_arrow_lights_its_part_of_the_circle_while_it_is_pressed(sim, arrow, light):
    alone = [32 if number == light else 0 for number in range(8)]
    sim.thymio.press(arrow)
    sim.until(lambda: list(sim.thymio.level("circle")) == alone, seconds=1)
    sim.thymio.release(arrow)
    sim.until(lambda: not any(sim.thymio.level("circle")), seconds=1)


def test_two_arrows_light_two_parts(sim):
    sim.thymio.press("left")
    sim.thymio.press("right")
    sim.until(lambda: list(sim.thymio.level("circle")) == [0, 0, 32, 0, 0, 0, 32, 0], seconds=1)


def test_each_press_of_the_center_button_shows_the_next_color(sim):
    for color in ["green", "blue", "red", "off", "green"]:
        sim.thymio.touch("center")
        sim.until(shows(sim.thymio, "top", color), seconds=1)


def test_the_brightness_is_a_parameter(ros, simulation):
    sim = simulation(playground="base")
    ros.start(NODE, parameters={"brightness": 0.5})
    sim.thymio.touch("center")
    sim.until(shows(sim.thymio, "top", (0, 16, 0), tolerance=1), seconds=1)
