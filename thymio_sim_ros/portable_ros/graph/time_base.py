"""The time of this process: what clocks show and waits measure. It is that of the system unless a test owns it."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Protocol

__all__ = ["TimeOwner", "give_to", "note_query", "own_query", "simulated_ns", "steady_ns", "system_ns"]


class TimeOwner(Protocol):
    """Owns the time of a process. All times are in ns."""

    def system_ns(self) -> int:
        """Time since 1970."""

    def steady_ns(self) -> int:
        """Time of a clock that is never set."""

    def simulated_ns(self) -> int:
        """Simulated time, which passes without messages on `/clock`."""

    def note_query(self) -> None:
        """Note that the program asks for the time or for a state, which it may do in a loop without a wait."""


_owner: TimeOwner | None = None
_is_own_query = False


def give_to(owner: TimeOwner) -> None:
    """Make an owner decide on the time of this process, to its end."""
    global _owner
    _owner = owner


def system_ns() -> int:
    """Time since 1970."""
    return time.time_ns() if _owner is None else _owner.system_ns()


def steady_ns() -> int:
    """Time of a clock that is never set."""
    return time.monotonic_ns() if _owner is None else _owner.steady_ns()


def simulated_ns() -> int | None:
    """Simulated time if there is an owner; None: only `/clock` has it."""
    return None if _owner is None else _owner.simulated_ns()


def note_query() -> None:
    """Note that the program asks for the time or for a state."""
    if _owner is not None and not _is_own_query:
        _owner.note_query()


def own_query(query: Callable[[], bool]) -> bool:
    """The answer to a query of the graph itself, which is not one of the program: it may hold locks."""
    global _is_own_query
    _is_own_query = True
    try:
        return query()
    finally:
        _is_own_query = False
