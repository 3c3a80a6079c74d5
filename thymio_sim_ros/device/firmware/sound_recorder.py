"""Recordings of `sound.record`: the intensity of the microphone, because the simulation has no waveform.

For each block (128 samples) the recording has a square wave with the amplitude `mic.intensity`.
"""

from __future__ import annotations

from thymio_sim_ros.sim.audio.synthesis import BLOCK_NS, BLOCK_SAMPLES, SILENCE

__all__ = ["SoundRecorder"]

_HALF_PERIOD = 8
"""Samples above and then below the center: a tone of 488 Hz."""
MAX_BLOCKS = 10 * 60 * 61
"""Limit of blocks of a recording, ten minutes; later ones are dropped."""


class SoundRecorder:
    """A recording in progress. Invariant: it contains every whole block since its start."""

    def __init__(self, number: int, now_ns: int) -> None:
        self.number = number
        self._next_ns = now_ns + BLOCK_NS
        self._blocks: list[int] = []

    @property
    def samples(self) -> bytes:
        """The samples so far, unsigned 8-bit."""
        return b"".join(_block(intensity) for intensity in self._blocks)

    def record_until(self, now_ns: int, intensity: int) -> None:
        """Record blocks up to this time with the current intensity of the microphone."""
        while now_ns >= self._next_ns:
            self._next_ns += BLOCK_NS
            if len(self._blocks) < MAX_BLOCKS:
                self._blocks.append(max(0, min(255, intensity)))


def _block(intensity: int) -> bytes:
    low = SILENCE - (intensity + 1) // 2
    period = bytes([low + intensity] * _HALF_PERIOD + [low] * _HALF_PERIOD)
    return period * (BLOCK_SAMPLES // len(period))
