"""How often messages arrive, and how many bytes they have."""

from __future__ import annotations

import statistics
import time
from collections import deque
from collections.abc import Callable
from itertools import pairwise

__all__ = ["EVERY_S", "Measure", "Window", "bandwidth", "rate"]

EVERY_S = 1.0
"""Time between two lines."""
_UNITS = ((1_000_000, "MB"), (1_000, "KB"))


class Window:
    """Arrival and size of the last messages."""

    def __init__(self, most: int, now_s: Callable[[], float] = time.monotonic) -> None:
        """`most` messages are kept; `now_s` is a monotonic clock, s."""
        self.now_s = now_s
        self.arrivals: deque[tuple[float, int]] = deque(maxlen=most)
        self._is_new = False

    def add(self, size: int) -> None:
        """Note a message of some bytes that arrives now."""
        self.arrivals.append((self.now_s(), size))
        self._is_new = True

    @property
    def is_new(self) -> bool:
        """Whether there are two messages at least, and one since the last call."""
        is_new, self._is_new = self._is_new and len(self.arrivals) > 1, False
        return is_new


Measure = Callable[[Window], str]


def rate(window: Window) -> str:
    """Messages per second, with the shortest, longest and typical time between two."""
    times = [when for when, _ in window.arrivals]
    gaps = [later - earlier for earlier, later in pairwise(times)]
    mean = max(statistics.fmean(gaps), 1e-9)
    return (
        f"average rate: {1.0 / mean:.3f}\n\tmin: {min(gaps):.3f}s max: {max(gaps):.3f}s"
        f" std dev: {statistics.pstdev(gaps):.5f}s window: {len(times)}"
    )


def bandwidth(window: Window) -> str:
    """Bytes per second, with the smallest, largest and mean message."""
    sizes = [size for _, size in window.arrivals]
    seconds = max(window.now_s() - window.arrivals[0][0], 1e-9)
    mean, least, most = (_bytes(value) for value in (statistics.fmean(sizes), min(sizes), max(sizes)))
    return (
        f"{_bytes(sum(sizes) / seconds)}/s from {len(sizes)} messages\n"
        f"\tMessage size mean: {mean} min: {least} max: {most}"
    )


def _bytes(value: float) -> str:
    factor, unit = next(((factor, unit) for factor, unit in _UNITS if value >= factor), (1_000, "KB"))
    return f"{value / factor:.2f} {unit}" if value >= 100 else f"{value:.0f} B"
