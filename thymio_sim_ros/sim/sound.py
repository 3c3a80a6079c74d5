"""Sound in the world: who makes it, and how it fades with distance.

A level is what a microphone at `NEAR_M` from the source reads as mic.intensity, 0…255 (thymio-robot.md section 7.4).
"""

from __future__ import annotations

from typing import Protocol, runtime_checkable

__all__ = ["FULL_LEVEL", "NEAR_M", "Sounding", "heard"]

FULL_LEVEL = 255
"""The loudest that a microphone tells: the range of its 8-bit samples (thymio-robot.md section 7.4)."""

NEAR_M = 0.1
"""Up to here a source is heard in full. Own choice: about the nearest that two robots come, centre to centre."""


@runtime_checkable
class Sounding(Protocol):
    """State of an actuator that other robots hear: any with this property is a source at its robot's place."""

    @property
    def sounding_level(self) -> float:
        """How loud it is now, 0 (silent) to FULL_LEVEL."""
        ...


def heard(level: float, distance_m: float) -> float:
    """What is left of a level at a distance: amplitudes fall as 1/d (free field), nothing gets louder than near."""
    return level * NEAR_M / max(NEAR_M, distance_m)
