"""Time-outs of waits that have several steps."""

from __future__ import annotations

from thymio_sim_ros.portable_ros.graph.time_base import steady_ns

__all__ = ["Deadline"]


class Deadline:
    """The end of a time-out that begins now."""

    def __init__(self, timeout_s: float | None) -> None:
        """`timeout_s`: in s of the monotonic clock; None and negative numbers stand for a wait without end."""
        self._end_s = None if timeout_s is None or timeout_s < 0 else _steady_s() + timeout_s

    def left_s(self) -> float | None:
        """The seconds that are left, at least 0; None without an end."""
        return None if self._end_s is None else max(0.0, self._end_s - _steady_s())

    def is_over(self) -> bool:
        """Whether no time is left."""
        return self.left_s() == 0


def _steady_s() -> float:
    return steady_ns() / 1e9
