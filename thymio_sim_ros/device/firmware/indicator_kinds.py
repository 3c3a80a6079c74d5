"""Kinds of indicators: sensor values that the firmware shows on the lights.

Rules and numbers: docs/spec/thymio-robot.md section 8.4.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Protocol

from thymio_sim_ros.sim.commands import LED_FULL

__all__ = [
    "INDICATORS",
    "PROXIMITY_GROUPS",
    "BatteryIndicator",
    "ButtonsIndicator",
    "Indicator",
    "RemoteIndicator",
    "SoundIndicator",
    "StaticIndicator",
]

Levels = Mapping[str, tuple[int, ...]]


class Indicator(Protocol):
    """One indicator: the variables that it reads, and the levels of lights that it derives from them."""

    @property
    def variables(self) -> tuple[str, ...]:
        """Names of the variables that it reads."""
        ...

    @property
    def is_animated(self) -> bool:
        """Whether its levels change at the next update although its variables stay the same."""
        ...

    def levels(self, words: Sequence[Sequence[int]]) -> Levels:
        """Levels, 0 to LED_FULL, by group of lights for the words of its variables, in the same order."""
        ...


class StaticIndicator:
    """An indicator that does not depend on time."""

    is_animated = False
    is_pure = False
    """Whether its levels depend on the present words of one variable alone."""


class _Scale:
    """Levels of sensors, each between its smallest and its largest reading so far."""

    def __init__(self, count: int, low: int, high: int) -> None:
        self._low, self._high = [low] * count, [high] * count

    def levels(self, values: Sequence[int]) -> list[int]:
        """Levels for one value of each sensor."""
        low, high, levels = self._low, self._high, []
        for number, value in enumerate(values):
            if 0 < value < low[number]:
                low[number] = value
            if value > high[number]:
                high[number] = value
            levels.append(max(0, LED_FULL * (value - low[number]) // (high[number] - low[number])))
        return levels


class _ProximityIndicator(StaticIndicator):
    """Level of each proximity sensor."""

    variables = ("prox.horizontal",)

    def __init__(self) -> None:
        self._scale = _Scale(7, 1200, 4000)

    def levels(self, words: Sequence[Sequence[int]]) -> Levels:
        left, center_left, center, center_right, right, rear_left, rear_right = self._scale.levels(words[0])
        return {"proximity": (left, center_left, center, center, center_right, right, rear_left, rear_right)}


class _GroundIndicator(StaticIndicator):
    """Level of each ground sensor."""

    variables = ("prox.ground.delta",)

    def __init__(self) -> None:
        self._scale = _Scale(2, 0, 900)

    def levels(self, words: Sequence[Sequence[int]]) -> Levels:
        return {"ground": tuple(self._scale.levels(words[0]))}


class _InclinationIndicator(StaticIndicator):
    """Light of the circle on the lowest side of a tilted robot."""

    variables = ("acc",)
    is_pure = True

    def levels(self, words: Sequence[Sequence[int]]) -> Levels:
        right, forward, up = words[0]
        levels = [0] * 8
        if up < 21 and abs(right) + abs(forward) > 10:
            levels[_lowest(right, forward)] = max(0, min(LED_FULL, 42 - 2 * abs(up)))
        return {"circle": tuple(levels)}


def _lowest(right: int, forward: int) -> int:
    """Index of the light of the circle for acc[0] and acc[1]: 4 is the rear, 2 the right, 0 the front, 6 the left."""
    angle = math.degrees(math.atan2(right, forward))
    steps = sum(abs(angle) > border for border in (22, 66, 110, 154))
    return (4 + steps if angle > 0 else 4 - steps) % 8


class ButtonsIndicator:
    """Lights of touched buttons, which become brighter step by step; the center button lights all four."""

    variables = ("button.forward", "button.right", "button.backward", "button.left", "button.center")

    def __init__(self) -> None:
        self._levels = [0] * 4
        self.is_animated = False

    def levels(self, words: Sequence[Sequence[int]]) -> Levels:
        *arrows, center = (word[0] for word in words)
        self._levels = [
            min(LED_FULL, level + 3) if touched or center else 0
            for level, touched in zip(self._levels, arrows, strict=True)
        ]
        self.is_animated = any(0 < level < LED_FULL for level in self._levels)
        return {"buttons": tuple(self._levels)}


class _TemperatureIndicator(StaticIndicator):
    """Temperature as a mix of blue (cold) and red (warm)."""

    variables = ("temperature",)
    is_pure = True

    def levels(self, words: Sequence[Sequence[int]]) -> Levels:
        ((tenths,),) = words
        red = max(0, min(LED_FULL, LED_FULL * (tenths - 150) // 130))
        return {"temperature": (red, LED_FULL - red)}


class SoundIndicator:
    """Fading peak of the intensity of the microphone, while `mic.threshold` is not 0."""

    variables = ("mic.intensity", "mic.threshold")

    def __init__(self) -> None:
        self._level = self._peak = 0

    def record_intensity(self, intensity: int) -> None:
        """Include an intensity between two updates in the peak."""
        self._peak = max(self._peak, intensity)

    @property
    def is_animated(self) -> bool:
        return self._level > 0 or self._peak // 8 > 0

    def levels(self, words: Sequence[Sequence[int]]) -> Levels:
        (intensity,), (threshold,) = words
        peak, self._peak = max(self._peak, intensity), 0
        self._level = max(self._level - 1, peak // 8, 0) if threshold else 0
        return {"microphone": (min(LED_FULL, self._level),)}


class RemoteIndicator:
    """Short flash for each command of a remote control."""

    variables = ()
    FLASH_UPDATES = 5
    """Duration of a flash in updates, a tenth of a second; chosen, not measured."""

    def __init__(self) -> None:
        self._left = 0

    @property
    def is_animated(self) -> bool:
        return self._left > 0

    def flash(self) -> None:
        """Start a flash."""
        self._left = self.FLASH_UPDATES + 1

    def levels(self, words: Sequence[Sequence[int]]) -> Levels:
        self._left = max(0, self._left - 1)
        return {"remote": (LED_FULL if self._left else 0,)}


class BatteryIndicator:
    """One to three lights; a single one blinks if the battery is nearly empty. A charger fills them in turn."""

    variables = ("_vbat",)
    BLINK_UPDATES = 25
    """Updates between on and off, and from one light to the next, half a second; chosen, not measured."""

    def __init__(self) -> None:
        self.is_charging = self._was_charging = self._is_low = False
        self._updates = 0

    @property
    def is_animated(self) -> bool:
        return self.is_charging or self._was_charging or self._is_low

    def levels(self, words: Sequence[Sequence[int]]) -> Levels:
        volts = sum(words[0]) * 1000 / 3978 / 100
        lights = 3 if volts >= 3.9 else 2 if volts > 3.6 else 1
        self._is_low, self._was_charging = volts <= 3.4, self.is_charging
        self._updates = self._updates + 1 if self.is_animated else 0
        if self.is_charging:
            lights = self._updates // self.BLINK_UPDATES % 4
        elif self._updates // self.BLINK_UPDATES % 2:
            lights = 0
        return {"battery": tuple(LED_FULL if number < lights else 0 for number in range(3))}


PROXIMITY_GROUPS = ("proximity", "ground")
"""Groups whose indicators both end when a program sets either of them (section 6.3)."""
INDICATORS: tuple[Callable[[], Indicator], ...] = (
    _ProximityIndicator,
    _GroundIndicator,
    _InclinationIndicator,
    ButtonsIndicator,
    _TemperatureIndicator,
    SoundIndicator,
    BatteryIndicator,
)
