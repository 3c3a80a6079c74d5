"""timer0 and timer1: `timer.period` in ms of simulated time (thymio-robot.md section 3).

Each counts milliseconds, fires when its count equals its period, and counts from 0 again. A changed period starts the
count again and is noticed when no handler runs. The timers lag behind the clock until the machine is free to hear
them, so that a period below the simulator's tick loses nothing; what fires while a handler runs is heard once.
"""

from __future__ import annotations

from collections.abc import Sequence

MILLISECOND_NS = 1_000_000

LONGEST_LAG_MS = 1000
"""After a longer jump of the clock each timer fires once for all that lies before."""


class Timers:
    """Invariant: a running timer's count is below its period; the timers are never ahead of the clock."""

    def __init__(self, count: int = 2) -> None:
        self._periods = [0] * count
        self._counts = [0] * count
        self._at_ms: int | None = None
        self._clock_ms = 0

    @property
    def lag_ms(self) -> int:
        """Milliseconds that have passed and are not counted yet."""
        return 0 if self._at_ms is None else self._clock_ms - self._at_ms

    def set_clock(self, now_ns: int) -> tuple[int, ...]:
        """Show the clock; returns timers that fired before the last look, unheard. Time that goes back: start anew."""
        now_ms = now_ns // MILLISECOND_NS
        if self._at_ms is None or now_ms < self._clock_ms:
            self._at_ms = self._clock_ms = now_ms
            self._counts = [0] * len(self._counts)
            return ()
        if max(self._periods) <= 0:  # no timer runs: nothing to count
            self._at_ms = self._clock_ms = now_ms
            return ()
        missed = self._count(self.lag_ms)
        self._clock_ms = now_ms
        early = self._count(max(0, self.lag_ms - LONGEST_LAG_MS))
        return tuple(sorted({*missed, *early}))

    def notice(self, periods: Sequence[int]) -> None:
        """Take over changed periods in ms; one of 0 or less stops its timer."""
        for index, period in enumerate(periods):
            if period != self._periods[index]:
                self._periods[index], self._counts[index] = period, 0

    def next_firing(self) -> tuple[int, ...]:
        """Count on to the next moment at which timers fire and return them; () when the clock comes first."""
        left = [period - count for period, count in zip(self._periods, self._counts, strict=True) if period > 0]
        return self._count(min([*left, self.lag_ms]))

    def reset(self) -> None:
        """Stop all timers and forget the clock."""
        count = len(self._periods)
        self._periods, self._counts = [0] * count, [0] * count
        self._at_ms = None

    def _count(self, milliseconds: int) -> tuple[int, ...]:
        """Count on; the timers that fired meanwhile."""
        if self._at_ms is None or milliseconds == 0:
            return ()
        self._at_ms += milliseconds
        fired = []
        for index, period in enumerate(self._periods):
            if period > 0:
                rounds, self._counts[index] = divmod(self._counts[index] + milliseconds, period)
                if rounds:
                    fired.append(index)
        return tuple(fired)
