"""Replaces clocks and waits of rclpy by simulated time and turns."""

from __future__ import annotations

import weakref
from collections.abc import Callable, Iterator
from typing import Any

import rclpy
from rclpy import clock, executors, time_source, utilities
from rclpy.action import client as action_client
from rclpy.action import server as action_server
from rclpy.clock_type import ClockType
from rclpy.impl.implementation_singleton import rclpy_implementation

from thymio_sim_ros.lockstep.turns import Turns

__all__ = ["install"]

_rclpy: Any = rclpy_implementation
KINDS = ("subscription", "guard_condition", "timer", "client", "service")


def install(turns: Turns) -> None:
    """Replace them; called before the program imports rclpy."""
    _install_clocks(turns)
    _install_wait_set(turns)
    _install_executors()
    _install_ok(turns)


# --- clocks ---


def _install_clocks(turns: Turns) -> None:
    """Make all clocks of nodes, timers and executors show simulated time, whether or not the node is spun."""
    kind: Any = clock.Clock
    new = kind.__new__
    alive: weakref.WeakSet[Any] = weakref.WeakSet()

    def new_clock(cls: Any, *, clock_type: Any = ClockType.SYSTEM_TIME) -> Any:
        # Of the clocks of rcl, only those of type ROS_TIME can be set. rclpy has its handle in a private attribute.
        made = new(cls, clock_type=clock_type)
        made._Clock__clock = _rclpy.Clock(ClockType.ROS_TIME)
        made.handle.set_ros_time_override_is_enabled(True)
        _set(made, turns.now_ns)
        alive.add(made)
        return made

    def set_all(now_ns: int) -> None:
        for living in list(alive):  # a copy: setting a clock calls its jump callbacks, which may create clocks
            _set(living, now_ns)

    now = kind.now

    def counted_now(self: Any) -> Any:
        turns.poll()
        return now(self)

    def sleep_until(self: Any, until: Any, context: Any = None) -> bool:
        context = utilities.get_default_context() if context is None else context
        turns.wait(lambda: not context.ok(), until.nanoseconds, "time")
        return bool(context.ok())

    kind.__new__, kind.now, kind.sleep_until = new_clock, counted_now, sleep_until
    turns.on_time = set_all
    ros_clock: Any = clock.ROSClock
    ros_clock._set_ros_time_is_active = ros_clock.set_ros_time_override = lambda *_: None
    source: Any = time_source.TimeSource
    source._subscribe_to_clock_topic = lambda _self: None


def _set(target: Any, now_ns: int) -> None:
    target.handle.set_ros_time_override(_rclpy.rcl_time_point_t(now_ns, ClockType.ROS_TIME))


# --- waits ---


def _install_wait_set(turns: Turns) -> None:
    real: Any = _rclpy.WaitSet

    class WaitSet(real):  # type: ignore[misc]
        """Waits for entities by looking at them whenever something may have happened.

        A look empties the set of what is not ready, so the entities are added again for the next.
        """

        def __init__(self, *args: Any) -> None:
            super().__init__(*args)
            self._adds: list[Callable[[], Any]] = []
            self._timers: list[Any] = []
            self._events = 0

        def clear_entities(self) -> None:
            self._adds.clear()
            self._timers.clear()
            self._events = 0
            super().clear_entities()

        def add_by(self, add: Callable[[], Any]) -> Any:
            """Add entities by a function, which is called again for each look."""
            self._adds.append(add)
            return add()

        def add_subscription(self, handle: Any) -> Any:
            return self.add_by(lambda: real.add_subscription(self, handle))

        def add_client(self, handle: Any) -> Any:
            return self.add_by(lambda: real.add_client(self, handle))

        def add_service(self, handle: Any) -> Any:
            return self.add_by(lambda: real.add_service(self, handle))

        def add_guard_condition(self, handle: Any) -> Any:
            return self.add_by(lambda: real.add_guard_condition(self, handle))

        def add_event(self, handle: Any) -> Any:
            self._events += 1
            return self.add_by(lambda: real.add_event(self, handle))

        def add_timer(self, handle: Any) -> Any:
            self._timers.append(handle)
            return self.add_by(lambda: real.add_timer(self, handle))

        def wait(self, timeout_ns: int) -> None:
            # rcl never blocks here: its wait would last in real time, and the other threads would get no turn. Instead,
            # each thread that passes its turn on calls `_look` for this one (`Turns._following`).
            if self._look():
                return
            if timeout_ns == 0:
                turns.poll()
                self._look()
                return
            deadlines = [turns.now_ns + due for due in self._due()]
            if timeout_ns > 0:
                deadlines.append(turns.now_ns + timeout_ns)
            turns.wait(self._look, min(deadlines, default=None), "messages or timers")

        def _due(self) -> Iterator[int]:
            for timer in self._timers:
                due = timer.time_until_next_call()
                if due is not None:  # not canceled
                    yield max(due, 0)

        def _look(self) -> bool:
            """Whether something is ready; if so, the set has it."""
            super().clear_entities()
            for add in self._adds:
                add()
            super().wait(0)
            return any(self.get_ready_entities(kind) for kind in KINDS) or any(
                self.is_ready("event", index) for index in range(self._events)
            )

    _rclpy.WaitSet = WaitSet
    for kind in (action_client.ActionClient, action_server.ActionServer):
        _add_again(kind)


def _add_again(kind: Any) -> None:
    add = kind.add_to_wait_set
    kind.add_to_wait_set = lambda self, wait_set: wait_set.add_by(lambda: add(self, wait_set))


# --- executors ---


class _OrderedSet(dict[Any, None]):
    """A set that keeps the order: that of a set of nodes changes from run to run."""

    def add(self, item: Any) -> None:
        self[item] = None

    def remove(self, item: Any) -> None:
        del self[item]


def _install_executors() -> None:
    kind: Any = executors.Executor
    init = kind.__init__

    def init_ordered(self: Any, *args: Any, **kwargs: Any) -> None:
        init(self, *args, **kwargs)
        self._nodes = _OrderedSet()

    kind.__init__ = init_ordered
    try:
        from rclpy import experimental
        from rclpy.experimental import events_executor
    except ImportError:
        return
    for module in (experimental, events_executor):  # it waits outside Python
        replaced: Any = module
        replaced.EventsExecutor = executors.SingleThreadedExecutor


def _install_ok(turns: Turns) -> None:
    ok = utilities.ok

    def counted_ok(*, context: Any = None) -> bool:
        turns.poll()
        return ok(context=context)

    replaced: Any = rclpy
    replaced.ok = utilities.ok = counted_ok
