"""Lights that move by themselves, as the robot's driver offers them (docs/spec/ros-interface.md section 4.2).

How each looks is our own choice: the facts give names, a period, and its sign as the direction.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from thymio_sim_ros.sim.commands import LED_FULL, LED_GROUPS

__all__ = ["GESTURES", "Gesture"]

_CIRCLE = LED_GROUPS["circle"]
_FRONT = 6
"""Lights of the proximity group that lie in a row at the front."""


def _circle(phase: float) -> tuple[int, ...]:
    """The levels of a light that runs clockwise and fades to both sides."""
    return tuple(_level(0.5 + 0.5 * math.cos(math.tau * (phase - index / _CIRCLE))) for index in range(_CIRCLE))


def _blink(phase: float) -> tuple[int, ...]:
    """The levels of lights that are on for half of the period."""
    return (LED_FULL if phase < 0.5 else 0,) * _CIRCLE


def _alive(phase: float) -> tuple[int, ...]:
    """The levels of lights that swell and fade together."""
    return (_level(0.5 - 0.5 * math.cos(math.tau * phase)),) * _CIRCLE


def _kit(phase: float) -> tuple[int, ...]:
    """The levels of a light that moves back and forth at the front, from the left."""
    place = (_FRONT - 1) * (1 - abs(1 - 2 * phase))
    front = tuple(_level(1 - abs(place - index)) for index in range(_FRONT))
    return (*front, *[0] * (LED_GROUPS["proximity"] - _FRONT))


def _level(brightness: float) -> int:
    return round(max(0.0, brightness) * LED_FULL)


GESTURES: Mapping[str, tuple[str, Callable[[float], tuple[int, ...]]]] = {
    "circle": ("circle", _circle),
    "blink": ("circle", _blink),
    "alive": ("circle", _alive),
    "kit": ("proximity", _kit),
}
"""Name → group of lights, and their levels by the phase 0…1."""


@dataclass(frozen=True, slots=True)
class Gesture:
    """One of GESTURES since a moment; a negative period runs backwards."""

    name: str
    period_s: float
    began_ns: int

    @property
    def group(self) -> str:
        """The lights that it moves."""
        return GESTURES[self.name][0]

    def levels(self, now_ns: int) -> tuple[int, ...]:
        """The levels of the lights at this time."""
        _, shape = GESTURES[self.name]
        return shape((now_ns - self.began_ns) * 1e-9 / self.period_s % 1.0)
