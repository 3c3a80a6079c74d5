"""Replaces locks and threads of Python's standard library: a thread that waits passes its turn on.

Conditions, events, semaphores, queues and pools of threads are made of locks in the standard library, so that their
waits and time-outs follow.
"""

from __future__ import annotations

import _thread
import queue
import threading
from typing import Any

from thymio_sim_ros.lockstep.turns import Turns, WaitingThread

__all__ = ["install", "join_all"]

SECOND_NS = 1_000_000_000


def install(turns: Turns) -> None:
    """Replace locks, threads and queues; modules imported from now on get them."""
    lock = _lock_class(turns)
    module: Any = threading
    module.Lock = module._allocate_lock = lock
    module._CRLock = None  # `RLock()` then makes one of `Lock`
    module._time = lambda: turns.now_ns / SECOND_NS
    _thread.allocate_lock = lock
    queue_module: Any = queue
    queue_module.SimpleQueue = queue_module._PySimpleQueue
    queue_module.time = module._time
    _install_threads(turns)


def _lock_class(turns: Turns) -> type:
    class Lock:
        """`threading.Lock` in simulated time.

        An attribute is enough: only one thread runs, and it passes its turn on in calls of `turns` only.
        """

        def __init__(self) -> None:
            self._is_locked = False

        def acquire(self, blocking: bool = True, timeout: float = -1) -> bool:
            if self._is_locked:
                if not blocking:
                    turns.poll()
                    return False
                deadline_ns = None if timeout < 0 else turns.now_ns + round(timeout * SECOND_NS)
                if not turns.wait(self._is_free, deadline_ns, "another thread"):
                    return False
            self._is_locked = True
            return True

        def release(self) -> None:
            if not self._is_locked:
                raise RuntimeError("release unlocked lock")
            self._is_locked = False

        def locked(self) -> bool:
            turns.poll()
            return self._is_locked

        def _is_free(self) -> bool:
            return not self._is_locked

        def _at_fork_reinit(self) -> None:
            self._is_locked = False

        def __enter__(self) -> bool:
            return self.acquire()

        def __exit__(self, *_error: object) -> None:
            self.release()

    return Lock


def _install_threads(turns: Turns) -> None:
    kind: Any = threading.Thread
    start, bootstrap = kind.start, kind._bootstrap

    def start_in_turns(self: Any) -> None:
        # Registered by the thread that starts it, whose turn it is: the new thread, which runs at once in real time,
        # would register at an arbitrary moment.
        self._turns_thread = turns.add() if not hasattr(self, "_turns_thread") else self._turns_thread
        start(self)

    def bootstrap_in_turns(self: Any) -> None:
        turns.enter(self._turns_thread)
        try:
            bootstrap(self)
        finally:
            turns.leave(self._turns_thread)

    def join(self: Any, timeout: float | None = None) -> None:
        if not hasattr(self, "_turns_thread"):
            raise RuntimeError("cannot join thread before it is started")
        if self is threading.current_thread():
            raise RuntimeError("cannot join current thread")
        thread: WaitingThread = self._turns_thread
        deadline_ns = None if timeout is None else turns.now_ns + max(round(timeout * SECOND_NS), 0)
        turns.wait(lambda: thread.is_done, deadline_ns, f"the end of {self.name}")

    def is_alive(self: Any) -> bool:
        turns.poll()
        thread = getattr(self, "_turns_thread", None)
        return self is threading.main_thread() if thread is None else not thread.is_done

    kind.start, kind._bootstrap, kind.join, kind.is_alive = start_in_turns, bootstrap_in_turns, join, is_alive


def join_all() -> None:
    """Wait for all threads but daemons, as Python does at the end of a program; pools of threads are ended."""
    for end in reversed(getattr(threading, "_threading_atexits", [])):
        end()
    for thread in threading.enumerate():
        if thread is not threading.main_thread() and not thread.daemon:
            thread.join()
