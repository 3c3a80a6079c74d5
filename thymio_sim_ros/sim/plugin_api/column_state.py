"""The stored values of a sensor on a batch of robots, as columns."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

__all__ = ["ColumnState"]

Column = npt.NDArray[Any]


class ColumnState:
    """The memories of a sensor on a batch of robots.

    Invariant: a column is authoritative until `release` or `write_row`, and again after `read_row`.

    Values are numbers, or tuples of as many numbers on each robot.
    """

    __slots__ = ("_columns", "_memories")

    def __init__(self, memories: Sequence[dict[str, Any]]) -> None:
        self._memories = memories
        self._columns: dict[str, Column] = {}

    @property
    def memories(self) -> Sequence[dict[str, Any]]:
        """By robot, for values that are not stored in columns."""
        return self._memories

    def column(self, name: str, first: object) -> Column:
        """Return the writable values of all robots by name; `first` is the value of a robot without one."""
        found = self._columns.get(name)
        if found is None:
            found = self._columns[name] = np.array([memory.get(name, first) for memory in self._memories])
        return found

    def release(self) -> None:
        """Write all columns to the memories and drop them."""
        for robot in range(len(self._memories)):
            self.write_row(robot)
        self._columns.clear()

    def write_row(self, robot: int) -> None:
        """Write one robot's values to its memory, which is authoritative until `read_row`."""
        for name, column in self._columns.items():
            value = column[robot].tolist()
            self._memories[robot][name] = tuple(value) if isinstance(value, list) else value

    def read_row(self, robot: int) -> None:
        """Read one robot's values from its memory."""
        for name, column in self._columns.items():
            column[robot] = self._memories[robot][name]
