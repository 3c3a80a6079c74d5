"""The readings of one tick, stored by sensor and converted to rows by robot on demand."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from typing import Any, overload

from thymio_sim_ros.sim.model.readings import Reading

__all__ = ["LazyReadings", "ReadingTable", "Row", "select_rows"]

Row = tuple[str, str, Reading]


class LazyReadings(Sequence[Reading | None]):
    """Readings of one sensor on all robots, made on access. `make` must not depend on state that changes later."""

    __slots__ = ("_count", "_make")

    def __init__(self, count: int, make: Callable[[int], Reading | None]) -> None:
        self._count, self._make = count, make

    def __len__(self) -> int:
        return self._count

    @overload
    def __getitem__(self, index: int) -> Reading | None: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[Reading | None]: ...
    def __getitem__(self, index: int | slice) -> Reading | Sequence[Reading | None] | None:
        numbers = range(self._count)[index]
        return self._make(numbers) if isinstance(numbers, int) else [self._make(number) for number in numbers]

    def __iter__(self) -> Iterator[Reading | None]:
        return map(self._make, range(self._count))


class ReadingTable(Sequence[Row]):
    """Readings as (robot, sensor, reading), by robot and then by sensor; equal to a tuple of the same."""

    __slots__ = ("_robots", "_rows", "columns")

    def __init__(self, robots: Sequence[str], columns: Sequence[tuple[str, Sequence[Reading | None]]]) -> None:
        self._robots, self.columns = robots, columns
        self._rows: tuple[Row, ...] | None = None

    def __len__(self) -> int:
        return len(self._all())

    def __iter__(self) -> Iterator[Row]:
        return iter(self._all())

    @overload
    def __getitem__(self, index: int) -> Row: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[Row]: ...
    def __getitem__(self, index: int | slice) -> Row | Sequence[Row]:
        return self._all()[index]

    def __eq__(self, other: Any) -> bool:
        return isinstance(other, ReadingTable | tuple) and self._all() == tuple(other)

    def __hash__(self) -> int:
        return hash(self._all())

    def __repr__(self) -> str:
        return repr(self._all())

    def of(self, sensors: Collection[str]) -> Iterable[Row]:
        """The rows of some sensors, in the same order, without making the readings of the others."""
        if self._rows is not None:
            return (row for row in self._rows if row[1] in sensors)
        wanted = [column for column in self.columns if column[0] in sensors]
        return ReadingTable(self._robots, wanted) if wanted else ()

    def _all(self) -> tuple[Row, ...]:
        if self._rows is None:
            names = [sensor for sensor, _ in self.columns]
            made = zip(*(column for _, column in self.columns), strict=True) if names else ()
            self._rows = tuple(
                [
                    (robot, name, reading)
                    for robot, readings in zip(self._robots, made, strict=False)
                    for name, reading in zip(names, readings, strict=True)
                    if reading is not None
                ]
            )
        return self._rows


def select_rows(readings: Sequence[Row], sensors: Collection[str]) -> Iterable[Row]:
    """The rows of some sensors among the readings of one tick."""
    if isinstance(readings, ReadingTable):
        return readings.of(sensors)
    return (row for row in readings if row[1] in sensors)
