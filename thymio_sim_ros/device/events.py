"""Events that wait for the machine, and the order in which it hears them (docs/spec/thymio-robot.md section 3).

As the firmware does: one flag for each local event, the lowest number first, nothing interrupts a handler; global
events wait in line. As the reference playground does: events come one by one as they happened, each ends the handler
that still runs. What is fed belongs to the present: timers that fired before come first.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from thymio_sim_ros.device.firmware.timers import Timers

__all__ = ["FIRMWARE", "MOST_WAITING", "POLICIES", "EventQueue", "GlobalEvent", "Policy"]

MOST_WAITING = 100
"""Global events that may wait for a machine, and local ones where each counts; more are lost."""


@dataclass(frozen=True, slots=True)
class Policy:
    """How local events meet: whether those that wait are one, whether they end a handler that runs.

    `turn`: instructions of a handler before something else may happen. `periods_ns`: sensors that are heard less often
    than they measure.
    """

    coalesces: bool
    kills: bool
    turn: int
    periods_ns: Mapping[str, int] = field(default_factory=dict)


FIRMWARE, PLAYGROUND = "firmware", "playground"
POLICIES: Mapping[str, Policy] = {
    FIRMWARE: Policy(coalesces=True, kills=False, turn=65535),
    PLAYGROUND: Policy(coalesces=False, kills=True, turn=1000, periods_ns={"buttons": 50_000_000}),
}
"""The robot, and the reference playground."""


@dataclass(frozen=True, slots=True)
class GlobalEvent:
    """An event from the network: number, sender, arguments."""

    number: int
    source: int
    args: tuple[int, ...]


class EventQueue:
    """What waits for one machine. Invariant: with a coalescing policy each local event waits at most once."""

    def __init__(self, policy: Policy, timer_events: Sequence[int]) -> None:
        """`timer_events`: indexes of the events of the two timers."""
        self.policy = policy
        self._timer_events = timer_events
        self._timers = Timers()
        self._pending: list[int] = []
        self._arrived: list[int] = []
        self._incoming: deque[GlobalEvent] = deque()

    @property
    def waits(self) -> bool:
        """Whether an event waits for the machine."""
        return bool(self._pending or self._arrived or self._incoming) or self._timers.are_due

    @property
    def has_incoming(self) -> bool:
        """Whether a global event waits."""
        return bool(self._incoming)

    def arrive(self, index: int) -> None:
        """A local event happened now."""
        self._add(self._arrived, index)

    def receive(self, event: GlobalEvent) -> bool:
        """A global event arrived; False when there is no more room."""
        if len(self._incoming) >= MOST_WAITING:
            return False
        self._incoming.append(event)
        return True

    def advance(self, now_ns: int) -> None:
        """Simulated time has come so far."""
        for timer in self._timers.set_clock(now_ns):
            self._add(self._pending, self._timer_events[timer])

    def notice(self, periods: Sequence[int]) -> None:
        """Take over changed periods of the timers; no handler may run."""
        self._timers.notice(periods)

    def take(self) -> int | GlobalEvent | None:
        """The next event, or None: time was counted to its end. What happens now comes after all timers before."""
        is_now = not self._timers.lag_ms
        if not self._pending and not is_now:
            fired = self._timers.next_firing()
            for timer in fired:
                self._add(self._pending, self._timer_events[timer])
            is_now = not fired
        if is_now and (self._arrived or self._incoming):
            for index in self._arrived:
                self._add(self._pending, index)
            self._arrived.clear()
            if self._incoming:
                return self._incoming.popleft()
        if not self._pending:
            return None
        index = min(self._pending) if self.policy.coalesces else self._pending[0]
        self._pending.remove(index)
        return index

    def take_incoming(self) -> GlobalEvent:
        """The next global event, before all others."""
        return self._incoming.popleft()

    def clear(self) -> None:
        """Forget all events that wait."""
        self._pending.clear()
        self._arrived.clear()
        self._incoming.clear()

    def reset(self) -> None:
        """Forget all events, stop all timers."""
        self.clear()
        self._timers.reset()

    def _add(self, events: list[int], index: int) -> None:
        is_flagged = self.policy.coalesces and index in events
        if not is_flagged and len(events) < MOST_WAITING:
            events.append(index)
