"""Pending events of a machine and their order (docs/spec/thymio-robot.md section 3).

Firmware policy: one flag per local event, the lowest number first; handlers are not interrupted; global events are
queued. Policy of the reference playground: events are handled in the order in which they occurred, and each one ends
the running handler. Readings belong to the current time, so earlier timer events are handled first.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from thymio_sim_ros.device.due_time import DueTime
from thymio_sim_ros.device.firmware.timers import Timers

__all__ = ["FIRMWARE", "MAX_PENDING", "POLICIES", "EventQueue", "GlobalEvent", "Policy"]

MAX_PENDING = 100
"""Limit of pending global events, and of pending local events without coalescing; further ones are dropped."""


@dataclass(frozen=True, slots=True)
class Policy:
    """Rules by which pending events are handled."""

    coalesces: bool
    """Whether several occurrences of a pending local event count as one."""
    interrupts: bool
    """Whether an event interrupts the running handler."""
    handler_budget: int
    """Instructions of a handler before a global event, or with `interrupts` the next robot, has its turn."""
    periods_ns: Mapping[str, int] = field(default_factory=dict)
    """Shortest time between two readings that reach the program, by sensor; the others are not limited."""


FIRMWARE, PLAYGROUND = "firmware", "playground"
POLICIES: Mapping[str, Policy] = {
    FIRMWARE: Policy(coalesces=True, interrupts=False, handler_budget=65535),
    PLAYGROUND: Policy(coalesces=False, interrupts=True, handler_budget=1000, periods_ns={"buttons": 50_000_000}),
}
"""The robot, and the reference playground."""


@dataclass(frozen=True, slots=True)
class GlobalEvent:
    """An event from the network: number, sender, arguments."""

    number: int
    source: int
    args: tuple[int, ...]


class EventQueue:
    """Pending events of one machine. Invariant: with a coalescing policy each local event is pending at most once."""

    def __init__(self, policy: Policy, timer_events: Sequence[int], due: DueTime) -> None:
        """`timer_events`: indexes of the events of the two timers. An added event makes `due` now."""
        self.policy = policy
        self._due = due
        self._timer_events = timer_events
        self._timers = Timers()
        self._pending: list[int] = []
        self._local_now: list[int] = []
        self._global: deque[GlobalEvent] = deque()

    @property
    def has_events(self) -> bool:
        """Whether an event is pending."""
        return bool(self._pending or self._local_now or self._global) or self._timers.are_due

    @property
    def has_global(self) -> bool:
        """Whether a global event is pending."""
        return bool(self._global)

    @property
    def next_timer_ns(self) -> int:
        """Time at which a timer fires next; NEVER_NS if none runs."""
        return self._timers.next_ns

    def is_timer(self, index: int) -> bool:
        """Whether a local event is that of a timer."""
        return index in self._timer_events

    def add_local(self, index: int) -> None:
        """Add a local event that occurs now."""
        self._add(self._local_now, index)
        self._due.set_now()

    def add_global(self, event: GlobalEvent) -> bool:
        """Add a global event; return False if the queue is full."""
        if len(self._global) >= MAX_PENDING:
            return False
        self._global.append(event)
        self._due.set_now()
        return True

    def advance(self, now_ns: int) -> None:
        """Advance simulated time."""
        for timer in self._timers.set_clock(now_ns):
            self._add(self._pending, self._timer_events[timer])

    def set_timer_periods(self, periods: Sequence[int]) -> None:
        """Set the periods of the timers; only allowed while no handler runs."""
        self._timers.set_periods(periods)

    def pop(self) -> int | GlobalEvent | None:
        """Remove and return the next event, or None. Events of the current time follow all earlier timer events."""
        is_now = not self._timers.lag_ms
        if not self._pending and not is_now:
            fired = self._timers.next_firing()
            for timer in fired:
                self._add(self._pending, self._timer_events[timer])
            is_now = not fired
        if is_now and (self._local_now or self._global):
            for index in self._local_now:
                self._add(self._pending, index)
            self._local_now.clear()
            if self._global:
                return self._global.popleft()
        if not self._pending:
            return None
        index = min(self._pending) if self.policy.coalesces else self._pending[0]
        self._pending.remove(index)
        return index

    def pop_global(self) -> GlobalEvent:
        """Remove and return the next global event, ahead of all others."""
        return self._global.popleft()

    def clear(self) -> None:
        """Drop all pending events."""
        self._pending.clear()
        self._local_now.clear()
        self._global.clear()

    def reset(self) -> None:
        """Drop all pending events and stop all timers."""
        self.clear()
        self._timers.reset()

    def _add(self, events: list[int], index: int) -> None:
        is_flagged = self.policy.coalesces and index in events
        if not is_flagged and len(events) < MAX_PENDING:
            events.append(index)
