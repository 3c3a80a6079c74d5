"""Indicators of the firmware while a program runs: sensor values on the lights, and a sound for each button.

Rules and numbers: docs/spec/thymio-robot.md section 8.4. They are updated 50 times per second. An indicator ends when
a program sets its lights, button sounds end when a program uses sound; a reset starts all of them again.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

from thymio_sim_ros.device.firmware.indicator_kinds import (
    INDICATORS,
    PROXIMITY_GROUPS,
    BatteryIndicator,
    ButtonsIndicator,
    Indicator,
    RemoteIndicator,
    SoundIndicator,
    StaticIndicator,
)
from thymio_sim_ros.sim.commands import Command, PlaySystemSound, ShowOnLeds

__all__ = ["PERIOD_NS", "Indicators"]

PERIOD_NS = 20_000_000
"""Time between two updates."""
ARROW_SOUND, CENTER_SOUND = 2, 3
"""System sounds of the buttons (section 9)."""


def _memory_spans(places: Iterable[tuple[int, int]]) -> list[tuple[int, int]]:
    """Ranges of addresses (begin, end) that contain variables (address, size), adjacent variables joined."""
    spans: list[tuple[int, int]] = []
    for address, size in sorted(places):
        if spans and spans[-1][1] == address:
            spans[-1] = (spans[-1][0], address + size)
        else:
            spans.append((address, address + size))
    return spans


Places = list[tuple[int, int, int]]
"""For each variable of an indicator the index of the range that contains it, and its begin and end within the range."""


def _locate(spans: Sequence[tuple[int, int]], address: int, size: int) -> tuple[int, int, int]:
    """Index of the range that contains a variable, and begin and end of the variable within it."""
    number = next(number for number, (begin, end) in enumerate(spans) if begin <= address < end)
    offset = address - spans[number][0]
    return number, offset, offset + size


class Indicators:
    """The indicators of one robot. Invariant: a command is returned for a group only if its levels have changed."""

    def __init__(self, addresses: Mapping[str, tuple[int, int]]) -> None:
        """Create the indicators whose variables all exist; `addresses` has address and size of each variable."""
        self._addresses = addresses
        self._buttons = [addresses[name][0] for name in ButtonsIndicator.variables]
        places = [addresses[name] for make in INDICATORS for name in make().variables if name in addresses]
        self.addresses = tuple(address for address, _ in places)
        """Addresses of the variables that they show."""
        self._spans = _memory_spans(places)
        self._button_parts = frozenset(
            number
            for number, (begin, end) in enumerate(self._spans)
            if any(begin <= address < end for address in self._buttons)
        )
        self._pressed = [0] * len(self._buttons)
        self.reset()

    def reset(self) -> None:
        """Restart with all lights off. A button that is still held does not count as touched again."""
        self._remote = RemoteIndicator()
        indicators: list[Indicator] = [*(make() for make in INDICATORS), self._remote]
        self._sound = next(indicator for indicator in indicators if isinstance(indicator, SoundIndicator))
        self._battery = next(indicator for indicator in indicators if isinstance(indicator, BatteryIndicator))
        self._indicators: list[tuple[Indicator, Places, frozenset[int]]] = []
        """Indicators with the places of their variables, and the numbers of the ranges that contain these."""
        for indicator in indicators:
            if all(name in self._addresses for name in indicator.variables):
                places = [_locate(self._spans, *self._addresses[name]) for name in indicator.variables]
                self._indicators.append((indicator, places, frozenset(part for part, _, _ in places)))
        self._animated = [
            indicator for indicator, _, _ in self._indicators if not isinstance(indicator, StaticIndicator)
        ]
        self._pure = {
            self._addresses[indicator.variables[0]][0]: indicator
            for indicator, _, _ in self._indicators
            if isinstance(indicator, StaticIndicator) and indicator.is_pure
        }
        """Pure indicators by the address of their variable."""
        self._without_data = {indicator for indicator, _, _ in self._indicators}
        """Indicators whose variables were not measured since the reset."""
        self._shown: dict[str, tuple[int, ...]] = {}
        self._claimed_groups: set[str] = set()
        self._last: list[Sequence[int]] | None = None
        self.is_animated = True
        """Whether levels may change at the next update although the variables stay the same."""
        self._is_muted = False

    def claim(self, group: str) -> list[str]:
        """End the indicator of these lights, because a program sets them; return the groups that it had lit."""
        groups = PROXIMITY_GROUPS if group in PROXIMITY_GROUPS else (group,)
        self._claimed_groups.update(groups)
        return [name for name in groups if self._shown.pop(name, None) is not None]

    def mute_buttons(self) -> None:
        """End the sounds of buttons, because a program uses sound."""
        self._is_muted = True

    def record_intensity(self, intensity: int) -> None:
        """Report an intensity of the microphone."""
        self._sound.record_intensity(intensity)
        self.is_animated = self.is_animated or self._sound.is_animated

    def set_charging(self, *, is_charging: bool) -> None:
        """Report whether a charger is connected."""
        self._battery.is_charging = is_charging
        self.is_animated = self.is_animated or is_charging

    def flash_remote(self) -> None:
        """Report a command of a remote control."""
        self._remote.flash()
        self.is_animated = True

    def is_outdated(self, address: int, words: Sequence[int]) -> bool:
        """Whether an update may change lights after a variable at this address got these words."""
        indicator = self._pure.get(address)
        if indicator is None or indicator in self._without_data:
            return True
        return any(
            group not in self._claimed_groups and levels != self._shown.get(group, (0,) * len(levels))
            for group, levels in indicator.levels((words,)).items()
        )

    def update(self, memory: Sequence[int], is_measured: Callable[[int], bool]) -> Sequence[Command]:
        """Return commands for changed lights, and sounds for touched buttons.

        Args:
            memory: all words (int16).
            is_measured: returns whether a sensor has written an address since the reset.
        """
        parts = [memory[begin:end] for begin, end in self._spans]
        if parts == self._last and not self.is_animated and not self._without_data:
            return ()
        changed = {number for number, part in enumerate(parts) if self._last is None or part != self._last[number]}
        self._last = parts
        commands: list[Command] = []
        for indicator, places, used in self._indicators:
            if indicator in self._without_data:
                if self._has_data(indicator, is_measured):
                    self._without_data.discard(indicator)
                    self._update_one(indicator, places, commands)
            elif not used.isdisjoint(changed) or indicator.is_animated:
                self._update_one(indicator, places, commands)
        if not self._button_parts.isdisjoint(changed):
            commands += self._button_sounds(memory)
        self.is_animated = any(indicator.is_animated for indicator in self._animated)
        return commands

    def _has_data(self, indicator: Indicator, is_measured: Callable[[int], bool]) -> bool:
        """Whether one of its variables has been measured since the reset, or it has none."""
        addresses = [self._addresses[name][0] for name in indicator.variables]
        return not addresses or any(map(is_measured, addresses))

    def _update_one(self, indicator: Indicator, places: Places, commands: list[Command]) -> None:
        assert self._last is not None
        words = [self._last[part][begin:end] for part, begin, end in places]
        for group, levels in indicator.levels(words).items():
            if group not in self._claimed_groups and levels != self._shown.get(group, (0,) * len(levels)):
                self._shown[group] = levels
                commands.append(ShowOnLeds(group, levels))

    def _button_sounds(self, memory: Sequence[int]) -> Iterator[Command]:
        before, self._pressed = self._pressed, [memory[address] for address in self._buttons]
        if self._is_muted:
            return
        *arrows, center = (new and not old for new, old in zip(self._pressed, before, strict=True))
        if any(arrows):
            yield PlaySystemSound(ARROW_SOUND)
        if center:
            yield PlaySystemSound(CENTER_SOUND)
