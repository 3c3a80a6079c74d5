"""Real time, taken before `clocks` replaces the functions of `time`: for waits on the other process only."""

from __future__ import annotations

from collections.abc import Callable
from time import monotonic, sleep

from thymio_sim_ros.errors import ThymioSimError

__all__ = ["LAST_RESORT_S", "NotAnsweredError", "monotonic", "sleep", "wait_for"]

LAST_RESORT_S = 120.0
"""Longest wait for DDS or for the other process, in s of real time; only something broken takes so long."""

_PAUSE_S = 0.0002


class NotAnsweredError(ThymioSimError):
    """DDS or the other process does not answer."""


def wait_for(condition: Callable[[], object], what: str) -> None:
    """Wait until the condition is true. Raises NotAnsweredError after `LAST_RESORT_S`."""
    deadline = monotonic() + LAST_RESORT_S
    while not condition():
        if monotonic() > deadline:
            raise NotAnsweredError(f"waited {LAST_RESORT_S:g} s of real time for {what}")
        sleep(_PAUSE_S)
