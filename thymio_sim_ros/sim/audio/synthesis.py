"""Sounds of the robot's loudspeaker: one stream of samples, tones made of a wave, the robot's own sounds.

Numbers: docs/spec/thymio-robot.md section 9.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

__all__ = [
    "ALARM",
    "BLOCK_NS",
    "BLOCK_SAMPLES",
    "SAMPLE_NS",
    "SHUT_DOWN",
    "SILENCE",
    "SYSTEM_SOUNDS",
    "TRIANGLE",
    "VOLUME_OFF",
    "WAVE_LENGTH",
    "Note",
    "system_sound",
    "tone",
]

SAMPLE_NS = 128_000
"""One sample at 7812.5 Hz."""
BLOCK_SAMPLES = 128
"""Samples in one tick of the robot's sound, 16.384 ms."""
BLOCK_NS = SAMPLE_NS * BLOCK_SAMPLES
WAVE_LENGTH = 142
"""Samples in one period of a tone's wave."""
LOWEST_HZ = 1e9 / (SAMPLE_NS * WAVE_LENGTH)
"""A period of the wave sample by sample: 55 Hz."""
HIGHEST_HZ = 1e9 / (2 * SAMPLE_NS)
"""Half the rate of the samples: 3906 Hz."""
VOLUME_OFF = 8
"""Bits that a sample loses at the lowest volume."""
SILENCE = 128
"""The unsigned sample at rest."""


@dataclass(frozen=True, slots=True)
class Note:
    """A tone; `duration_ns` None: it does not end by itself."""

    frequency_hz: float
    duration_ns: int | None


def tone(frequency_hz: float, duration_ns: int | None) -> Note:
    """A note within the range of the robot; the sign of the frequency is ignored."""
    return Note(max(LOWEST_HZ, min(HIGHEST_HZ, abs(frequency_hz))), duration_ns)


def _triangle() -> tuple[int, ...]:
    corners = [(0, 0), (WAVE_LENGTH // 4, 127), (3 * WAVE_LENGTH // 4, -128), (WAVE_LENGTH, 0)]
    return tuple(
        round(low + (high - low) * (place - begin) / (end - begin))
        for (begin, low), (end, high) in pairwise(corners)
        for place in range(begin, end)
    )


TRIANGLE = _triangle()
"""The wave at the start."""

_START_UP = ((340, 13), (440, 7), (510, 7), (640, 7), (780, 7))
_SHUT_DOWN = ((780, 13), (640, 7), (510, 7), (440, 7), (340, 7))
_FREE_FALL = (
    (1014, 2), (888, 1), (733, 2), (640, 2), (1285, 1), (1157, 1), (1031, 2), (996, 1),
    (890, 2), (640, 2), (1306, 1), (839, 1), (1215, 2), (1182, 1), (1147, 1), (1485, 2),
)  # fmt: skip

SYSTEM_SOUNDS: tuple[tuple[tuple[int, int], ...], ...] = (
    _START_UP,
    _SHUT_DOWN,
    ((110, 7), (220, 7)),
    ((330, 7), (440, 13), (660, 7)),
    _FREE_FALL,
    ((660, 5), (275, 4)),
    ((440, 7), (550, 7)),
    ((440, 7), (550, 7), (660, 7)),
)
"""The robot's own sounds by number as (Hz, ticks of 16.384 ms)."""

ALARM = 2
"""Number of the sound of an alarm, that of the arrow buttons."""
SHUT_DOWN = 1
"""Number of the sound of a robot that is switched off."""

UNKNOWN_SOUND = ((440, 10),)
"""The sound of an unknown number: 10/60 s of 440 Hz (section 6.3)."""


def system_sound(number: int) -> tuple[Note, ...]:
    """The notes of a system sound; a short tone for an unknown number."""
    known = 0 <= number < len(SYSTEM_SOUNDS)
    return tuple(tone(hz, ticks * BLOCK_NS) for hz, ticks in (SYSTEM_SOUNDS[number] if known else UNKNOWN_SOUND))
