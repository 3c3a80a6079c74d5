"""The loudspeaker of the robot."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["PlaySamples", "PlaySystemSound", "PlayTone", "SetAlarm", "SetVolume", "SetWave", "Sounding", "StopSound"]


@dataclass(frozen=True, slots=True)
class PlayTone:
    """A tone of the current wave, limited to what the robot can play; `duration_ns` None: until stopped."""

    frequency_hz: float
    duration_ns: int | None


@dataclass(frozen=True, slots=True)
class PlaySystemSound:
    """One of the robot's own sounds 0…7 (docs/spec/thymio-robot.md section 9); another number is a short tone."""

    number: int


@dataclass(frozen=True, slots=True)
class PlaySamples:
    """A sound of its own: unsigned 8 bit samples at 7812.5 Hz."""

    samples: bytes


@dataclass(frozen=True, slots=True)
class StopSound:
    """Silence; a sound that is stopped has not finished."""


@dataclass(frozen=True, slots=True)
class SetWave:
    """The period that tones are made of: 142 samples −128…127."""

    samples: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class SetVolume:
    """Volume of the loudspeaker as bits that samples lose: 0 is loudest, 8 is off (section 9)."""

    shift: int


@dataclass(frozen=True, slots=True)
class SetAlarm:
    """While it is on, the sound of an arrow button every three seconds."""

    is_on: bool


Sounding = PlayTone | PlaySystemSound | PlaySamples | StopSound | SetWave | SetVolume | SetAlarm
