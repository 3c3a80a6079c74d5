"""Commands to microphone and infrared communication."""

from __future__ import annotations

from dataclasses import dataclass

from thymio_sim_ros.sim.commands._limits import check

__all__ = ["EnableComm", "Sensing", "SetCommPayload", "SetSoundThreshold"]


@dataclass(frozen=True, slots=True)
class SetSoundThreshold:
    """mic.threshold: a sound above it raises the event mic, 0 is off (int16)."""

    level: int

    def __post_init__(self) -> None:
        check(self, -0x8000, 0x7FFF, "level")


@dataclass(frozen=True, slots=True)
class EnableComm:
    """Infrared communication on or off; off forgets what was sent."""

    is_enabled: bool


@dataclass(frozen=True, slots=True)
class SetCommPayload:
    """prox.comm.tx: the value sent in every frame, at most 2047; a negative one is no data (int16).

    Raises ValueError for a value out of range.
    """

    value: int

    def __post_init__(self) -> None:
        check(self, -0x8000, 0x7FFF, "value")


Sensing = SetSoundThreshold | EnableComm | SetCommPayload
