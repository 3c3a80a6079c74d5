"""Clocks: system time, steady time, and ROS time, which may be simulated."""

from __future__ import annotations

import copy
import threading
import weakref
from collections.abc import Callable
from enum import IntEnum
from types import TracebackType
from typing import TYPE_CHECKING

from thymio_sim_ros.portable_ros.graph import time_base, waits
from thymio_sim_ros.portable_ros.rclpy.clock_type import ClockType
from thymio_sim_ros.portable_ros.rclpy.constants import S_TO_NS
from thymio_sim_ros.portable_ros.rclpy.duration import Duration
from thymio_sim_ros.portable_ros.rclpy.exceptions import NotInitializedException
from thymio_sim_ros.portable_ros.rclpy.time import Time
from thymio_sim_ros.portable_ros.rclpy.utilities import get_default_context

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.graph.protocols import TimerEnd
    from thymio_sim_ros.portable_ros.rclpy.context import Context

__all__ = ["Clock", "ClockChange", "ClockType", "JumpHandle", "JumpThreshold", "ROSClock", "TimeJump"]


class ClockChange(IntEnum):
    """Whether a jump is a change between system time and simulated time."""

    ROS_TIME_NO_CHANGE = 1
    ROS_TIME_ACTIVATED = 2
    ROS_TIME_DEACTIVATED = 3
    SYSTEM_TIME_NO_CHANGE = 4


class JumpThreshold:
    """Which jumps a callback is called for. Raises ValueError for thresholds in the wrong direction, or without any."""

    def __init__(
        self, *, min_forward: Duration | None, min_backward: Duration | None, on_clock_change: bool = True
    ) -> None:
        if min_forward is not None and min_forward.nanoseconds <= 0:
            raise ValueError("min_forward must be a positive non-zero duration")
        if min_backward is not None and min_backward.nanoseconds >= 0:
            raise ValueError("min_backward must be a negative non-zero duration")
        if min_forward is None and min_backward is None and not on_clock_change:
            raise ValueError("At least one jump threshold must be enabled")
        self.min_forward, self.min_backward, self.on_clock_change = min_forward, min_backward, on_clock_change

    def is_exceeded(self, jump: TimeJump) -> bool:
        """Whether a jump is one of these."""
        if jump.clock_change in (ClockChange.ROS_TIME_ACTIVATED, ClockChange.ROS_TIME_DEACTIVATED):
            return self.on_clock_change
        if self.min_forward is not None and jump.delta >= self.min_forward:
            return True
        return self.min_backward is not None and jump.delta <= self.min_backward


class TimeJump:
    """A jump of a clock by `delta`."""

    def __init__(self, clock_change: ClockChange, delta: Duration) -> None:
        if not isinstance(clock_change, ClockChange):
            raise TypeError("clock_change must be an instance of rclpy.clock.ClockChange")
        self._clock_change, self._delta = clock_change, delta

    @property
    def clock_change(self) -> ClockChange:
        """The kind of the jump."""
        return self._clock_change

    @property
    def delta(self) -> Duration:
        """The new time less the old one."""
        return self._delta


class JumpHandle:
    """A registration of callbacks for jumps; it ends with `unregister` or with the block."""

    def __init__(
        self,
        *,
        clock: Clock,
        threshold: JumpThreshold,
        pre_callback: Callable[[], None] | None,
        post_callback: Callable[[TimeJump], None] | None,
    ) -> None:
        if pre_callback is None and post_callback is None:
            raise ValueError("One of pre_callback or post_callback must be callable")
        if pre_callback is not None and not callable(pre_callback):
            raise ValueError("pre_callback must be callable if given")
        if post_callback is not None and not callable(post_callback):
            raise ValueError("post_callback must be callable if given")
        self.is_asked_for = copy.copy(threshold).is_exceeded
        self.pre_callback, self.post_callback = pre_callback, post_callback
        self._clock = weakref.ref(clock)
        clock._jumps.append(self)

    def unregister(self) -> None:
        """Call the callbacks no more."""
        clock = self._clock()
        if clock is not None and self in clock._jumps:
            clock._jumps.remove(self)

    def __enter__(self) -> JumpHandle:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.unregister()


class Clock:
    """A clock of one kind; `Clock(clock_type=ClockType.ROS_TIME)` is a ROSClock."""

    _clock_type: ClockType
    _jumps: list[JumpHandle]

    def __new__(cls, *, clock_type: ClockType = ClockType.SYSTEM_TIME) -> Clock:
        if not isinstance(clock_type, ClockType):
            raise TypeError("Clock type must be a ClockType enum")
        made = super().__new__(ROSClock if clock_type == ClockType.ROS_TIME else cls)
        made._clock_type, made._jumps = clock_type, []
        if isinstance(made, ROSClock):
            made._override_ns, made._is_simulated, made._timers = 0, False, weakref.WeakSet()
        return made

    @property
    def clock_type(self) -> ClockType:
        """The kind of the clock."""
        return self._clock_type

    @property
    def is_simulated(self) -> bool:
        """Whether the time of the clock passes only when it is set."""
        return False

    def __repr__(self) -> str:
        return f"Clock(clock_type={self._clock_type.name})"

    def now(self) -> Time:
        """The present time."""
        time_base.note_query()
        return Time(nanoseconds=self._now_ns(), clock_type=self._clock_type)

    def _now_ns(self) -> int:
        """The present time in ns, for the room itself."""
        return time_base.steady_ns() if self._clock_type == ClockType.STEADY_TIME else time_base.system_ns()

    def notice(self, timer: TimerEnd) -> None:
        """Register a timer whose executor waits for this clock; only simulated time needs it."""

    def create_jump_callback(
        self,
        threshold: JumpThreshold,
        *,
        pre_callback: Callable[[], None] | None = None,
        post_callback: Callable[[TimeJump], None] | None = None,
    ) -> JumpHandle:
        """Call callbacks before and after jumps."""
        return JumpHandle(clock=self, threshold=threshold, pre_callback=pre_callback, post_callback=post_callback)

    def sleep_until(self, until: Time, context: Context | None = None) -> bool:
        """Wait for a time; return whether it has come, which it has not after a shutdown or a change of the clock."""
        context = context or get_default_context()
        if not context.ok():
            raise NotInitializedException
        if until.clock_type != self._clock_type:
            raise ValueError("until's clock type does not match this clock's type")
        woken, is_changed = threading.Event(), False
        context.on_shutdown(woken.set)

        def jumped(jump: TimeJump) -> None:
            nonlocal is_changed
            changes = (ClockChange.ROS_TIME_ACTIVATED, ClockChange.ROS_TIME_DEACTIVATED)
            is_changed = is_changed or jump.clock_change in changes
            woken.set()

        tick = Duration(nanoseconds=1)
        threshold = JumpThreshold(min_forward=tick, min_backward=Duration(nanoseconds=-1), on_clock_change=True)
        left_s = None if self.is_simulated else max(0.0, (until.nanoseconds - self._now_ns()) / S_TO_NS)
        named = waits.named("simulated time" if left_s is None else "time", left_s)
        with named, self.create_jump_callback(threshold, post_callback=jumped):
            while context.ok() and not is_changed and (left_ns := until.nanoseconds - self._now_ns()) > 0:
                woken.wait(None if self.is_simulated else left_ns / S_TO_NS)
                woken.clear()
        return context.ok() and not is_changed and self._now_ns() >= until.nanoseconds

    def sleep_for(self, rel_time: Duration, context: Context | None = None) -> bool:
        """Wait for a duration; return whether it is over."""
        return self.sleep_until(self.now() + rel_time, context)

    def _jump(self, jump: TimeJump, change: Callable[[], None]) -> None:
        """Change the time, with all callbacks before and after it."""
        called = [one for one in self._jumps if one.is_asked_for(jump)]
        for one in called:
            if one.pre_callback is not None:
                one.pre_callback()
        change()
        for one in called:
            if one.post_callback is not None:
                one.post_callback(jump)


class ROSClock(Clock):
    """Simulated time while it is active, else system time."""

    _override_ns: int
    _is_simulated: bool
    _timers: weakref.WeakSet[TimerEnd]

    def __new__(cls) -> ROSClock:
        made = super().__new__(cls, clock_type=ClockType.ROS_TIME)
        assert isinstance(made, ROSClock)
        return made

    @property
    def ros_time_is_active(self) -> bool:
        """Whether the time is simulated."""
        return self._is_simulated

    @property
    def is_simulated(self) -> bool:
        """Whether the time passes only when it is set."""
        return self._is_simulated and time_base.simulated_ns() is None

    def _now_ns(self) -> int:
        """The present time in ns, for the room itself."""
        if not self._is_simulated:
            return super()._now_ns()
        owned_ns = time_base.simulated_ns()
        return self._override_ns if owned_ns is None else owned_ns

    def notice(self, timer: TimerEnd) -> None:
        """Wake the executor of a timer whenever the time is set."""
        self._timers.add(timer)

    def set_ros_time_override(self, time: Time) -> None:
        """Set the simulated time. Raises TypeError for what is no time."""
        if not isinstance(time, Time):
            raise TypeError(f"Time must be specified as rclpy.time.Time. Received type: {type(time)}")
        delta = Duration(nanoseconds=time.nanoseconds - self._override_ns)

        def change() -> None:
            self._override_ns = time.nanoseconds

        if self._is_simulated:
            self._jump(TimeJump(ClockChange.ROS_TIME_NO_CHANGE, delta), change)
            self._wake()
        else:
            change()

    def _set_ros_time_is_active(self, enabled: bool) -> None:
        """Change between system time and simulated time."""
        if enabled == self._is_simulated:
            return
        change = ClockChange.ROS_TIME_ACTIVATED if enabled else ClockChange.ROS_TIME_DEACTIVATED
        before_ns = self._now_ns()
        owned_ns = time_base.simulated_ns()
        simulated_ns = self._override_ns if owned_ns is None else owned_ns
        after_ns = simulated_ns if enabled else time_base.system_ns()

        def switch() -> None:
            self._is_simulated = enabled

        self._jump(TimeJump(change, Duration(nanoseconds=after_ns - before_ns)), switch)
        self._wake()

    def _wake(self) -> None:
        for timer in list(self._timers):
            timer.time_was_set()
