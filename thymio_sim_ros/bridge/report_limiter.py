"""Warnings of servers, each at most once a minute: any client can cause them, as often as it likes."""

from __future__ import annotations

import time
from collections.abc import Callable
from math import inf

__all__ = ["PERIOD_S", "ReportLimiter"]

PERIOD_S = 60.0
"""Shortest time between two warnings about the same subject."""
_MAX_SUBJECTS = 1000
"""Subjects that are remembered; limited, because some contain addresses of clients."""


class ReportLimiter:
    """Passes warnings on, at most one per subject in `PERIOD_S`. Not thread-safe."""

    def __init__(self, warn: Callable[[str], object], *, now_s: Callable[[], float] = time.monotonic) -> None:
        """`warn` takes the texts; `now_s` is a monotonic clock, s."""
        self._warn, self._now_s = warn, now_s
        self._reported_s: dict[str, float] = {}

    def __call__(self, about: str, text: str) -> None:
        """Report a text about a subject."""
        now_s = self._now_s()
        if now_s - self._reported_s.get(about, -inf) < PERIOD_S:
            return
        if about not in self._reported_s and len(self._reported_s) >= _MAX_SUBJECTS:
            self._reported_s.clear()
        self._reported_s[about] = now_s
        self._warn(text)
