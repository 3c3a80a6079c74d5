"""The number of tasks in a group, the unit that the cluster schedules: few enough to share, many enough to be cheap.

Scheduling costs some milliseconds per group, whatever it contains. Groups should take so long that this cost
disappears, and on large clusters so long that the scheduler keeps up. Towards the end they shrink, so that no worker
waits long for the last one of another.
"""

from __future__ import annotations

__all__ = ["GROUP_S", "GroupSize"]

GROUP_S = 0.5
"""Duration that a group should have, in s."""

MOST_PER_SECOND = 100.0
"""Groups of the whole cluster that may end in a second; a scheduler manages some hundreds."""

GROWTH = 8
"""A group is at most this many times as large as the largest one before: one short task says little about the rest."""

SHRINKAGE = 4
"""Groups at the end are at most this many times as small."""


class GroupSize:
    """The size of the next group, from the duration of those before. The first groups have one task."""

    def __init__(self, group_s: float = GROUP_S) -> None:
        """`group_s`: duration that a group should have on a small cluster, in s; 0: each group has one task."""
        self._group_s = group_s
        self._tasks, self._seconds = 0, 0.0
        self._largest = 0

    def add(self, tasks: int, seconds: float) -> None:
        """Add a finished group: its number of tasks and the time that it took in s."""
        self._tasks += tasks
        self._seconds += seconds
        self._largest = max(self._largest, tasks)

    def next(self, waiting: int, threads: int) -> int:
        """The size for so many waiting tasks and threads of the cluster, from 1 to `waiting`."""
        if not self._tasks or not self._group_s:
            return 1
        mean_s = max(self._seconds / self._tasks, 1e-6)
        full = min(int(max(self._group_s, threads / MOST_PER_SECOND) / mean_s), GROWTH * self._largest)
        fair = waiting // (2 * threads)
        return max(1, min(full, max(fair, full // SHRINKAGE), waiting))
