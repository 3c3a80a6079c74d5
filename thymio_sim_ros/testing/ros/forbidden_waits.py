"""Refuses waits in constructors and callbacks under test that cannot end.

Messages come and simulated time passes only when the callback has returned. The embedded graph reports
each wait that begins. With an installed ROS, functions of rclpy are replaced meanwhile: its middleware and its clocks
ignore signals, so that a wait must not begin. `Containment` interrupts all other waits.
"""

from __future__ import annotations

import builtins
import contextlib
import os
import threading
from collections.abc import Iterator
from typing import Any

from thymio_sim_ros.portable_ros.graph import waits
from thymio_sim_ros.portable_ros.import_hook import is_served
from thymio_sim_ros.testing.ros.student_errors import never_ends

__all__ = ["WAIT_LIMIT_S", "waiting_forbidden"]

WAIT_LIMIT_S = 4.0
"""Longest wait in a constructor or callback, in s."""

_IS_EMBEDDED = is_served("rclpy")


@contextlib.contextmanager
def waiting_forbidden() -> Iterator[None]:
    """Raise StudentError if this thread begins a wait of rclpy that cannot end, or `input()`.

    `os._exit` raises SystemExit in this thread: it would end pytest without a trace.
    """
    here, process = threading.get_ident(), os.getpid()
    read, real_exit = builtins.input, os._exit

    def ask(*args: Any) -> str:
        if threading.get_ident() == here:
            raise never_ends("input()")
        return read(*args)

    def leave(status: int) -> None:
        if threading.get_ident() == here and os.getpid() == process:  # children that were forked leave this way
            raise SystemExit(status)
        real_exit(status)

    with _replaced([(builtins, "input", ask), (os, "_exit", leave)]), _graph_watched(here):
        yield


@contextlib.contextmanager
def _graph_watched(here: int) -> Iterator[None]:
    if not _IS_EMBEDDED:
        from thymio_sim_ros.testing.ros.installed_waits import checks

        with _replaced(checks(here, WAIT_LIMIT_S)):
            yield
        return
    before = waits.watch(_Refusing(here))
    try:
        yield
    finally:
        waits.watch(before)


class _Refusing:
    """Refuses long waits of one thread."""

    def __init__(self, thread: int) -> None:
        self._thread = thread

    def begin(self, wait: waits.Wait) -> None:
        """Raise StudentError for a wait that is longer than `WAIT_LIMIT_S`."""
        is_long = wait.timeout_s is None or wait.timeout_s > WAIT_LIMIT_S
        if is_long and threading.get_ident() == self._thread:
            raise never_ends(f"a wait for {wait.what}")

    def end(self, wait: waits.Wait) -> None:
        """Need nothing."""


@contextlib.contextmanager
def _replaced(attributes: list[tuple[Any, str, Any]]) -> Iterator[None]:
    """Replace attributes inside the block: of an object, by name, by a value."""
    before = [(owner, name, getattr(owner, name)) for owner, name, _ in attributes]
    for owner, name, value in attributes:
        setattr(owner, name, value)
    try:
        yield
    finally:
        for owner, name, value in before:
            setattr(owner, name, value)
