"""Fingers on the five buttons (docs/spec/thymio-robot.md section 7.4)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from thymio_sim_ros.sim.commands import BUTTONS, PressButton
from thymio_sim_ros.sim.stimuli import Stimulus

__all__ = ["STIMULUS", "ButtonState"]


@dataclass(slots=True)
class ButtonState:
    """Whether each button is pressed, in the order of `BUTTONS`; `words` are the same as 0 or 1."""

    pressed: dict[str, bool] = field(default_factory=lambda: dict.fromkeys(BUTTONS, False))
    words: tuple[int, ...] = (0,) * len(BUTTONS)


def _apply(state: ButtonState, command: PressButton, _now_ns: int) -> None:
    if command.button not in state.pressed:
        raise ValueError(f"PressButton: found {command.button!r}, expected one of {', '.join(BUTTONS)}")
    state.pressed[command.button] = command.pressed
    state.words = tuple(map(int, state.pressed.values()))


def _shows(state: ButtonState) -> Mapping[str, Any]:
    return {"pressed": tuple(button for button, is_pressed in state.pressed.items() if is_pressed)}


STIMULUS = Stimulus(name="buttons", accepts=(PressButton,), begin=ButtonState, apply=_apply, shows=_shows)
