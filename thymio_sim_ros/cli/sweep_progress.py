"""The progress of a sweep on stderr: one line that is rewritten on a terminal, otherwise a plain line now and then."""

from __future__ import annotations

import sys
import time

__all__ = ["SweepProgress", "duration_text", "progress_text"]

TERMINAL_S, PLAIN_S = 0.2, 30.0
"""Time between two lines on a terminal, and elsewhere."""


def progress_text(finished: int, total: int, failed: int, rate: float) -> str:
    """Return finished and failed runs, runs per second, and the time left if the rate is known (above 0)."""
    parts = [f"{finished} of {total} runs"]
    if failed:
        parts.append(f"{failed} with errors")
    if rate > 0:
        parts += [f"{rate:.3g} per second", f"{duration_text((total - finished) / rate)} left"]
    return ", ".join(parts)


def duration_text(seconds: float) -> str:
    """Return a duration in its two largest units, such as "2 h 5 min"."""
    whole = round(seconds)
    hours, minutes = divmod(whole // 60, 60)
    if hours:
        return f"{hours} h {minutes} min"
    return f"{minutes} min {whole % 60} s" if minutes else f"{whole} s"


class SweepProgress:
    """Shows how many of the runs are finished. `resumed` runs were finished before."""

    def __init__(self, total: int, resumed: int) -> None:
        self._total, self._resumed = total, resumed
        self._is_terminal = sys.stderr.isatty()
        self._begun_s = self._shown_s = time.monotonic()

    def show(self, finished: int, failed: int) -> None:
        """Show the state, if the last line is old enough."""
        now_s = time.monotonic()
        if now_s - self._shown_s >= (TERMINAL_S if self._is_terminal else PLAIN_S):
            self._shown_s = now_s
            rate = (finished - self._resumed) / (now_s - self._begun_s)
            self._print(progress_text(finished, self._total, failed, rate), end="" if self._is_terminal else "\n")

    def end(self, finished: int, failed: int) -> None:
        """Show the final state."""
        self._print(progress_text(finished, self._total, failed, 0.0), end="\n")

    def _print(self, text: str, *, end: str) -> None:
        before = "\r\x1b[K" if self._is_terminal else ""
        print(f"{before}thymio-sim: {text}", end=end, file=sys.stderr, flush=True)
