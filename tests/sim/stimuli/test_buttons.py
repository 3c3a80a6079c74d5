"""Fingers on buttons."""

from __future__ import annotations

import pytest

from tests.sim.builders import FLOOR, make
from thymio_sim_ros.sim.commands import BUTTONS, PressButton
from thymio_sim_ros.sim.stimuli.buttons import STIMULUS, ButtonState
from thymio_sim_ros.sim.world import World


def test_no_button_is_held_at_the_start() -> None:
    assert ButtonState().pressed == dict.fromkeys(BUTTONS, False)


def test_several_buttons_can_be_held_at_once() -> None:
    state = ButtonState()
    STIMULUS.apply(state, PressButton("left", pressed=True), 0)
    STIMULUS.apply(state, PressButton("right", pressed=True), 0)
    assert [button for button, held in state.pressed.items() if held] == ["left", "right"]


def test_an_unknown_button_is_our_mistake() -> None:
    with pytest.raises(ValueError, match="expected one of backward, left, center, forward, right"):
        STIMULUS.apply(ButtonState(), PressButton("top", pressed=True), 0)


@pytest.mark.parametrize("robots", [1, 14], ids=["alone", "in a batch"])
@pytest.mark.parametrize("start", [0, 1])
def test_a_press_shorter_than_a_scan_is_scanned_once(start: int, robots: int) -> None:
    names = [f"robot_{number}" for number in range(robots)]
    starts = [{"name": name, "x_m": 0.25 * (number - 7), "y_m": 0.0} for number, name in enumerate(names)]
    world = World(make([FLOOR], starts))
    for _ in range(start):
        world.step()
    world.post(names[-1], PressButton("forward", pressed=True))
    world.post(names[-1], PressButton("forward", pressed=False))
    scans = [
        reading.words
        for _ in range(8)
        for robot, sensor, reading in world.step().readings
        if (robot, sensor) == (names[-1], "buttons")
    ]
    assert scans == [(0, 0, 0, 1, 0), (0, 0, 0, 0, 0), (0, 0, 0, 0, 0), (0, 0, 0, 0, 0)]


def test_a_button_pressed_again_before_its_release_took_effect_stays_pressed() -> None:
    state = ButtonState()
    for pressed in (True, False, True):
        STIMULUS.apply(state, PressButton("left", pressed=pressed), 0)
    assert STIMULUS.is_idle is not None
    assert STIMULUS.is_idle(state)
    assert state.pressed["left"]
