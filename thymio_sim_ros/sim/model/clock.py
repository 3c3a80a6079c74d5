"""Time: the world's own clock, the schedule of its sensors, and the one meeting with wall time.

All times are integer nanoseconds. Simulated time is a count of ticks; `Pacer` alone sees readings of a
wall clock, which its caller takes (docs/architecture.md, "Time").
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Sequence

__all__ = ["NEVER_NS", "TICK_NS", "Pacer", "Schedule", "SimClock", "next_due_ns"]

TICK_NS = 10_000_000
"""One step of the world: 10 ms, the fastest event of the robot (docs/spec/thymio-robot.md section 3)."""

NEVER_NS = 1 << 62
"""A time that never comes."""

_SECOND_NS = 1_000_000_000
_CYCLE_TICKS = _SECOND_NS // TICK_NS
"""After so many ticks all periods that divide a second begin anew."""


class SimClock:
    """Simulated time. Invariant: `now_ns` is a whole number of ticks."""

    __slots__ = ("now_ns",)

    def __init__(self) -> None:
        self.now_ns = 0

    def advance(self) -> int:
        """Advance by one tick; returns the new time in ns."""
        self.now_ns += TICK_NS
        return self.now_ns


class Schedule:
    """When things happen again and again: each every period, at the first tick not before each multiple of it.

    Right for any period; each thing's first time is its phase, or one period when that is 0. Invariant: it is asked for
    every tick in turn.
    """

    __slots__ = ("_cycle", "_next_ns", "_odd_ns", "_periods_ns", "_selected", "_selected_cycle")

    def __init__(self, periods_and_phases_ns: Iterable[tuple[int, int]]) -> None:
        cycle: list[set[int]] = [set() for _ in range(_CYCLE_TICKS)]
        self._periods_ns: dict[int, int] = {}
        """Periods that do not fit into the cycle, by number."""
        self._next_ns: dict[int, int] = {}
        for number, (period_ns, phase_ns) in enumerate(periods_and_phases_ns):
            first_ns = phase_ns or period_ns
            if _CYCLE_TICKS * TICK_NS % period_ns == 0 and first_ns <= period_ns:
                for time_ns in range(first_ns, first_ns + _CYCLE_TICKS * TICK_NS, period_ns):
                    cycle[-(-time_ns // TICK_NS) % _CYCLE_TICKS].add(number)
            else:
                self._periods_ns[number], self._next_ns[number] = period_ns, first_ns
        self._cycle = self._selected_cycle = [sorted(due) for due in cycle]
        self._selected: Collection[int] | None = None
        self._odd_ns = min(self._next_ns.values(), default=NEVER_NS)
        """When the next thing happens that does not fit."""

    def select(self, numbers: Collection[int] | None) -> None:
        """Let `due` return these numbers only; None: all."""
        self._selected = numbers
        self._selected_cycle = self._cycle
        if numbers is not None:
            self._selected_cycle = [[number for number in due if number in numbers] for due in self._cycle]

    def due(self, now_ns: int) -> Sequence[int]:
        """The numbers of the items that are due in the tick that ends now, in order."""
        due = self._selected_cycle[now_ns // TICK_NS % _CYCLE_TICKS]
        if now_ns < self._odd_ns:
            return due
        odd = [number for number, next_ns in self._next_ns.items() if next_ns <= now_ns]
        for number in odd:
            self._next_ns[number] += self._periods_ns[number]
        self._odd_ns = min(self._next_ns.values())
        if self._selected is not None:
            odd = [number for number in odd if number in self._selected]
        return sorted([*due, *odd])


def next_due_ns(period_ns: int, phase_ns: int, now_ns: int) -> int:
    """The time of the first tick after this one in which a `Schedule` has something due."""
    first_ns = phase_ns or period_ns
    periods = max(0, (now_ns - first_ns) // period_ns + 1)
    return -(-(first_ns + periods * period_ns) // TICK_NS) * TICK_NS


class Pacer:
    """Computes from wall time how many ticks are owed. Invariant: never owes more than `max_batch` ticks at once.

    `real_time_factor` is simulated time divided by wall time; 0 means as fast as possible, in batches. Ticks that
    cannot be caught up are dropped and counted; `achieved` is the factor over about the last second. Raises ValueError
    for a factor that is negative or not finite.
    """

    def __init__(self, real_time_factor: float, *, max_batch: int = 10) -> None:
        if not 0.0 <= real_time_factor < float("inf"):
            raise ValueError(f"real-time factor: found {real_time_factor}, expected a number of at least 0")
        self.achieved = 0.0
        self.dropped_ticks = 0
        self._factor = real_time_factor
        self._max_batch = max(max_batch, 2 * int(real_time_factor))
        self._tick_wall_ns = TICK_NS / real_time_factor if real_time_factor else 0.0
        self._next_due_ns: float | None = None
        self._window_start_ns = 0
        self._window_ticks = 0

    def owed(self, monotonic_ns: int) -> int:
        """The number of ticks to do now, given a monotonic wall time in ns."""
        if self._next_due_ns is None:
            self._next_due_ns = monotonic_ns + self._tick_wall_ns
            self._window_start_ns = monotonic_ns
            return 0 if self._factor else self._grant(self._max_batch)
        if not self._factor:
            self._measure(monotonic_ns)
            return self._grant(self._max_batch)
        late_ns = monotonic_ns - self._next_due_ns
        ticks = int(late_ns // self._tick_wall_ns) + 1 if late_ns >= 0 else 0
        self._next_due_ns += ticks * self._tick_wall_ns
        if ticks > self._max_batch:
            self.dropped_ticks += ticks - self._max_batch
            ticks = self._max_batch
        self._measure(monotonic_ns)
        return self._grant(ticks)

    def drop(self, ticks: int) -> None:
        """Take back ticks that were owed and are not done."""
        self.dropped_ticks += ticks
        self._window_ticks -= ticks

    def wait_ns(self, monotonic_ns: int, ticks: int = 1) -> int:
        """The wall time in ns until this number of ticks is due; 0 if they are owed already."""
        if self._next_due_ns is None or not self._factor:
            return 0
        return max(0, int(self._next_due_ns + (ticks - 1) * self._tick_wall_ns - monotonic_ns) + 1)

    def ticks_until(self, monotonic_ns: int) -> int:
        """The number of ticks, at least one, to the first one that is not due before this wall time."""
        if self._next_due_ns is None or not self._factor:
            return 1
        return max(1, math.ceil((monotonic_ns - self._next_due_ns) / self._tick_wall_ns) + 1)

    def _grant(self, ticks: int) -> int:
        self._window_ticks += ticks
        return ticks

    def _measure(self, monotonic_ns: int) -> None:
        elapsed_ns = monotonic_ns - self._window_start_ns
        if elapsed_ns >= _SECOND_NS or (self.achieved == 0.0 and elapsed_ns >= _SECOND_NS // 10):
            self.achieved = self._window_ticks * TICK_NS / elapsed_ns
            self._window_start_ns = monotonic_ns
            self._window_ticks = 0
