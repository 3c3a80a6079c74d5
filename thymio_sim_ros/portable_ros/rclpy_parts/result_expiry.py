"""How long a server of an action keeps the results of its goals."""

from __future__ import annotations

import threading
from collections.abc import Callable

from thymio_sim_ros.portable_ros.rclpy.clock import Clock
from thymio_sim_ros.portable_ros.rclpy.constants import S_TO_NS
from thymio_sim_ros.portable_ros.rclpy.timer import Timer

__all__ = ["ResultExpiry"]


class ResultExpiry:
    """Calls back with the ids of goals, a time after each has ended."""

    def __init__(
        self,
        make_timer: Callable[[Callable[[], None]], Timer],
        clock: Clock,
        timeout_s: float,
        forget: Callable[[bytes], None],
        lock: threading.RLock,
    ) -> None:
        """`lock`: guards the goals. Raises ValueError for a negative time."""
        if timeout_s < 0:
            raise ValueError("Failed to create action server: timer period must be non-negative")
        self._clock, self._timeout_ns, self._forget = clock, int(timeout_s * S_TO_NS), forget
        self._lock = lock
        self._due_ns: dict[bytes, int] = {}
        self._timer = make_timer(self._expire)

    def start(self, goal_id: bytes) -> None:
        """Keep the result of a goal that has ended now."""
        with self._lock:
            self._due_ns[goal_id] = self._clock.now().nanoseconds + self._timeout_ns
            if self._timer.is_canceled():
                self._plan()

    def _expire(self) -> None:
        with self._lock:
            self._timer.cancel()
            now_ns = self._clock.now().nanoseconds
            for goal_id in [one for one, due_ns in self._due_ns.items() if due_ns <= now_ns]:
                del self._due_ns[goal_id]
                self._forget(goal_id)
            self._plan()

    def _plan(self) -> None:
        """Call back when the next result is due."""
        if self._due_ns:
            self._timer.timer_period_ns = max(0, min(self._due_ns.values()) - self._clock.now().nanoseconds)
            self._timer.reset()
