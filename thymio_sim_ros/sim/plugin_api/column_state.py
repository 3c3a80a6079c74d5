"""What one sensor remembers of many robots, in columns."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

__all__ = ["ColumnState"]

Column = npt.NDArray[Any]


class ColumnState:
    """The memories of a sensor on many robots. Invariant: a column is the truth until it is given back or lent.

    Values are numbers, or tuples of as many numbers on each robot.
    """

    __slots__ = ("_columns", "_memories")

    def __init__(self, memories: Sequence[dict[str, Any]]) -> None:
        self._memories = memories
        self._columns: dict[str, Column] = {}

    @property
    def memories(self) -> Sequence[dict[str, Any]]:
        """For notes that are not kept in columns, by robot."""
        return self._memories

    def column(self, name: str, first: object) -> Column:
        """A note of all robots, to be written to; `first` is that of a robot that has none."""
        found = self._columns.get(name)
        if found is None:
            found = self._columns[name] = np.array([memory.get(name, first) for memory in self._memories])
        return found

    def release(self) -> None:
        """Write all columns to the memories."""
        for robot in range(len(self._memories)):
            self.write_row(robot)
        self._columns.clear()

    def write_row(self, robot: int) -> None:
        """Let one robot's memory be the truth until it is taken back."""
        for name, column in self._columns.items():
            value = column[robot].tolist()
            self._memories[robot][name] = tuple(value) if isinstance(value, list) else value

    def read_row(self, robot: int) -> None:
        """Read one robot's memory again."""
        for name, column in self._columns.items():
            column[robot] = self._memories[robot][name]
