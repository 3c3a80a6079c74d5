"""The base of executors: one queue (`graph/ready_queue.py`), into which entities and tasks come when they are ready."""

from __future__ import annotations

import weakref
from collections.abc import Callable, Coroutine
from contextlib import suppress
from types import TracebackType
from typing import TYPE_CHECKING, Any

from thymio_sim_ros.portable_ros.graph.deadline import Deadline
from thymio_sim_ros.portable_ros.graph.entity import Entity
from thymio_sim_ros.portable_ros.graph.ready_queue import ReadyQueue
from thymio_sim_ros.portable_ros.graph.time_base import note_query
from thymio_sim_ros.portable_ros.rclpy._rclpy_pybind11 import WaitSet
from thymio_sim_ros.portable_ros.rclpy.task import Future, Task
from thymio_sim_ros.portable_ros.rclpy.utilities import get_default_context, timeout_sec_to_nsec

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.rclpy.context import Context


__all__ = [
    "ConditionReachedException",
    "Executor",
    "ExternalShutdownException",
    "ShutdownException",
    "TimeoutException",
]


class TimeoutException(Exception):
    """Nothing was ready in time."""


class ShutdownException(Exception):
    """The executor was shut down."""


class ExternalShutdownException(Exception):
    """The context was shut down."""


class ConditionReachedException(Exception):
    """A condition of a wait is true."""


class Executor:
    """Base of executors."""

    def __init__(self, *, context: Context | None = None) -> None:
        self._context = context or get_default_context()
        self._nodes: list[Any] = []
        self._wait_set = WaitSet()
        self._changed = self._wait_set.changed
        self._queue = ReadyQueue()
        self._reference = weakref.ref(self)
        self._resumable: dict[Task, Entity | None] = {}
        """Coroutines that wait, with the entity whose callback they are."""
        self._running: list[Entity | Task] = []
        """What has been handed out and has not yet run."""
        self._is_shutdown = False
        self._context.on_shutdown(self.wake)

    @property
    def context(self) -> Context:
        """The context."""
        return self._context

    def create_task(self, callback: Callable[..., Any] | Coroutine[Any, Any, Any], *args: Any, **kwargs: Any) -> Task:
        """Run a callback or a coroutine, before tasks that were created earlier. Thread-safe."""
        task = Task(callback, args, kwargs, executor=self)
        task.belong_to(self._reference)
        with self._changed:
            self._add_created(task)
            self._changed.notify_all()
        return task

    def _add_created(self, task: Task) -> None:
        self._queue.add_created(task)

    def resume(self, task: Task) -> None:
        """Run a task again. Thread-safe."""
        with self._changed:
            self._queue.append(task)
            self._changed.notify_all()

    def enqueue(self, entity: Entity, count: int = 1) -> None:
        """Execute so many events of an entity, if its node is one of these. Thread-safe."""
        with self._changed:
            if count and entity.node in self._nodes:
                for _ in range(count):
                    self._queue.append(entity)
                self._changed.notify_all()

    def wake(self) -> None:
        """Make a wait look again whether something is ready. Thread-safe."""
        with self._changed:
            self._changed.notify_all()

    def add_node(self, node: Any) -> bool:
        """Execute the callbacks of a node; return whether it is a new one."""
        node = node.itself
        with self._changed:
            if node in self._nodes:
                return False
            self._nodes.append(node)
        node.executor = self
        for entity in node.entities():
            self.enqueue(entity, entity.pending())
        self.wake()
        return True

    def remove_node(self, node: Any) -> None:
        """Execute no more callbacks of a node."""
        node = node.itself
        with self._changed:
            if node in self._nodes:
                self._nodes.remove(node)
                self._queue.forget(node)
                for one in node.polled():
                    one.forget_announcement()
        self.wake()

    def get_nodes(self) -> list[Any]:
        """The nodes."""
        return list(self._nodes)

    def shutdown(self, timeout_sec: float | None = None) -> bool:
        """Start no more callbacks and wait for others that run; return whether all have ended in time."""
        with self._changed:
            self._is_shutdown = True
            self._changed.notify_all()
            is_over = self._changed.wait_for(lambda: not self._others_run(), timeout_sec)
            if is_over:
                self._nodes.clear()
                self._queue.clear()
        return is_over

    def _others_run(self) -> bool:
        """Whether callbacks run, apart from one that calls this."""
        return any(not isinstance(one, Task) or not one.runs_here() for one in self._running)

    def spin(self) -> None:
        """Execute callbacks until the context or the executor is shut down. Raises what a callback raises."""
        while self._context.ok() and not self._is_shutdown:
            self.spin_once()

    def spin_once(self, timeout_sec: float | None = None) -> None:
        """Execute one callback, or none if none is ready in time.

        Raises RCLError after a shutdown of the context, and ExternalShutdownException if it happens meanwhile.
        """
        self._spin_once(timeout_sec, lambda: False)

    def spin_until_future_complete(self, future: Future[Any], timeout_sec: float | None = None) -> None:
        """Execute callbacks, at least one that is ready, until a future is done or the time is over."""
        future.add_done_callback(lambda _: self.wake())
        deadline = Deadline(timeout_sec)
        while self._context.ok() and future._pending() and not self._is_shutdown:
            self.spin_once_until_future_complete(future, deadline.left_s())
            if deadline.is_over():
                return

    def spin_once_until_future_complete(self, future: Future[Any], timeout_sec: float | None = None) -> None:
        """Execute one callback unless a future is done before."""
        future.add_done_callback(lambda _: self.wake())
        self._spin_once(timeout_sec, lambda: not future._pending())

    def _spin_once(self, timeout_sec: float | None, condition: Callable[[], bool]) -> None:
        with suppress(ConditionReachedException, ShutdownException):
            try:
                self._execute(self._next(timeout_sec, condition)[0])
            except TimeoutException:
                if timeout_sec == 0:
                    note_query()

    def is_blocked_here(self, entity: Entity) -> bool:
        """Whether the callback that the calling thread runs keeps the one of an entity from being run.

        It does if it has the only thread, or the group of both, which is mutually exclusive.
        """
        here = [one for one in self._running if isinstance(one, Task) and one.runs_here()]
        groups = [running.callback_group for one in here if (running := self._resumable.get(one)) is not None]
        group = entity.callback_group
        is_held = group is not None and any(one is group for one in groups) and not group.can_execute(entity)
        return bool(here) and (self._has_one_thread or is_held)

    _has_one_thread = True

    def _has_free_thread(self) -> bool:
        """Whether a callback that is handed out now would run at once."""
        return True

    def can_execute(self, entity: Entity) -> bool:
        """Whether a callback of an entity may start now."""
        return entity.callback_group is None or entity.callback_group.can_execute(entity)

    def __enter__(self) -> Executor:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.shutdown()

    def wait_for_ready_callbacks(
        self, timeout_sec: float | None = None, nodes: object = None, condition: Callable[[], bool] = lambda: False
    ) -> tuple[Task, Entity | None, Any]:
        """Wait for a callback that may start, and return the task that runs it, its entity and its node.

        With a time of 0, calls return what was ready at the first of them, each entity once, and then raise
        TimeoutException, even if more has become ready. `nodes` is not looked at: all nodes of the executor take part.
        Raises also ConditionReachedException and ShutdownException, and what `spin_once` raises.
        """
        if timeout_sec == 0:
            with self._changed:
                self._poll()
                self._queue.begin_round()
        try:
            return self._next(timeout_sec, condition)
        except TimeoutException:
            self._queue.end_round()
            raise

    def _next(self, timeout_sec: float | None, condition: Callable[[], bool]) -> tuple[Task, Entity | None, Any]:
        self._require_context(timeout_sec, condition)
        deadline = Deadline(timeout_sec)
        while True:
            with self._changed:
                if self._is_shutdown:
                    raise ShutdownException
                if not self._context.ok():
                    raise ExternalShutdownException
                if condition():
                    raise ConditionReachedException
                self._poll()
                found = self._queue.pop(self._nodes) if self._has_free_thread() else None
                if found is None:
                    if deadline.is_over():
                        raise TimeoutException
                    self._wait_set.due_s = self._due_s()
                    self._wait_set.wait(timeout_sec_to_nsec(deadline.left_s()))
                    continue
                self._running.append(found)
            if isinstance(found, Task):
                entity = self._resumable.get(found)
                return found, entity, None if entity is None else entity.node
            if (task := self._task(found)) is not None:
                return task, found, found.node

    def _require_context(self, timeout_sec: float | None, condition: Callable[[], bool]) -> None:
        """Raise RCLError if the context was shut down: where rclpy starts to use it, for the time or for the wait."""
        if self._context.ok():
            return
        if timeout_sec_to_nsec(timeout_sec) > 0:
            self._context.require_ok("failed to create timer")
        if not (self._is_shutdown or condition()):
            self._context.require_ok("failed to initialize wait set")

    def _task(self, entity: Entity) -> Task | None:
        """The task that runs the callback of an entity; None if the entity has nothing."""
        taken = entity.take()
        if taken is None:
            self._release(entity, entity)
            return None
        task = Task(taken[0], taken[1], executor=self)
        task.belong_to(self._reference)
        self._resumable[task] = entity
        self._running.append(task)
        self._running.remove(entity)
        return task

    def _poll(self) -> None:
        """Enqueue the timers that are due and the waitables that are ready."""
        for node in self._nodes:
            for one in node.polled():
                if one.announce_if_due():
                    self._queue.append(one)

    def _due_s(self) -> float | None:
        """Seconds until a timer is due."""
        waits = (timer.wait_s() for node in self._nodes for timer in node.all_timers)
        return min((wait_s for wait_s in waits if wait_s is not None), default=None)

    def turn_ended(self, task: Task) -> None:
        """Called when a task has run, until it was done or waits. Thread-safe."""
        if task not in self._running:
            return  # the program runs it on its own
        self._release(task, None if task._pending() else self._resumable.pop(task, None))

    def _release(self, work: Entity | Task, entity: Entity | None) -> None:
        """End a turn, and the execution of an entity that is over; what had to wait for it may start."""
        if entity is not None and entity.callback_group is not None:
            entity.callback_group.ending_execution(entity)
        with self._changed:
            self._running.remove(work)
            self._queue.release()
            self._changed.notify_all()

    def _execute(self, task: Task) -> None:
        """Run a task; raise the exception of a callback."""
        task()
        if task.done() and (error := task.exception()) is not None:
            raise error
