"""Sound in the world: who makes it, and how it fades with distance.

A level is what a microphone at `NEAR_M` from the source reads as mic.intensity, 0…255 (docs/spec/thymio-robot.md
section 7.4). Loudspeakers and claps are sources; a robot hears its own.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

__all__ = ["FULL_LEVEL", "NEAR_M", "SPEAKER_SHARE", "Sound", "Sounding", "heard"]

FULL_LEVEL = 255
"""The loudest that a microphone tells: the range of its 8-bit samples (docs/spec/thymio-robot.md section 7.4)."""

NEAR_M = 0.1
"""Up to here a source is heard in full. Own choice: about the nearest that two robots come, centre to centre."""

SPEAKER_SHARE = 0.6
"""Level near a loudspeaker for each count of its samples' swing. Own choice: clear beside the robot, and in full below
the 246 that the built-in attentive behaviour takes for a clap (docs/spec/thymio-behaviors.md section 8)."""


@runtime_checkable
class Sounding(Protocol):
    """State of an actuator that is a loudspeaker: any with this property is heard from its robot's place."""

    @property
    def sounding_level(self) -> float:
        """Swing of the samples that it plays now, 0 (silent) to FULL_LEVEL."""
        ...


@dataclass(frozen=True, slots=True)
class Sound:
    """A source in the world at one moment."""

    x_m: float
    y_m: float
    level: float


def heard(sounds: Iterable[Sound], x_m: float, y_m: float) -> float:
    """Level of all sounds together at a place.

    An amplitude falls as 1/d (free field) and is no louder than at NEAR_M; the energies of different sources add up.
    """
    energy = 0.0
    for sound in sounds:
        amplitude = sound.level * NEAR_M / max(NEAR_M, math.hypot(sound.x_m - x_m, sound.y_m - y_m))
        energy += amplitude * amplitude
    return math.sqrt(energy)
