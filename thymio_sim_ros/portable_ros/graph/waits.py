"""The waits of the graph, by name: a test of a program sees what it waits for, and that the wait cannot end."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Protocol

__all__ = ["Wait", "Watcher", "named", "watch"]


@dataclass(frozen=True, slots=True)
class Wait:
    """A call of a program that blocks its thread."""

    what: str
    """What it waits for, such as `the response of /add_two_ints`."""
    timeout_s: float | None
    """In s; None for a wait without limit."""
    is_deadlock: bool = False
    """Whether only a callback can end it that this wait keeps from being run."""

    def __str__(self) -> str:
        if not self.is_deadlock:
            return self.what
        return f"{self.what} (deadlock: a callback waits here, and its executor cannot run the one that ends the wait)"


class Watcher(Protocol):
    """Gets to know all waits of the process, on the threads that wait."""

    def begin(self, wait: Wait) -> None:
        """Note a wait that begins; an exception refuses it."""

    def end(self, wait: Wait) -> None:
        """Note the end of a wait."""


_watcher: Watcher | None = None


def watch(watcher: Watcher | None) -> Watcher | None:
    """Tell a watcher about all waits from now on, or about none; return the one before."""
    global _watcher
    before, _watcher = _watcher, watcher
    return before


@contextmanager
def named(what: str, timeout_s: float | None, *, is_deadlock: bool = False) -> Iterator[None]:
    """Name the wait inside the block; negative time-outs stand for a wait without limit."""
    if (watcher := _watcher) is None:
        yield
        return
    wait = Wait(what, None if timeout_s is None or timeout_s < 0 else timeout_s, is_deadlock)
    watcher.begin(wait)
    try:
        yield
    finally:
        watcher.end(wait)
