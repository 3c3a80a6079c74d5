"""Commands to the LEDs."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = [
    "COLORED_GROUPS",
    "LEDS_GIVEN_BACK",
    "LED_COLORS",
    "LED_FULL",
    "LED_GESTURES",
    "LED_GROUPS",
    "Lighting",
    "PlayGesture",
    "ReleaseLeds",
    "SetLed",
    "SetLeds",
    "ShowOnLeds",
    "StopGesture",
]

LED_GROUPS: dict[str, int] = {
    "top": 3,
    "bottom_left": 3,
    "bottom_right": 3,
    "circle": 8,
    "buttons": 4,
    "proximity": 8,
    "ground": 2,
    "temperature": 2,
    "microphone": 1,
    "remote": 1,
    "battery": 3,
    "sd": 1,
}
"""LED groups and their number of lights (docs/spec/thymio-robot.md sections 6.3 and 8)."""

LED_GESTURES = ("circle", "blink", "kit", "alive")
"""Animations of the LEDs (docs/spec/ros-interface.md section 4.2)."""

LED_FULL = 32
"""Brightness of a fully lit LED (docs/spec/thymio-robot.md section 8.1)."""


COLORED_GROUPS = ("top", "bottom_left", "bottom_right")
"""The groups that color the body: red, green, blue."""

LED_COLORS: dict[str, tuple[int, int, int]] = {
    name: (LED_FULL * red, LED_FULL * green, LED_FULL * blue)
    for name, (red, green, blue) in {
        "off": (0, 0, 0),
        "red": (1, 0, 0),
        "green": (0, 1, 0),
        "blue": (0, 0, 1),
        "yellow": (1, 1, 0),
        "cyan": (0, 1, 1),
        "magenta": (1, 0, 1),
        "white": (1, 1, 1),
    }.items()
}
"""Colors of the body by name: brightness of red, green, blue."""


@dataclass(frozen=True, slots=True)
class SetLeds:
    """Brightness 0…32 of every light of one group of `LED_GROUPS`; the firmware no longer controls the group."""

    group: str
    levels: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class SetLed:
    """Brightness 0…32 of one light by its number (docs/spec/thymio-robot.md section 8.2)."""

    number: int
    level: int


@dataclass(frozen=True, slots=True)
class ShowOnLeds:
    """The colors that the firmware shows on one group (section 8.4); no effect while a program owns the group."""

    group: str
    levels: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class ReleaseLeds:
    """Return one group to the firmware, which shows the sensors on it again."""

    group: str


@dataclass(frozen=True, slots=True)
class PlayGesture:
    """Start a gesture: one of `LED_GESTURES`, with a period of 0.1…60 s, negative for backwards.

    Raises ValueError for another name or period.
    """

    name: str
    period_s: float

    def __post_init__(self) -> None:
        if self.name not in LED_GESTURES:
            raise ValueError(f"PlayGesture: {self.name!r} found, expected one of {', '.join(LED_GESTURES)}")
        if not 0.1 <= abs(self.period_s) <= 60.0:
            raise ValueError(f"PlayGesture: period {self.period_s:g} s found, expected 0.1 to 60, either sign")


@dataclass(frozen=True, slots=True)
class StopGesture:
    """Stop the gesture and return its group to the firmware."""


LEDS_GIVEN_BACK: tuple[ShowOnLeds | ReleaseLeds, ...] = (
    *(ShowOnLeds(group, (0,) * size) for group, size in LED_GROUPS.items()),
    *(ReleaseLeds(group) for group in LED_GROUPS),
)
"""Return all LEDs to the firmware, which shows nothing."""

Lighting = SetLeds | SetLed | ShowOnLeds | ReleaseLeds | PlayGesture | StopGesture
