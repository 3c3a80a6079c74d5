"""Frames of a remote control as they are read."""

from __future__ import annotations

from tests.sim.builders import FLOOR, make, readings, run, send
from thymio_sim_ros.sim.commands import RemoteKey
from thymio_sim_ros.sim.world import World


def heard(*keys: RemoteKey) -> list[tuple[int, ...]]:
    """What is read of keys that come one after the other, a tenth of a second apart."""
    world = World(make([FLOOR]))
    words = []
    for key in keys:
        send(world, key)
        words += [reading.words for reading in readings(run(world, 0.1), "remote")]
    return words


def test_nothing_is_read_while_no_key_is_pressed() -> None:
    assert readings(run(World(make([FLOOR])), 1.0), "remote") == []


def test_every_press_is_read_once() -> None:
    assert heard(RemoteKey(5, 80), RemoteKey(5, 80), RemoteKey(31, 127)) == [(5, 80), (5, 80), (31, 127)]


def test_a_frame_with_the_same_toggle_bit_is_a_repetition() -> None:
    held = RemoteKey(0, 2, toggle=False)
    assert heard(held, held, held, RemoteKey(0, 2, toggle=True)) == [(0, 2), (0, 2)]


def test_another_key_with_the_same_toggle_bit_is_new() -> None:
    assert heard(RemoteKey(0, 2, toggle=True), RemoteKey(0, 3, toggle=True)) == [(0, 2), (0, 3)]


def test_the_first_frame_counts_whatever_its_bits() -> None:
    assert heard(RemoteKey(0, 0, toggle=False)) == [(0, 0)]
