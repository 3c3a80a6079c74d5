"""Whether a pupil is stuck in a mission: many tries that get no further. Pure."""

from __future__ import annotations

from thymio_sim_ros.classroom.suite_state import MissionTry

__all__ = ["MANY_TRIES", "TryHistory"]

MANY_TRIES = 5
"""Tries that ended without getting further than one before them."""


class TryHistory:
    """The tries of the open mission. Another mission, or the same one opened anew, begins another history.

    A try gets further if it completes more lines of the checklist than all tries before it, or passes.
    """

    def __init__(self) -> None:
        self._mission, self._number = "", 0
        self._most, self._best = 0, 0
        self._is_over, self._has_passed = False, False

    @property
    def in_vain(self) -> int:
        """Tries that have ended since the one that got furthest."""
        begun = self._number - self._best
        return begun if self._is_over else max(begun - 1, 0)

    @property
    def is_stuck(self) -> bool:
        """Whether there are many of them, and the mission is not passed yet."""
        return not self._has_passed and self.in_vain >= MANY_TRIES

    def add(self, attempt: MissionTry) -> None:
        """The present try has changed."""
        if attempt.mission != self._mission or attempt.tries < self._number:
            self._mission, self._most, self._best, self._has_passed = attempt.mission, 0, 0, False
        self._number, self._is_over = attempt.tries, attempt.is_over
        self._has_passed = self._has_passed or attempt.has_passed
        if attempt.done > self._most:
            self._most, self._best = attempt.done, attempt.tries
