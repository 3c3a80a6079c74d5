"""timer0 and timer1: `timer.period` in ms of simulated time (docs/spec/thymio-robot.md section 3).

Each timer counts milliseconds, fires when its count equals its period, and starts again from 0. A changed period
restarts the count; periods are read while no handler runs. The timers lag behind the clock until the machine can handle
their events, so that periods below the simulator's tick lose no event. A timer that fires several times while a handler
runs causes one event.
"""

from __future__ import annotations

from collections.abc import Sequence

from thymio_sim_ros.sim.model.clock import NEVER_NS

MILLISECOND_NS = 1_000_000

MAX_LAG_MS = 1000
"""Longest lag; after a longer jump of the clock each timer fires once for all of the time before."""


class Timers:
    """The timers of one machine.

    Invariants: the next firing of a running timer is later than the counted time, which is never ahead of the clock.
    """

    __slots__ = ("_at_ms", "_clock_ms", "_fires_ms", "_next_ms", "_periods")

    def __init__(self, count: int = 2) -> None:
        self._periods = [0] * count
        self._fires_ms = [0] * count
        """Time of the next firing of each timer, if it runs."""
        self._next_ms: int | None = None
        """The earliest of these times; None if no timer runs."""
        self._at_ms: int | None = None
        self._clock_ms = 0

    @property
    def lag_ms(self) -> int:
        """Milliseconds that have passed but are not counted yet."""
        return 0 if self._at_ms is None else self._clock_ms - self._at_ms

    @property
    def are_due(self) -> bool:
        """Whether a timer fires in the time that is not counted yet."""
        return self._next_ms is not None and self._next_ms <= self._clock_ms and self._at_ms is not None

    @property
    def next_ns(self) -> int:
        """Time of the next firing; NEVER_NS if no timer runs."""
        return NEVER_NS if self._next_ms is None else self._next_ms * MILLISECOND_NS

    def set_clock(self, now_ns: int) -> tuple[int, ...]:
        """Advance the clock; return the timers that fired before its previous time. A jump back restarts all timers."""
        now_ms = now_ns // MILLISECOND_NS
        if self._at_ms is None or now_ms < self._clock_ms:
            self._at_ms = self._clock_ms = now_ms
            self._fires_ms = [now_ms + period for period in self._periods]
            self._find_next()
            return ()
        if self._next_ms is None:
            self._at_ms = self._clock_ms = now_ms
            return ()
        missed = self._count(self._clock_ms - self._at_ms)
        self._clock_ms = now_ms
        early = self._count(max(0, self.lag_ms - MAX_LAG_MS))
        return tuple(sorted({*missed, *early})) if missed or early else ()

    def set_periods(self, periods: Sequence[int]) -> None:
        """Set the periods in ms; 0 or less stops a timer. A changed period restarts its timer."""
        if periods == self._periods:
            return
        for index, period in enumerate(periods):
            if period != self._periods[index]:
                self._periods[index], self._fires_ms[index] = period, (self._at_ms or 0) + period
        self._find_next()

    def next_firing(self) -> tuple[int, ...]:
        """Count up to the next firing and return its timers; count up to the clock and return () if that is earlier."""
        if self._next_ms is None or self._at_ms is None:
            return self._count(self.lag_ms)
        return self._count(min(self._next_ms, self._clock_ms) - self._at_ms)

    def reset(self) -> None:
        """Stop all timers; they count from the current time of the clock."""
        self._periods = [0] * len(self._periods)
        self._next_ms = None
        if self._at_ms is not None:
            self._at_ms = self._clock_ms

    def _count(self, milliseconds: int) -> tuple[int, ...]:
        """Count this many milliseconds; return the timers that fired."""
        if self._at_ms is None or milliseconds == 0:
            return ()
        at_ms = self._at_ms = self._at_ms + milliseconds
        if self._next_ms is None or at_ms < self._next_ms:
            return ()
        fired = []
        for index, period in enumerate(self._periods):
            if period > 0 and self._fires_ms[index] <= at_ms:
                late_ms = at_ms - self._fires_ms[index]
                self._fires_ms[index] += late_ms - late_ms % period + period
                fired.append(index)
        self._find_next()
        return tuple(fired)

    def _find_next(self) -> None:
        running = [fires_ms for fires_ms, period in zip(self._fires_ms, self._periods, strict=True) if period > 0]
        self._next_ms = min(running) if running else None
