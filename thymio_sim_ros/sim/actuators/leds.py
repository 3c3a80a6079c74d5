"""The lights: brightness 0…32 for each light of each group (docs/spec/thymio-robot.md sections 6.3 and 8).

The firmware shows the sensors on a group of LEDs until a program or ROS takes the group over. A gesture animates one
group until it is stopped or the group is set.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache

from thymio_sim_ros.sim.actuators import Actuator
from thymio_sim_ros.sim.actuators._led_patterns import Gesture
from thymio_sim_ros.sim.commands import (
    LED_FULL,
    LED_GROUPS,
    LEDS_GIVEN_BACK,
    Command,
    PlayGesture,
    ReleaseLeds,
    SetLed,
    SetLeds,
    ShowOnLeds,
    StopGesture,
)
from thymio_sim_ros.sim.model import units
from thymio_sim_ros.sim.plugin_api.aseba_binding import ActuatorFace, Native, Output
from thymio_sim_ros.sim.plugin_api.view import ActuatorView

__all__ = ["ACTUATOR", "LED_NUMBERS", "LedState"]

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
"""Native, group, parameters, description; in the firmware's order (docs/spec/thymio-robot.md section 6.1)."""

_VARIABLES = ("leds.top", "leds.bottom.left", "leds.bottom.right", "leds.circle")
"""Natives that also write the variable of their name; writing it sets the lights as well (section 8.1)."""


def _numbers() -> tuple[tuple[str, int] | None, ...]:
    rear, rgb = [("proximity", 6), ("proximity", 7)], range(3)
    body = [(group, index) for group in ("top", "battery", "bottom_left", "bottom_right") for index in rgb]
    front = [("proximity", index) for index in (0, 1, 4, 5, 2, 3)]
    ground = [("ground", 0), ("ground", 1)]
    circle = [("circle", index) for index in range(5)]
    buttons = [("buttons", index) for index in (0, 2, 3, 1)]
    last = [("circle", 5), ("circle", 6), ("temperature", 0), ("temperature", 1)]
    single = [("remote", 0), ("microphone", 0), ("circle", 7)]
    return (*rear, *body, ("sd", 0), None, *front, *ground, *circle, *single, *buttons, *last)


LED_NUMBERS = _numbers()
"""Group and index of each light by its number; 15 is none that can be set (section 8.2)."""


@dataclass(slots=True)
class LedState:
    """Levels 0…32 of every group, in the order of `LED_GROUPS`; groups that were taken over; a gesture.

    `own` is what the firmware shows, also on groups that were taken over. `changes` counts how often lights were set to
    something else.
    """

    levels: dict[str, tuple[int, ...]] = field(
        default_factory=lambda: {group: (0,) * size for group, size in LED_GROUPS.items()}
    )
    taken: set[str] = field(default_factory=set)
    own: dict[str, tuple[int, ...]] = field(default_factory=dict)
    gesture: Gesture | None = None
    changes: int = field(default=0, compare=False)

    def show(self, group: str, levels: tuple[int, ...]) -> None:
        """Set the levels of a group without taking it over from the firmware.

        Raises ValueError for a wrong number of levels, KeyError for an unknown group.
        """
        levels = _limited(group, levels)
        if levels != self.levels[group]:
            self.levels[group] = levels
            self.changes += 1

    def set(self, group: str, levels: tuple[int, ...]) -> None:
        """Take over a group from the firmware and end its gesture. Raises as `show` does."""
        self.show(group, levels)
        self.taken.add(group)
        if self.gesture is not None and self.gesture.group == group:
            self.gesture = None

    def show_own(self, group: str, levels: tuple[int, ...]) -> None:
        """Store what the firmware shows on a group, and show it unless the group was taken over."""
        self.own[group] = levels
        if group not in self.taken:
            self.show(group, levels)

    def release(self, group: str) -> None:
        """Return a group to the firmware."""
        self.set(group, self.own.get(group, (0,) * LED_GROUPS[group]))
        self.taken.discard(group)


def _apply(
    state: LedState,
    command: SetLeds | SetLed | ShowOnLeds | ReleaseLeds | PlayGesture | StopGesture,
    now_ns: int,
) -> None:
    match command:
        case SetLeds(group, levels):
            state.set(group, levels)
        case ShowOnLeds(group, levels):
            state.show_own(group, levels)
        case SetLed(number, level):
            place = LED_NUMBERS[number] if 0 <= number < len(LED_NUMBERS) else None
            if place is not None:
                group, index = place
                levels = state.levels[group]
                state.show(group, (*levels[:index], level, *levels[index + 1 :]))
        case ReleaseLeds(group):
            state.release(group)
        case PlayGesture(name, period_s):
            if state.gesture is not None:
                state.release(state.gesture.group)
            gesture = Gesture(name, period_s, now_ns)
            state.set(gesture.group, gesture.levels(now_ns))
            state.gesture = gesture
        case StopGesture():
            if state.gesture is not None:
                state.release(state.gesture.group)


def _update(state: LedState, view: ActuatorView, _dt_s: float) -> None:
    if state.gesture is not None:
        state.show(state.gesture.group, state.gesture.levels(view.now_ns))


def _limited(group: str, levels: tuple[int, ...]) -> tuple[int, ...]:
    size = LED_GROUPS.get(group)
    if size is None or len(levels) != size:
        raise ValueError(f"lights: found {group!r} with {len(levels)} levels")
    if max(levels) <= LED_FULL and min(levels) >= 0:
        return levels
    return tuple(max(0, min(LED_FULL, level)) for level in levels)


def _setter(group: str) -> Callable[[Sequence[int]], Command]:
    @lru_cache(maxsize=256)  # programs set the same levels again and again
    def command(words: tuple[int, ...]) -> Command:
        return SetLeds(group, tuple(map(units.saturate_led, words)))

    return lambda words: command(tuple(words))


def _copier(variable: str) -> Callable[[Sequence[int]], Mapping[str, Sequence[int]]]:
    return lambda words: {variable: words}


def _single(words: Sequence[int]) -> Command:
    return SetLed(words[0], units.saturate_led(words[1]))


def _group_natives() -> Iterator[Native]:
    for name, group, parameters, text in _NATIVES:
        if name in _VARIABLES:
            yield Native(name, parameters, _setter(group), text, _copier(name))
        else:
            yield Native(name, parameters, _setter(group), text)


ACTUATOR = Actuator(
    name="leds",
    accepts=(SetLeds, SetLed, ShowOnLeds, ReleaseLeds, PlayGesture, StopGesture),
    begin=LedState,
    apply=_apply,
    update=_update,
    is_idle=lambda state: state.gesture is None,
    shows=lambda state: {"leds": tuple(state.levels.items())},
    aseba=ActuatorFace(
        outputs=tuple(
            Output(((name, LED_GROUPS[group]),), _setter(group))
            for variable in _VARIABLES
            for name, group, _parameters, _text in _NATIVES
            if name == variable
        ),
        natives=(*_group_natives(), Native("_leds.set", ("led", "brightness"), _single, "Set one light by its number")),
        at_reset=LEDS_GIVEN_BACK,
    ),
)
