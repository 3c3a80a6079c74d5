"""Memories of one sensor on many robots, as columns."""

from __future__ import annotations

from typing import Any

from thymio_sim_ros.sim.plugin_api.column_state import Notes


def test_a_column_begins_with_what_each_robot_remembers() -> None:
    notes = Notes([{"taps": 3}, {}])
    assert notes.column("taps", 0).tolist() == [3, 0]
    assert notes.column("told", (0, 0)).tolist() == [[0, 0], [0, 0]]


def test_what_was_written_to_columns_is_given_back() -> None:
    memories: list[dict[str, Any]] = [{"other": "kept"}, {}]
    notes = Notes(memories)
    notes.column("taps", 0)[1] = 7
    notes.column("speeds", (0.0, 0.0))[0] = (1.5, 2.5)
    notes.give_back()
    assert memories == [
        {"other": "kept", "taps": 0, "speeds": (1.5, 2.5)},
        {"taps": 7, "speeds": (0.0, 0.0)},
    ]
    memories[0]["taps"] = 9
    assert notes.column("taps", 0).tolist() == [9, 7]


def test_a_memory_that_is_lent_may_be_changed() -> None:
    memories: list[dict[str, Any]] = [{}, {}]
    notes = Notes(memories)
    taps = notes.column("taps", 0)
    taps[:] = (1, 2)
    notes.lend(0)
    memories[0]["taps"] += 4
    notes.take_back(0)
    assert taps.tolist() == [5, 2]
    assert memories[1] == {}
