"""timer0 and timer1: `timer.period` in ms of simulated time (thymio-robot.md section 3)."""

from __future__ import annotations

MILLISECOND_NS = 1_000_000


class Timer:
    """One timer. Changing its period starts it anew; period 0 or less stops it."""

    def __init__(self) -> None:
        self._period_ms = 0
        self._started_ns = 0

    def elapsed(self, period_ms: int, now_ns: int) -> int:
        """How many periods ended since the last call; none is lost, also when time comes in large steps."""
        if period_ms != self._period_ms or now_ns < self._started_ns:
            self._period_ms, self._started_ns = period_ms, now_ns
            return 0
        if period_ms <= 0:
            return 0
        ended = (now_ns - self._started_ns) // (period_ms * MILLISECOND_NS)
        self._started_ns += ended * period_ms * MILLISECOND_NS
        return int(ended)

    def reset(self) -> None:
        """Forget the period, so that the next one starts anew."""
        self._period_ms = 0
