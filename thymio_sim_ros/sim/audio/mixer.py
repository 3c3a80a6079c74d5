"""The samples of a loudspeaker: one mono stream at 7812.5 Hz of simulated time, made from its readings.

A sound begins at the first sample not before it, a tone goes through its wave from the beginning, and the volume takes
bits away (docs/spec/thymio-robot.md section 9).
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Sequence

import numpy as np
import numpy.typing as npt

from thymio_sim_ros.sim.audio.synthesis import SAMPLE_NS, SILENCE, VOLUME_OFF, WAVE_LENGTH
from thymio_sim_ros.sim.model.clock import TICK_NS
from thymio_sim_ros.sim.model.readings import LoudspeakerReading

__all__ = ["Samples", "SoundStream", "mixed"]

_PART = 7813
"""Samples that are mixed at once, about a second."""

Samples = npt.NDArray[np.int64]
"""Samples −128…127."""


class SoundStream:
    """The stream of one robot. Invariant: its readings are in the order of their times."""

    def __init__(self) -> None:
        self._readings: list[LoudspeakerReading] = []
        self._firsts: list[int] = []

    def hear(self, reading: LoudspeakerReading) -> None:
        """Add the next reading of the robot's loudspeaker."""
        goes_on = bool(self._readings) and self._readings[-1].began_ns == reading.began_ns
        begins_ns = reading.stamp_ns - TICK_NS if goes_on else reading.began_ns
        self._readings.append(reading)
        self._firsts.append(-(-begins_ns // SAMPLE_NS))

    def samples(self, first: int, count: int) -> Samples:
        """`count` samples from sample `first` on; sample 0 belongs to time 0."""
        stream = np.zeros(count, dtype=np.int64)
        number = max(0, bisect_right(self._firsts, first) - 1)
        while number < len(self._firsts) and self._firsts[number] < first + count:
            begin = max(first, self._firsts[number])
            end = self._firsts[number + 1] if number + 1 < len(self._firsts) else first + count
            end = min(end, first + count)
            if begin < end:
                stream[begin - first : end - first] = _rendered(self._readings[number], begin, end)
            number += 1
        return stream


def _rendered(reading: LoudspeakerReading, begin: int, end: int) -> Samples:
    """Samples `begin` to `end` of one sound, and silence after it."""
    places = np.arange(begin, end) + reading.began_ns // -SAMPLE_NS
    sound = np.zeros(end - begin, dtype=np.int64)
    if reading.frequency_hz:
        step = reading.frequency_hz * WAVE_LENGTH * SAMPLE_NS / 1e9
        sound = np.array(reading.wave, dtype=np.int64)[(places * step).astype(np.int64) % WAVE_LENGTH]
    elif reading.samples:
        recorded = np.frombuffer(reading.samples, dtype=np.uint8).astype(np.int64) - SILENCE
        inside = places < len(recorded)
        sound[inside] = recorded[places[inside]]
    return np.zeros_like(sound) if reading.shift >= VOLUME_OFF else (sound / (1 << reading.shift)).astype(np.int64)


def mixed(streams: Sequence[SoundStream], first: int, end: int) -> Iterator[bytes]:
    """The sum of all streams from sample `first` to `end`, in parts, clamped to unsigned 8 bits."""
    for begin in range(first, end, _PART):
        total = np.zeros(min(_PART, end - begin), dtype=np.int64)
        for stream in streams:
            total += stream.samples(begin, len(total))
        yield (np.clip(total, -SILENCE, SILENCE - 1) + SILENCE).astype(np.uint8).tobytes()
