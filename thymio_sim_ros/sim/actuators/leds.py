"""The lights: brightness 0…32 for each light of each group (thymio-robot.md sections 6.3 and 8)."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from thymio_sim_ros.sim import units
from thymio_sim_ros.sim.actuators import Actuator
from thymio_sim_ros.sim.aseba_face import ActuatorFace, Native, Output
from thymio_sim_ros.sim.commands import LED_FULL, LED_GROUPS, Command, SetLeds

__all__ = ["ACTUATOR", "LedState"]

_RGB = ("red", "green", "blue")


def _numbered(count: int) -> tuple[str, ...]:
    return tuple(f"led{index}" for index in range(count))


_NATIVES: tuple[tuple[str, str, tuple[str, ...], str], ...] = (
    ("leds.circle", "circle", _numbered(8), "Set the circle: front, then clockwise"),
    ("leds.top", "top", _RGB, "Set the color of the top"),
    ("leds.bottom.left", "bottom_left", _RGB, "Set the color of the bottom left"),
    ("leds.bottom.right", "bottom_right", _RGB, "Set the color of the bottom right"),
    ("leds.buttons", "buttons", _numbered(4), "Set the button lights: forward, right, backward, left"),
    ("leds.prox.h", "proximity", _numbered(8), "Set the proximity lights: front left to right, rear left and right"),
    ("leds.prox.v", "ground", _numbered(2), "Set the ground lights: left, right"),
    ("leds.rc", "remote", _numbered(1), "Set the remote control light"),
    ("leds.sound", "microphone", _numbered(1), "Set the sound light"),
    ("leds.temperature", "temperature", ("red", "blue"), "Set the temperature lights"),
)
"""Native, group, parameters, description; in the firmware's order (thymio-robot.md section 6.1)."""

_VARIABLES = ("leds.top", "leds.bottom.left", "leds.bottom.right", "leds.circle")
"""Natives that also write the variable of their name; writing it sets the lights as well (section 8.1)."""


@dataclass(slots=True)
class LedState:
    """Levels 0…32 of every group, in the order of `LED_GROUPS`."""

    levels: dict[str, tuple[int, ...]] = field(
        default_factory=lambda: {group: (0,) * size for group, size in LED_GROUPS.items()}
    )


def _apply(state: LedState, command: SetLeds, _now_ns: int) -> None:
    size = LED_GROUPS.get(command.group)
    if size is None or len(command.levels) != size:
        raise ValueError(f"SetLeds: found {command.group!r} with {len(command.levels)} levels")
    state.levels[command.group] = tuple(max(0, min(LED_FULL, level)) for level in command.levels)


def _setter(group: str) -> Callable[[Sequence[int]], Command]:
    def set_leds(words: Sequence[int]) -> Command:
        return SetLeds(group, tuple(units.saturate_led(word) for word in words))

    return set_leds


def _copier(variable: str) -> Callable[[Sequence[int]], Mapping[str, Sequence[int]]]:
    return lambda words: {variable: words}


ACTUATOR = Actuator(
    name="leds",
    accepts=(SetLeds,),
    begin=LedState,
    apply=_apply,
    aseba=ActuatorFace(
        outputs=tuple(
            Output(((name, LED_GROUPS[group]),), _setter(group))
            for variable in _VARIABLES
            for name, group, _parameters, _text in _NATIVES
            if name == variable
        ),
        natives=tuple(
            Native(name, parameters, _setter(group), text, _copier(name))
            if name in _VARIABLES
            else Native(name, parameters, _setter(group), text)
            for name, group, parameters, text in _NATIVES
        ),
        at_reset=tuple(SetLeds(group, (0,) * size) for group, size in LED_GROUPS.items()),
    ),
)
