"""Contains code under test: whatever it does ends in a failure of its test, and the next tests run.

Constructors and callbacks run in the main thread of the test, in which messages and simulated time also pass. Hence a
wait in them never ends, an exception such as KeyboardInterrupt would end pytest, and a loop would use the processor for
ever. A thread looks at the main thread a few times a second. It counts how often the main thread sleeps in the same
piece of code under test, and then interrupts it by a signal, whose handler raises the failure. Counting makes no
difference between a slow and a fast machine: a thread that waits for a processor does not sleep.

The failure has a base that `except Exception` does not catch. Code that catches it nevertheless gets it again, and from
then on at each of its lines, so that `while True: try: … except: pass` ends, too.
"""

from __future__ import annotations

import contextlib
import os
import signal
import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from types import FrameType
from typing import Any

import pytest

from thymio_sim_ros.grading.sandbox.thread_states import is_sleeping, is_working
from thymio_sim_ros.testing.ros.cpu_limit import limited
from thymio_sim_ros.testing.ros.forbidden_waits import WAIT_LIMIT_S, waiting_forbidden
from thymio_sim_ros.testing.ros.interruption import insist, place
from thymio_sim_ros.testing.ros.student_errors import INSTEAD, StudentError

__all__ = ["Containment"]

_BUSY_LIMIT_S = 60.0
"""Longest wait while other threads work, in s."""

_LOOK_S = 0.1
"""Time between two looks at the main thread, in s; what it counts is the number of looks."""

_AGAIN_S = 0.5
"""Time after which code that has caught the failure gets it again, in s."""

_SIGNAL = getattr(signal, "SIGVTALRM", None)
"""The signal that interrupts waits; Python's timers and pytest's plug-ins do not use it. Windows lacks it."""


class _Stopped(BaseException):
    """Leaves code under test; `contain` makes a StudentError of it."""


@dataclass(slots=True)
class _Section:
    """A piece of code under test that runs now: one constructor, or one call of a callback."""

    what: Callable[[], str]
    stops: int = 0
    """Number of interruptions."""


class Containment:
    """Contains all code under test of one test; `close` ends its thread. Only in the main thread it limits waits."""

    def __init__(self, *, wait_limit_s: float = WAIT_LIMIT_S) -> None:
        self._wait_limit_s = wait_limit_s
        self._section: _Section | None = None
        self._is_interrupted = False
        self._ended = threading.Event()
        self._thread: threading.Thread | None = None
        self._handlers: dict[int, tuple[Any, Any]] = {}
        """Our handlers of signals, and those before them."""
        self._main = threading.main_thread()
        if threading.current_thread() is not self._main:
            return
        if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
            self._handle(signal.SIGINT, self._on_interrupt)
        if _SIGNAL is not None:
            self._handle(_SIGNAL, self._on_blocked)
            self._thread = threading.Thread(target=self._watch, name="containment", daemon=True)
            self._thread.start()

    def close(self) -> None:
        """End the thread and restore the handlers of signals."""
        self._ended.set()
        if self._thread is not None:
            self._thread.join()
        for number, (ours, before) in self._handlers.items():
            if signal.getsignal(number) is ours:
                signal.signal(number, before)

    @contextlib.contextmanager
    def contain(self, what: Callable[[], str], cpu_limit_s: float) -> Iterator[None]:
        """Run code under test; `what()` names it.

        Raises StudentError for a wait and for an exception that would end pytest or change the outcome of the test, and
        fails the test if the code uses more than `cpu_limit_s` of processor time. Other exceptions pass.
        """
        try:
            with waiting_forbidden(), limited(what, cpu_limit_s):
                outer, self._section = self._section, _Section(what)
                try:
                    yield
                finally:
                    self._section = outer
        except _Stopped as stopped:
            raise StudentError(str(stopped)) from None
        except pytest.exit.Exception as error:
            raise _ended(what(), error) from error
        except (Exception, pytest.fail.Exception):
            raise
        except BaseException as error:
            if isinstance(error, KeyboardInterrupt) and self._is_interrupted:
                raise
            raise _ended(what(), error) from error

    # --- signals, in the main thread ---

    def _handle(self, number: int, handler: Callable[[int, FrameType | None], None]) -> None:
        self._handlers[number] = (handler, signal.signal(number, handler))

    def _on_interrupt(self, number: int, frame: FrameType | None) -> None:
        """Remember that Ctrl-C was pressed: that KeyboardInterrupt is not raised by code under test."""
        self._is_interrupted = True
        signal.default_int_handler(number, frame)

    def _on_blocked(self, _number: int, frame: FrameType | None) -> None:
        section = self._section
        if section is None:  # it has just ended
            return
        stopped = _Stopped(f"{section.what()} waits and does not return{place(frame)}\n  {INSTEAD}")
        if section.stops:
            insist(stopped, frame)
        section.stops += 1
        raise stopped

    # --- the thread ---

    def _watch(self) -> None:
        """Count the looks at which the main thread sleeps in the same code under test."""
        assert _SIGNAL is not None
        assert self._main.ident is not None
        assert self._main.native_id is not None
        seen: _Section | None = None
        slept_s = 0.0
        while not self._ended.wait(_LOOK_S):
            section = self._section
            if section is None or section is not seen:
                seen, slept_s = section, 0.0
            elif is_sleeping(self._main.native_id):
                is_busy = is_working(os.getpid(), without=threading.get_native_id())
                slept_s += _LOOK_S * (self._wait_limit_s / _BUSY_LIMIT_S if is_busy else 1.0)
                if slept_s >= self._wait_limit_s:
                    slept_s = self._wait_limit_s - _AGAIN_S
                    signal.pthread_kill(self._main.ident, _SIGNAL)


def _ended(what: str, error: BaseException) -> StudentError:
    """The failure for an exception that would end pytest, or change the outcome of the test."""
    innermost = error.__traceback__
    while innermost is not None and innermost.tb_next is not None:
        innermost = innermost.tb_next
    where = place(innermost.tb_frame) if innermost is not None else ""
    raised = f"{type(error).__name__}: {error}".removesuffix(": ")
    return StudentError(
        f"{what} raised {raised}{where}\n  expected: a node runs until the test ends; exit() and KeyboardInterrupt"
        " belong to main()"
    )
