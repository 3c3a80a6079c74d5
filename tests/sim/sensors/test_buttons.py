"""The five buttons as they are read."""

from __future__ import annotations

import pytest

from tests.sim.builders import FLOOR, make, readings, run, send
from tests.sim.fake_view import FakeView
from thymio_sim_ros.sim.commands import (
    PressButton,
)
from thymio_sim_ros.sim.sensors import buttons
from thymio_sim_ros.sim.stimuli.buttons import STIMULUS, ButtonState
from thymio_sim_ros.sim.world import World


@pytest.fixture
def world() -> World:
    return World(make([FLOOR]), noise=False)


def test_held_buttons_read_one_in_the_order_of_the_firmware() -> None:
    state = ButtonState()
    STIMULUS.apply(state, PressButton("center", pressed=True), 0)
    reading = buttons.SENSOR.measure(FakeView(states=(state,)))
    assert reading is not None
    assert reading.words == (0, 0, 1, 0, 0)


def test_a_button_is_read_until_it_is_let_go(world: World) -> None:
    send(world, PressButton("left", pressed=True))
    held = readings(run(world, 0.1), "buttons")
    send(world, PressButton("left", pressed=False))
    released = readings(run(world, 0.1), "buttons")
    assert {reading.words for reading in held} == {(0, 1, 0, 0, 0)}
    assert {reading.words for reading in released} == {(0, 0, 0, 0, 0)}
