"""Indicators of the firmware while a program runs: sensor values on the lights, and a sound for each button.

Rules and numbers: docs/spec/thymio-robot.md section 8.4. They are updated 50 times per second. An indicator ends when
a program sets its lights, button sounds end when a program uses sound; a reset starts all of them again.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Protocol

from thymio_sim_ros.sim.commands import LED_FULL, Command, PlaySystemSound, ShowOnLeds

__all__ = ["PERIOD_NS", "Indicators"]

PERIOD_NS = 20_000_000
"""Time between two updates."""
ARROW_SOUND, CENTER_SOUND = 2, 3
"""System sounds of the buttons (section 9)."""

Levels = Mapping[str, tuple[int, ...]]


class _Indicator(Protocol):
    """One indicator: the variables that it looks at, and what it shows."""

    @property
    def variables(self) -> tuple[str, ...]:
        """Names of the variables."""
        ...

    @property
    def is_animated(self) -> bool:
        """Whether it shows something else at the next look though nothing that it sees changes."""
        ...

    def levels(self, words: Sequence[Sequence[int]]) -> Levels:
        """Levels by group for the words of its variables."""
        ...


class _Static:
    """A indicator without time."""

    is_animated = False


class _Proximity(_Static):
    """Brightness between the smallest and the largest reading so far."""

    variables = ("prox.horizontal", "prox.ground.delta")

    def __init__(self) -> None:
        self._low, self._high = [1200] * 7 + [0] * 2, [4000] * 7 + [900] * 2

    def levels(self, words: Sequence[Sequence[int]]) -> Levels:
        levels = list(map(self._level, range(9), (*words[0], *words[1])))
        left, center_left, center, center_right, right, rear_left, rear_right, *ground = levels
        front = (left, center_left, center, center, center_right, right)
        return {"proximity": (*front, rear_left, rear_right), "ground": tuple(ground)}

    def _level(self, number: int, value: int) -> int:
        low, high = self._low, self._high
        if 0 < value < low[number]:
            low[number] = value
        if value > high[number]:
            high[number] = value
        return max(0, LED_FULL * (value - low[number]) // (high[number] - low[number]))


class _Inclination(_Static):
    """The light of the circle on the lowest side, once the robot is no longer level."""

    variables = ("acc",)

    def levels(self, words: Sequence[Sequence[int]]) -> Levels:
        right, forward, up = words[0]
        levels = [0] * 8
        if up < 21 and abs(right) + abs(forward) > 10:
            levels[_lowest(right, forward)] = max(0, min(LED_FULL, 42 - 2 * abs(up)))
        return {"circle": tuple(levels)}


def _lowest(right: int, forward: int) -> int:
    """The light of the circle for acc[0] and acc[1]: 4 is the rear, 2 the right, 0 the front, 6 the left."""
    angle = math.degrees(math.atan2(right, forward))
    steps = sum(abs(angle) > border for border in (22, 66, 110, 154))
    return (4 + steps if angle > 0 else 4 - steps) % 8


class _Buttons:
    """A touched button lights up step by step; the center lights all four."""

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


class _Temperature(_Static):
    """Blue is cold, red is warm."""

    variables = ("temperature",)

    def levels(self, words: Sequence[Sequence[int]]) -> Levels:
        ((tenths,),) = words
        red = max(0, min(LED_FULL, LED_FULL * (tenths - 150) // 130))
        return {"temperature": (red, LED_FULL - red)}


class _Sound:
    """The peak of what the microphone hears, fading; only while a program listens."""

    variables = ("mic.intensity", "mic.threshold")

    def __init__(self) -> None:
        self._level = self._peak = 0

    def record_intensity(self, intensity: int) -> None:
        """What was heard between two looks, and may be gone at the next."""
        self._peak = max(self._peak, intensity)

    @property
    def is_animated(self) -> bool:
        return self._level > 0 or self._peak // 8 > 0

    def levels(self, words: Sequence[Sequence[int]]) -> Levels:
        (intensity,), (threshold,) = words
        peak, self._peak = max(self._peak, intensity), 0
        self._level = max(self._level - 1, peak // 8, 0) if threshold else 0
        return {"microphone": (min(LED_FULL, self._level),)}


class _Remote:
    """A short flash for each command of a remote control."""

    variables = ()
    FLASH_UPDATES = 5
    """Looks that a flash lasts, a tenth of a second. Own choice."""

    def __init__(self) -> None:
        self._left = 0

    @property
    def is_animated(self) -> bool:
        return self._left > 0

    def flash(self) -> None:
        """A command arrived."""
        self._left = self.FLASH_UPDATES + 1

    def levels(self, words: Sequence[Sequence[int]]) -> Levels:
        self._left = max(0, self._left - 1)
        return {"remote": (LED_FULL if self._left else 0,)}


class _Battery:
    """One to three lights; a single one blinks before the robot goes out. They fill while a charger is connected."""

    variables = ("_vbat",)
    BLINK_UPDATES = 25
    """Looks between on and off, and from one light to the next, half a second. Own choice."""

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


_PROXIMITY_GROUPS = ("proximity", "ground")
"""One indicator shows both, and a program that sets either ends it (section 6.3)."""
_INDICATORS: tuple[Callable[[], _Indicator], ...] = (_Proximity, _Inclination, _Buttons, _Temperature, _Sound, _Battery)


def _memory_spans(addresses: Mapping[str, tuple[int, int]]) -> list[tuple[int, int]]:
    """Begin and end of the parts of the memory that indicators look at."""
    spans: list[tuple[int, int]] = []
    for address, size in sorted(
        addresses[name] for make in _INDICATORS for name in make().variables if name in addresses
    ):
        if spans and spans[-1][1] == address:
            spans[-1] = (spans[-1][0], address + size)
        else:
            spans.append((address, address + size))
    return spans


def _locate(spans: Sequence[tuple[int, int]], address: int, size: int) -> tuple[int, int, int]:
    """Number of the part that holds a variable, and its begin and end there."""
    number = next(number for number, (begin, end) in enumerate(spans) if begin <= address < end)
    offset = address - spans[number][0]
    return number, offset, offset + size


class Indicators:
    """The indicators of one robot. Invariant: each tells a group only when it looks different from the last time."""

    def __init__(self, addresses: Mapping[str, tuple[int, int]], is_measured: Callable[[int], bool]) -> None:
        """`addresses`: where the variables lie; a indicator that misses one of its variables is left out.

        `is_measured` tells whether something was measured for an address since the reset.
        """
        self._addresses, self._is_measured = addresses, is_measured
        self._buttons = [addresses[name][0] for name in _Buttons.variables]
        self._spans = _memory_spans(addresses)
        self._pressed = [0] * len(self._buttons)
        self.reset()

    def reset(self) -> None:
        """Begin anew, all lights dark; a button that is still held is not touched again."""
        self._remote = _Remote()
        indicators: list[_Indicator] = [*(make() for make in _INDICATORS), self._remote]
        self._sound = next(indicator for indicator in indicators if isinstance(indicator, _Sound))
        self._battery = next(indicator for indicator in indicators if isinstance(indicator, _Battery))
        self._indicators = [
            (indicator, [_locate(self._spans, *self._addresses[name]) for name in indicator.variables])
            for indicator in indicators
            if all(name in self._addresses for name in indicator.variables)
        ]
        self._without_data = {indicator for indicator, _ in self._indicators}
        """Rules that have not shown anything."""
        self._shown: dict[str, tuple[int, ...]] = {}
        self._claimed_groups: set[str] = set()
        self._last: list[Sequence[int]] | None = None
        self.is_animated = True
        """Whether the next look may show something else though the variables stay as they are."""
        self._is_muted = False

    def claim(self, group: str) -> list[str]:
        """A program has taken these lights over; the groups that a indicator had lit and shows no more."""
        groups = _PROXIMITY_GROUPS if group in _PROXIMITY_GROUPS else (group,)
        self._claimed_groups.update(groups)
        return [one for one in groups if self._shown.pop(one, None) is not None]

    def mute_buttons(self) -> None:
        """A program has used sound."""
        self._is_muted = True

    def record_intensity(self, intensity: int) -> None:
        """The microphone heard this."""
        self._sound.record_intensity(intensity)
        self.is_animated = self.is_animated or self._sound.is_animated

    def set_charging(self, *, is_charging: bool) -> None:
        """The battery tells whether a charger is connected."""
        self._battery.is_charging = is_charging
        self.is_animated = self.is_animated or is_charging

    def flash_remote(self) -> None:
        """A remote control was heard."""
        self._remote.flash()
        self.is_animated = True

    def update(self, memory: Sequence[int]) -> Iterable[Command]:
        """One look at the variables: what changes on lights and loudspeaker."""
        parts = [memory[begin:end] for begin, end in self._spans]
        changed = {number for number, part in enumerate(parts) if self._last is None or part != self._last[number]}
        if not changed and not self.is_animated and not self._without_data:
            return ()
        self._last = parts
        commands = [*self._lights(parts, changed), *self._button_sounds(memory)]
        self.is_animated = any(indicator.is_animated for indicator, _ in self._indicators)
        return commands

    def _lights(self, parts: Sequence[Sequence[int]], changed: set[int]) -> Iterator[Command]:
        for indicator, places in self._indicators:
            if indicator in self._without_data:
                if indicator.variables and not any(
                    self._is_measured(self._addresses[name][0]) for name in indicator.variables
                ):
                    continue  # nothing was measured since the reset
                self._without_data.discard(indicator)
            elif not indicator.is_animated and not any(part in changed for part, _, _ in places):
                continue
            words = [parts[part][begin:end] for part, begin, end in places]
            for group, levels in indicator.levels(words).items():
                if group not in self._claimed_groups and levels != self._shown.get(group, (0,) * len(levels)):
                    self._shown[group] = levels
                    yield ShowOnLeds(group, levels)

    def _button_sounds(self, memory: Sequence[int]) -> Iterator[Command]:
        before, self._pressed = self._pressed, [memory[address] for address in self._buttons]
        if self._is_muted:
            return
        *arrows, center = (new and not old for new, old in zip(self._pressed, before, strict=True))
        if any(arrows):
            yield PlaySystemSound(ARROW_SOUND)
        if center:
            yield PlaySystemSound(CENTER_SOUND)
