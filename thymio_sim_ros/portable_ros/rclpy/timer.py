"""Timers, which call back periodically, and rates, which sleep periodically."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from thymio_sim_ros.portable_ros.graph import waits
from thymio_sim_ros.portable_ros.graph.entity import Entity
from thymio_sim_ros.portable_ros.rclpy._rclpy_pybind11 import InvalidHandle, RCLError
from thymio_sim_ros.portable_ros.rclpy.exceptions import ROSInterruptException

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.rclpy.callback_groups import CallbackGroup
    from thymio_sim_ros.portable_ros.rclpy.clock import Clock
    from thymio_sim_ros.portable_ros.rclpy.context import Context

__all__ = ["Rate", "Timer"]


class Timer(Entity):
    """Calls its callback each period of its clock. Calls that are missed are left out."""

    def __init__(
        self,
        callback: Callable[[], Any] | None,
        callback_group: CallbackGroup | None,
        timer_period_ns: int,
        clock: Clock,
        *,
        context: Context | None = None,
        autostart: bool = True,
    ) -> None:
        """Raises RCLError for a negative period."""
        if timer_period_ns < 0:
            raise RCLError("failed to create timer: timer period must be non-negative")
        super().__init__(callback_group)
        self.callback = callback
        self._clock = clock
        self._period_ns = int(timer_period_ns)
        self._last_ns = clock._now_ns()
        self._next_ns = self._last_ns + self._period_ns
        self._is_canceled = not autostart
        self._is_announced = False
        """Whether the executor has been notified since the last call."""
        clock.notice(self)

    @property
    def clock(self) -> Clock:
        """The clock."""
        return self._clock

    @property
    def timer_period_ns(self) -> int:
        """The period."""
        with self._handle:
            return self._period_ns

    @timer_period_ns.setter
    def timer_period_ns(self, value: int) -> None:
        with self._handle:
            self._period_ns = int(value)

    def is_ready(self) -> bool:
        """Whether a call is due."""
        with self._handle:
            return not self._is_canceled and self._next_ns <= self._clock._now_ns()

    def is_canceled(self) -> bool:
        """Whether there are no more calls."""
        with self._handle:
            return self._is_canceled

    def cancel(self) -> None:
        """Call no more."""
        with self._handle:
            self._is_canceled = True

    def reset(self) -> None:
        """Start a period now, also after `cancel`."""
        with self._handle:
            self._next_ns = self._clock._now_ns() + self._period_ns
            self._is_canceled = False
        self._wake()

    def time_since_last_call(self) -> int:
        """Nanoseconds."""
        with self._handle:
            return self._clock._now_ns() - self._last_ns

    def time_until_next_call(self) -> int | None:
        """Nanoseconds, negative when a call is late; None for a canceled timer."""
        with self._handle:
            return None if self._is_canceled else self._next_ns - self._clock._now_ns()

    def pending(self) -> int:
        """0: executors ask for due timers by `announce_if_due`."""
        return 0

    def announce_if_due(self) -> bool:
        """Return whether a call is due that was not announced to the executor, and mark it as announced."""
        if self._is_announced or self._is_canceled or self.is_destroyed:
            return False
        self._is_announced = self._next_ns <= self._clock._now_ns()
        return self._is_announced

    def forget_announcement(self) -> None:
        """Announce a due call again, to another executor."""
        self._is_announced = False

    def wait_s(self) -> float | None:
        """Seconds of wall time until a call is due; None if it is not known."""
        if self._is_announced or self._is_canceled or self.is_destroyed or self._clock.is_simulated:
            return None
        return max(0.0, (self._next_ns - self._clock._now_ns()) / 1e9)

    def take(self) -> tuple[Callable[..., Any], tuple[Any, ...]] | None:
        """Take the call that is due, and plan the next one."""
        self._is_announced = False
        now_ns = self._clock._now_ns()
        if self._is_canceled or now_ns < self._next_ns or self.callback is None:
            return None
        self._last_ns = now_ns
        self._next_ns += self._period_ns
        if self._next_ns <= now_ns and self._period_ns:
            missed = (now_ns - self._next_ns) // self._period_ns + 1
            self._next_ns += missed * self._period_ns
        return self.callback, ()

    def time_was_set(self) -> None:
        """Plan the next call after a jump of simulated time, and wake the executor."""
        now_ns = self._clock._now_ns()
        if now_ns < self._last_ns:
            self._last_ns, self._next_ns = now_ns, now_ns + self._period_ns
        self._wake()

    def _wake(self) -> None:
        node = self.node
        if node is not None and node.executor is not None:
            node.executor.wake()


class Rate:
    """Sleeps until the next period of a timer. Another thread must spin the node."""

    def __init__(self, timer: Timer, *, context: Context) -> None:
        self._timer = timer
        self._sleepers = threading.Condition()
        self._sleeping = 0
        self._is_over = False
        """Whether a period has ended since the last sleeper woke: one without sleepers counts, too."""
        self._is_shutdown = self._is_destroyed = False
        timer.callback = self._end_period
        context.on_shutdown(self._on_shutdown)

    def destroy(self) -> None:
        """Wake all sleepers, and sleep no more."""
        self._is_destroyed = True
        self._end_period()

    def sleep(self) -> None:
        """Wait for the next period, together with all threads that sleep.

        Raises ROSInterruptException after a shutdown of the context, RuntimeError for a rate that is destroyed and
        InvalidHandle if its timer is.
        """
        self._check_shutdown()
        if self._is_destroyed:
            raise RuntimeError("Rate cannot sleep because it has been destroyed")
        if self._timer.is_destroyed:
            self.destroy()
            raise InvalidHandle("Rate cannot sleep because the timer has been destroyed")
        named = waits.named("the next period of a rate", None, is_deadlock=self._timer.is_blocked())
        with named, self._sleepers:
            self._sleeping += 1
            try:
                self._sleepers.wait_for(lambda: self._is_over)
            finally:
                self._sleeping -= 1
                self._is_over = self._is_over and self._sleeping > 0
        self._check_shutdown()

    def _end_period(self) -> None:
        with self._sleepers:
            self._is_over = True
            self._sleepers.notify_all()

    def _check_shutdown(self) -> None:
        if self._is_shutdown:
            raise ROSInterruptException

    def _on_shutdown(self) -> None:
        self._is_shutdown = True
        self.destroy()
