"""Fingers on buttons."""

from __future__ import annotations

import pytest

from thymio_sim_ros.sim.commands import BUTTONS, PressButton
from thymio_sim_ros.sim.stimuli.buttons import STIMULUS, ButtonState


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
