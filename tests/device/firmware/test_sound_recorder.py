"""Recordings of the microphone."""

from __future__ import annotations

from thymio_sim_ros.device.firmware import sound_recorder
from thymio_sim_ros.device.firmware.sound_recorder import SoundRecorder
from thymio_sim_ros.sim.audio.synthesis import BLOCK_NS, BLOCK_SAMPLES


def test_a_record_has_128_samples_for_each_whole_tick() -> None:
    record = SoundRecorder(1, 0)
    record.record_until(BLOCK_NS - 1, 0)
    assert record.samples == b""
    record.record_until(3 * BLOCK_NS, 0)
    assert record.samples == bytes([128]) * 3 * BLOCK_SAMPLES


def test_the_swing_of_the_samples_is_the_intensity() -> None:
    for intensity in (0, 1, 2, 100, 254, 255):
        record = SoundRecorder(1, 0)
        record.record_until(BLOCK_NS, intensity)
        assert max(record.samples) - min(record.samples) == intensity


def test_a_recording_follows_the_intensity() -> None:
    record = SoundRecorder(1, 0)
    for tick, intensity in enumerate((0, 200, 0), start=1):
        record.record_until(tick * BLOCK_NS, intensity)
    swings = [
        max(block) - min(block)
        for block in (
            record.samples[start : start + BLOCK_SAMPLES] for start in range(0, 3 * BLOCK_SAMPLES, BLOCK_SAMPLES)
        )
    ]
    assert swings == [0, 200, 0]


def test_a_record_ends_when_it_is_full(monkeypatch) -> None:
    monkeypatch.setattr(sound_recorder, "MAX_BLOCKS", 2)
    record = SoundRecorder(1, 0)
    record.record_until(100 * BLOCK_NS, 0)
    assert len(record.samples) == 2 * BLOCK_SAMPLES
