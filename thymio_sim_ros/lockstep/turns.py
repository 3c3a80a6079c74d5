"""Turns: the threads of a program, of which one runs at a time, and the simulated time that they wait for.

Each thread has a gate, a lock that it acquires in order to wait. The running thread passes its turn on in two steps: it
releases the gate of the next thread, then acquires its own. The next thread may return the turn between the two steps;
the gate is then open, and the second step does not block.
"""

from __future__ import annotations

import _thread
from collections.abc import Callable
from typing import Any

from thymio_sim_ros.lockstep import real_time

__all__ = ["Turns", "WaitingThread"]

FREE_POLLS = 100
"""Questions such as `time.time()` or `rclpy.ok()` that a thread may ask before time passes without a wait.

A loop such as `while time.time() < end: pass` only ends because time passes.
"""

POLL_NS = 1_000_000
"""Simulated time that each further question takes."""

FOREIGN_S = 0.001
"""Real time between two looks of a thread that Python's `threading` did not start."""

_allocate_lock = _thread.allocate_lock
"""The real function: `threads.install` replaces the one of the module, and the locks of this module must block."""


class WaitingThread:
    """A thread of the program. Invariant: it holds no place in the turn while `gate` is locked."""

    def __init__(self) -> None:
        self.gate: Any = _allocate_lock()
        self.gate.acquire()
        self.ident: int | None = None
        self.is_ready: Callable[[], bool] = _always
        self.deadline_ns: int | None = None
        self.waits_for = ""
        self.is_watching = False
        """Whether it waits for something outside of the simulation, which needs a look in each turn."""
        self.named = ""
        """What it waits for, in the words of the graph, while it is in a wait of the graph."""
        self.is_done = False
        self.is_interrupted = False
        self.polls = 0
        self.polled_ns = -1


class Turns:
    """The thread whose turn it is, and the time. Invariant: only the thread `running` executes code of the program."""

    def __init__(self, end_turn: Callable[[], None]) -> None:
        """`end_turn()` is called when all threads wait; it returns when the program has its next turn.

        It sets `now_ns` and `until_ns` by `begin`.
        """
        self._end_turn = end_turn
        self.now_ns = 0
        """Simulated time."""
        self.until_ns = 0
        """End of this turn: what waits for an earlier time runs in it."""
        self.on_time: Callable[[int], None] = _ignore
        """Called with the new simulated time when that passes."""
        self.main = WaitingThread()
        self.main.ident = _thread.get_ident()
        self.running = self.main
        self.threads = [self.main]
        self._waits_outside = 0
        """Number of waits on threads that have no turns."""

    # --- time ---

    def begin(self, now_ns: int, until_ns: int) -> None:
        """Begin a turn at `now_ns`."""
        self.until_ns = until_ns
        self._advance(now_ns)

    def _advance(self, now_ns: int) -> None:
        if now_ns > self.now_ns:
            self.now_ns = now_ns
            self.on_time(now_ns)

    @property
    def next_ns(self) -> int | None:
        """The next time at which a thread needs a turn, 0 for each turn; None if only a message can end all waits."""
        if self._waits_outside or any(thread.is_watching for thread in self.threads):
            return 0
        deadlines = [thread.deadline_ns for thread in self.threads if thread.deadline_ns is not None]
        return min(deadlines, default=None)

    # --- waits ---

    def wait(
        self,
        is_ready: Callable[[], bool],
        deadline_ns: int | None = None,
        what: str = "",
        *,
        is_watching: bool = False,
    ) -> bool:
        """Wait until `is_ready()` or until simulated time reaches the deadline; return whether it is ready.

        `is_ready` must not wait; `is_watching`: it depends on something outside of the simulation. Raises
        KeyboardInterrupt in the main thread if the program is interrupted.
        """
        if is_ready():
            return True
        own = self.running
        # A thread without the turn was not started by `threading`, such as a thread of a C library.
        if own.ident != _thread.get_ident():
            return self._wait_outside(is_ready, deadline_ns)
        own.is_ready, own.deadline_ns, own.is_watching = is_ready, deadline_ns, is_watching
        own.waits_for = own.named or what
        self._pass_on(own)
        own.is_ready, own.deadline_ns, own.waits_for, own.is_watching = _always, None, "", False
        if own.is_interrupted:
            own.is_interrupted = False
            raise KeyboardInterrupt
        return is_ready()

    def name_wait(self, what: str) -> None:
        """Name the next waits of the thread that calls this; "" ends that."""
        if self.running.ident == _thread.get_ident():
            self.running.named = what

    def sleep(self, duration_ns: int) -> None:
        """Wait for this much simulated time."""
        self.wait(_never, self.now_ns + max(duration_ns, 0), "time")

    def poll(self) -> None:
        """Count a question that does not wait: after `FREE_POLLS` without a wait, each takes `POLL_NS`."""
        own = self.running
        if own.ident != _thread.get_ident():
            return
        if own.polled_ns != self.now_ns:
            own.polled_ns, own.polls = self.now_ns, 0
        own.polls += 1
        if own.polls > FREE_POLLS:
            self.sleep(POLL_NS)
            own.polled_ns = self.now_ns  # `polls` is kept: a loop pays for each question from now on

    def _wait_outside(self, is_ready: Callable[[], bool], deadline_ns: int | None) -> bool:
        """Wait on a thread that has no turns, since something other than `threading` started it."""
        self._waits_outside += 1
        while not is_ready() and (deadline_ns is None or self.now_ns < deadline_ns):
            real_time.sleep(FOREIGN_S)
        self._waits_outside -= 1
        return is_ready()

    # --- threads ---

    def add(self) -> WaitingThread:
        """Add a thread, which gets its first turn at `enter`."""
        thread = WaitingThread()
        self.threads.append(thread)
        return thread

    def enter(self, thread: WaitingThread) -> None:
        """Begin a thread; called on itself."""
        thread.gate.acquire()
        thread.ident = _thread.get_ident()

    def leave(self, thread: WaitingThread) -> None:
        """End a thread; called on itself."""
        thread.is_done = True
        following = self._following(thread)
        self.threads.remove(thread)
        self._run(following)

    def keep_only_running(self) -> None:
        """Forget the other threads: a forked process has the one that forked only."""
        self.main = self.running
        self.threads = [self.running]

    def interrupt(self) -> None:
        """Make the main thread raise KeyboardInterrupt, as Ctrl-C does."""
        self.main.is_interrupted = True
        self.main.is_ready = _always

    def _pass_on(self, own: WaitingThread) -> None:
        following = self._following(own)
        if following is not own:
            self._run(following)
            own.gate.acquire()

    def _run(self, thread: WaitingThread) -> None:
        self.running = thread
        thread.gate.release()

    def _following(self, own: WaitingThread) -> WaitingThread:
        """The thread that runs next: the next one that is ready, else the one that waits for the earliest time."""
        # All decisions depend on the order in which threads were created and on simulated time only, so a run can be
        # repeated. The search begins behind `own`: each thread that is ready gets a turn before any gets a second one.
        while True:
            index = self.threads.index(own) + 1
            for thread in (*self.threads[index:], *self.threads[:index]):
                if not thread.is_done and thread.is_ready():
                    return thread
            waiting = [thread for thread in self.threads if not thread.is_done and thread.deadline_ns is not None]
            if waiting:
                first = min(waiting, key=_deadline_ns)
                if _deadline_ns(first) < self.until_ns:
                    self._advance(_deadline_ns(first))
                    return first
            # No thread can run before `until_ns`. Messages may arrive during the call, and time may pass: search again.
            self._end_turn()


def _deadline_ns(thread: WaitingThread) -> int:
    assert thread.deadline_ns is not None
    return thread.deadline_ns


def _always() -> bool:
    return True


def _never() -> bool:
    return False


def _ignore(_now_ns: int) -> None:
    pass
