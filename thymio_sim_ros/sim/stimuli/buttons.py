"""Fingers on the five buttons (docs/spec/thymio-robot.md section 7.4).

The robot scans its buttons at 50 Hz. A press that is shorter in simulated time is prolonged until it has been scanned:
otherwise a click would be lost whenever a viewer or the simulator stalls between press and release.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from thymio_sim_ros.sim.commands import BUTTONS, PressButton
from thymio_sim_ros.sim.plugin_api.view import ActuatorView
from thymio_sim_ros.sim.stimuli import Stimulus

__all__ = ["STIMULUS", "ButtonState"]

_MIN_PRESS_NS = 20_000_000
"""Period of the scans (`sim/sensors/buttons.py`)."""


@dataclass(slots=True)
class ButtonState:
    """Whether each button is pressed, in the order of `BUTTONS`; `words` are the same as 0 or 1."""

    pressed: dict[str, bool] = field(default_factory=lambda: dict.fromkeys(BUTTONS, False))
    words: tuple[int, ...] = (0,) * len(BUTTONS)
    pressed_ns: dict[str, int] = field(default_factory=dict)
    """Time at which each button was pressed last."""
    releases_ns: dict[str, int] = field(default_factory=dict)
    """Buttons whose release came too soon, and the time at which it takes effect."""

    def set(self, button: str, *, pressed: bool) -> None:
        """Press or release a button."""
        self.pressed[button] = pressed
        self.words = tuple(map(int, self.pressed.values()))


def _apply(state: ButtonState, command: PressButton, now_ns: int) -> None:
    button = command.button
    if button not in state.pressed:
        raise ValueError(f"PressButton: found {button!r}, expected one of {', '.join(BUTTONS)}")
    if command.pressed:
        state.releases_ns.pop(button, None)
        state.pressed_ns[button] = now_ns
        state.set(button, pressed=True)
    elif state.pressed[button]:
        scanned_ns = state.pressed_ns[button] + _MIN_PRESS_NS
        if now_ns < scanned_ns:
            state.releases_ns[button] = scanned_ns
        else:
            state.set(button, pressed=False)


def _update(state: ButtonState, view: ActuatorView, _dt_s: float) -> None:
    due = [button for button, release_ns in state.releases_ns.items() if view.now_ns >= release_ns]
    for button in due:
        del state.releases_ns[button]
        state.set(button, pressed=False)
        view.wake(PressButton)


def _shows(state: ButtonState) -> Mapping[str, Any]:
    return {"pressed": tuple(button for button, is_pressed in state.pressed.items() if is_pressed)}


STIMULUS = Stimulus(
    name="buttons",
    accepts=(PressButton,),
    begin=ButtonState,
    apply=_apply,
    update=_update,
    is_idle=lambda state: not state.releases_ns,
    shows=_shows,
)
