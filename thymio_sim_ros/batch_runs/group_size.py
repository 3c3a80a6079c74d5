"""How many tasks make a group, which is what the cluster schedules: few enough to share, many enough to be cheap.

Scheduling costs some milliseconds per group, whatever it contains. A group should take `GROUP_S`, so that this cost
disappears, and towards the end groups shrink, so that no worker waits for the last one of another.
"""

from __future__ import annotations

__all__ = ["GROUP_S", "GroupSize"]

GROUP_S = 0.5
"""Duration that a group should have, in s."""

GROWTH = 8
"""A group is at most this many times as large as the largest one before: one short task says little about the rest."""


class GroupSize:
    """The size of the next group, from the duration of those before. The first groups have one task."""

    def __init__(self) -> None:
        self._tasks, self._seconds = 0, 0.0
        self._largest = 0

    def add(self, tasks: int, seconds: float) -> None:
        """Add a finished group: its number of tasks and the time that it took in s."""
        self._tasks += tasks
        self._seconds += seconds
        self._largest = max(self._largest, tasks)

    def next(self, waiting: int, threads: int) -> int:
        """Return the size for so many waiting tasks and threads of the cluster, at least 1."""
        if not self._tasks:
            return 1
        mean_s = max(self._seconds / self._tasks, 1e-6)
        fair = waiting // (2 * threads)
        return max(1, min(int(GROUP_S / mean_s), fair, GROWTH * self._largest))
