"""The lights as they are read: at the start and on change."""

from __future__ import annotations

import pytest

from tests.sim.builders import FLOOR, make, readings, run, send
from tests.sim.fake_view import FakeView
from thymio_sim_ros.sim.actuators.leds import LedState
from thymio_sim_ros.sim.commands import (
    LED_GROUPS,
    SetLeds,
)
from thymio_sim_ros.sim.model.readings import LedReading
from thymio_sim_ros.sim.sensors import leds
from thymio_sim_ros.sim.world import World


@pytest.fixture
def world() -> World:
    return World(make([FLOOR]), noise=False)


def test_lights_are_published_once_at_the_start_and_then_on_change() -> None:
    state = LedState()
    view = FakeView(states=(state,))
    first, second = leds.SENSOR.measure(view), leds.SENSOR.measure(view)
    state.show("top", (1, 2, 3))
    third = leds.SENSOR.measure(view)
    assert isinstance(first, LedReading)
    assert first.groups == tuple((group, (0,) * size) for group, size in LED_GROUPS.items())
    assert second is None
    assert isinstance(third, LedReading)
    assert dict(third.groups)["top"] == (1, 2, 3)


def test_what_was_set_and_has_come_back_is_no_news() -> None:
    state = LedState()
    view = FakeView(states=(state,))
    leds.SENSOR.measure(view)
    state.show("top", (1, 2, 3))
    state.show("top", (0, 0, 0))
    assert leds.SENSOR.measure(view) is None


def test_lights_are_first_published_in_the_first_step(world: World) -> None:
    first, second = (len(readings([world.step()], "leds")) for _ in range(2))
    assert (first, second) == (1, 0)


def test_a_set_light_is_read_within_the_period(world: World) -> None:
    run(world, 0.1)
    send(world, SetLeds("circle", (32, 0, 0, 0, 0, 0, 0, 99)))
    (reading,) = readings(run(world, 0.04), "leds")
    assert dict(reading.groups)["circle"] == (32, 0, 0, 0, 0, 0, 0, 32)
