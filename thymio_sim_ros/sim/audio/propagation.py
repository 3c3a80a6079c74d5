"""Sound in the world: its sources, and how it fades with distance.

A level is what a microphone at `NEAR_M` from the source reads as mic.intensity, 0…255 (docs/spec/thymio-robot.md
section 7.4). Loudspeakers and claps are sources; a robot hears its own.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

__all__ = ["FULL_LEVEL", "NEAR_M", "Sound", "SoundSource", "level_at"]

FULL_LEVEL = 255
"""Largest level that a microphone reports: the range of its 8-bit samples (docs/spec/thymio-robot.md section 7.4)."""

NEAR_M = 0.1
"""Distance within which a source is heard at its full level. Assumption: about the smallest distance of two robots,
from center to center."""


@runtime_checkable
class SoundSource(Protocol):
    """The state of a plug-in that makes sound: any state with this method is heard from where its robot is.

    A silent state stays silent until its plug-in gets a command, unless it is busy.
    """

    def sound_level(self, now_ns: int) -> float:
        """Level within NEAR_M of the robot at this simulated time; 0 is silent."""
        ...


@dataclass(frozen=True, slots=True)
class Sound:
    """A source in the world at one time: position in m and level."""

    x_m: float
    y_m: float
    level: float


def level_at(sounds: Iterable[Sound], x_m: float, y_m: float) -> float:
    """The level of all sounds together at a point in the world's frame; not clamped to FULL_LEVEL.

    The amplitude of a source falls as 1/d (free field), but not within NEAR_M. Sources are not coherent, so their
    energies, the squares of the amplitudes, are added, not the amplitudes.
    """
    energy = 0.0
    for sound in sounds:
        amplitude = sound.level * NEAR_M / max(NEAR_M, math.hypot(sound.x_m - x_m, sound.y_m - y_m))
        energy += amplitude * amplitude
    return math.sqrt(energy)
