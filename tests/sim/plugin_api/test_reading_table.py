"""Readings by sensor, sorted by robot when they are read."""

from __future__ import annotations

import pytest

from thymio_sim_ros.sim.model.readings import GroundReading
from thymio_sim_ros.sim.plugin_api.reading_table import LazyReadings, ReadingTable, select_rows

ROBOTS = ("a", "b")


def ground(count: int) -> GroundReading:
    return GroundReading(0, (0, 0, count, count, count, count), (0.0, 0.0))


def test_rows_come_by_robot_and_then_by_sensor_without_gaps() -> None:
    columns = ReadingTable(ROBOTS, [("ground", [ground(1), ground(2)]), ("rare", [None, ground(3)])])
    rows = (("a", "ground", ground(1)), ("b", "ground", ground(2)), ("b", "rare", ground(3)))
    assert tuple(columns) == rows
    assert (len(columns), columns[1], columns[1:]) == (3, rows[1], rows[1:])


def test_they_equal_a_tuple_of_the_same_and_nothing_else() -> None:
    columns = ReadingTable(ROBOTS, [("ground", [ground(1), None])])
    assert columns == (("a", "ground", ground(1)),)
    assert columns == ReadingTable(ROBOTS, [("other", [None, None]), ("ground", [ground(1), None])])
    assert columns != ()
    assert columns != [("a", "ground", ground(1))]
    assert hash(columns) == hash(tuple(columns))
    assert repr(columns) == repr(tuple(columns))


def test_readings_are_made_once_and_only_when_asked_for() -> None:
    made: list[int] = []

    def make(robot: int) -> GroundReading:
        made.append(robot)
        return ground(robot)

    columns = ReadingTable(ROBOTS, [("ground", LazyReadings(2, make))])
    assert made == []
    assert len(columns) == len(list(columns)) == 2
    assert made == [0, 1]


def test_later_ones_are_a_sequence() -> None:
    later = LazyReadings(3, ground)
    assert (len(later), later[1], later[-1]) == (3, ground(1), ground(2))
    assert later[1:] == [ground(1), ground(2)]
    with pytest.raises(IndexError):
        later[3]


def test_rows_of_some_sensors_leave_the_others_unmade() -> None:
    made: list[int] = []

    def make(robot: int) -> GroundReading:
        made.append(robot)
        return ground(robot)

    columns = ReadingTable(ROBOTS, [("ground", [ground(1), ground(2)]), ("later", LazyReadings(2, make))])
    assert list(select_rows(columns, {"ground"})) == [("a", "ground", ground(1)), ("b", "ground", ground(2))]
    assert list(select_rows(columns, {"nothing"})) == []
    assert made == []
    assert len(columns) == 4
    assert list(select_rows(columns, {"later"})) == [("a", "later", ground(0)), ("b", "later", ground(1))]


def test_rows_of_some_sensors_come_from_a_plain_tuple_too() -> None:
    rows = (("a", "ground", ground(1)), ("a", "rare", ground(3)))
    assert list(select_rows(rows, {"rare"})) == [rows[1]]
