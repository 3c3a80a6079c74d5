"""Memories of one sensor on many robots, as columns."""

from __future__ import annotations

from typing import Any

from thymio_sim_ros.sim.plugin_api.column_state import ColumnState


def test_a_column_begins_with_what_each_robot_remembers() -> None:
    column_state = ColumnState([{"taps": 3}, {}])
    assert column_state.column("taps", 0).tolist() == [3, 0]
    assert column_state.column("unknown", (0, 0)).tolist() == [[0, 0], [0, 0]]


def test_what_was_written_to_columns_is_given_back() -> None:
    memories: list[dict[str, Any]] = [{"other": "kept"}, {}]
    column_state = ColumnState(memories)
    column_state.column("taps", 0)[1] = 7
    column_state.column("speeds", (0.0, 0.0))[0] = (1.5, 2.5)
    column_state.release()
    assert memories == [
        {"other": "kept", "taps": 0, "speeds": (1.5, 2.5)},
        {"taps": 7, "speeds": (0.0, 0.0)},
    ]
    memories[0]["taps"] = 9
    assert column_state.column("taps", 0).tolist() == [9, 7]


def test_a_memory_that_is_lent_may_be_changed() -> None:
    memories: list[dict[str, Any]] = [{}, {}]
    column_state = ColumnState(memories)
    taps = column_state.column("taps", 0)
    taps[:] = (1, 2)
    column_state.write_row(0)
    memories[0]["taps"] += 4
    column_state.read_row(0)
    assert taps.tolist() == [5, 2]
    assert memories[1] == {}
