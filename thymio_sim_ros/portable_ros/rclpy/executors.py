"""Executors: run the callbacks of nodes, on one thread or on several.

All executors have one queue, in which entities and tasks stand in the order in which they became ready.
"""

from __future__ import annotations

import os
import sys
import threading
import time
import weakref
from collections import deque
from collections.abc import Callable, Coroutine
from concurrent.futures import Future as PoolFuture
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from types import TracebackType
from typing import TYPE_CHECKING, Any

from thymio_sim_ros.portable_ros.graph.entity import Entity
from thymio_sim_ros.portable_ros.rclpy.task import Future, Task
from thymio_sim_ros.portable_ros.rclpy.utilities import get_default_context

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.rclpy.context import Context

_LONGEST_WAIT_S = 0.2 if sys.platform == "win32" else threading.TIMEOUT_MAX
"""Of one wait: Windows handles Ctrl-C between waits."""


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
        self._changed = threading.Condition()
        self._ready: deque[Entity | Task] = deque()
        self._held: list[Entity] = []
        """Entities that are ready while another callback of their group runs."""
        self._resumable: dict[Task, Entity | None] = {}
        """Coroutines that wait, with the entity whose callback they are."""
        self._running = 0
        self._is_shutdown = False
        self._context.on_shutdown(self.wake)

    @property
    def context(self) -> Context:
        """The context."""
        return self._context

    def create_task(self, callback: Callable[..., Any] | Coroutine[Any, Any, Any], *args: Any, **kwargs: Any) -> Task:
        """Run a callback or a coroutine when all that is ready now has been executed. Thread-safe."""
        task = Task(callback, args, kwargs, executor=self)
        self.resume(task)
        return task

    def resume(self, task: Task) -> None:
        """Run a task again. Thread-safe."""
        with self._changed:
            self._ready.append(task)
            self._changed.notify_all()

    def enqueue(self, entity: Entity, count: int = 1) -> None:
        """Execute so many events of an entity, if its node is one of these. Thread-safe."""
        with self._changed:
            if count and entity.node in self._nodes:
                self._ready.extend([entity] * count)
                self._changed.notify_all()

    def wake(self) -> None:
        """Make a wait look again whether something is ready. Thread-safe."""
        with self._changed:
            self._changed.notify_all()

    def add_node(self, node: Any) -> bool:
        """Execute the callbacks of a node; return whether it is a new one."""
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
        with self._changed:
            if node in self._nodes:
                self._nodes.remove(node)
                self._ready = deque(one for one in self._ready if isinstance(one, Task) or one.node is not node)
                for timer in node.timers:
                    timer.forget_announcement()
        self.wake()

    def get_nodes(self) -> list[Any]:
        """The nodes."""
        return list(self._nodes)

    def shutdown(self, timeout_sec: float | None = None) -> bool:
        """Start no more callbacks and wait for those that run; return whether all have ended in time."""
        with self._changed:
            self._is_shutdown = True
            self._changed.notify_all()
            is_over = self._changed.wait_for(lambda: not self._running, timeout_sec)
            if is_over:
                self._nodes.clear()
                self._ready.clear()
        return is_over

    def spin(self) -> None:
        """Execute callbacks until the context or the executor is shut down. Raises what a callback raises."""
        while self._context.ok() and not self._is_shutdown:
            self.spin_once()

    def spin_once(self, timeout_sec: float | None = None) -> None:
        """Execute one callback, or none if none is ready in time."""
        with suppress(TimeoutException):
            self._execute(self._next(timeout_sec, lambda: False))

    def spin_until_future_complete(self, future: Future, timeout_sec: float | None = None) -> None:
        """Execute callbacks until a future is done, or until the time is over."""
        future.add_done_callback(lambda _: self.wake())
        end_s = None if timeout_sec is None or timeout_sec < 0 else time.monotonic() + timeout_sec
        while self._context.ok() and not future.done() and not self._is_shutdown:
            left_s = None if end_s is None else end_s - time.monotonic()
            if left_s is not None and left_s < 0:
                return
            self.spin_once_until_future_complete(future, left_s)

    def spin_once_until_future_complete(self, future: Future, timeout_sec: float | None = None) -> None:
        """Execute one callback unless a future is done before."""
        with suppress(TimeoutException, ConditionReachedException):
            self._execute(self._next(timeout_sec, future.done))

    def can_execute(self, entity: Entity) -> bool:
        """Whether a callback of an entity may start now."""
        return entity.callback_group is None or entity.callback_group.can_execute(entity)

    def __enter__(self) -> Executor:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.shutdown()

    def _execute(self, work: Callable[[], None]) -> None:
        work()

    def _next(self, timeout_sec: float | None, is_over: Callable[[], bool]) -> Callable[[], None]:
        """Wait for a callback that may start, and return what executes it.

        Raises TimeoutException, ConditionReachedException, ShutdownException and ExternalShutdownException.
        """
        end_s = None if timeout_sec is None or timeout_sec < 0 else time.monotonic() + timeout_sec
        while True:
            with self._changed:
                if self._is_shutdown:
                    raise ShutdownException
                if not self._context.ok():
                    raise ExternalShutdownException
                if is_over():
                    raise ConditionReachedException
                self._announce_timers()
                found = self._pop()
                if found is None:
                    left_s = None if end_s is None else end_s - time.monotonic()
                    if left_s is not None and left_s <= 0:
                        raise TimeoutException
                    self._changed.wait(min(self._wait_s(), _LONGEST_WAIT_S if left_s is None else left_s))
                    continue
                self._running += 1
            work = self._work(found)
            if work is not None:
                return work

    def _announce_timers(self) -> None:
        for node in self._nodes:
            self._ready.extend(timer for timer in node.timers if timer.announce_if_due())

    def _wait_s(self) -> float:
        """Seconds until a timer is due."""
        waits = (timer.wait_s() for node in self._nodes for timer in node.timers)
        return min((wait_s for wait_s in waits if wait_s is not None), default=_LONGEST_WAIT_S)

    def _pop(self) -> Entity | Task | None:
        """Remove the first entity or task that may start, and begin its execution."""
        while self._ready:
            found = self._ready.popleft()
            if isinstance(found, Task):
                return found
            if found.is_destroyed or found.node not in self._nodes:
                continue
            if found.callback_group is None or found.callback_group.beginning_execution(found):
                return found
            self._held.append(found)
        return None

    def _work(self, found: Entity | Task) -> Callable[[], None] | None:
        """Return what executes an entity or a task; None if the entity has nothing."""
        if isinstance(found, Task):
            task, entity = found, self._resumable.pop(found, None)
        else:
            taken, entity = found.take(), found
            if taken is None:
                self._ended(entity)
                return None
            task = Task(taken[0], taken[1], executor=self)
        return lambda: self._run(task, entity)

    def _run(self, task: Task, entity: Entity | None) -> None:
        """Run a task; raise the exception of a callback."""
        if entity is not None:
            self._resumable[task] = entity
        try:
            task()
        finally:
            is_over = task.done()
            if is_over:
                self._resumable.pop(task, None)
            self._ended(entity if is_over else None)
        if is_over and (error := task.exception()) is not None:
            raise error

    def _ended(self, entity: Entity | None) -> None:
        if entity is not None and entity.callback_group is not None:
            entity.callback_group.ending_execution(entity)
        with self._changed:
            self._running -= 1
            self._ready.extendleft(reversed(self._held))
            self._held.clear()
            self._changed.notify_all()


class SingleThreadedExecutor(Executor):
    """Executes callbacks on the thread that spins."""


class MultiThreadedExecutor(Executor):
    """Executes callbacks on several threads."""

    def __init__(self, num_threads: int | None = None, *, context: Context | None = None) -> None:
        super().__init__(context=context)
        self._pool = ThreadPoolExecutor(num_threads or os.cpu_count() or 2)
        self._futures: list[PoolFuture[None]] = []
        weakref.finalize(self, self._pool.shutdown, wait=False)

    def shutdown(self, timeout_sec: float | None = None) -> bool:
        """Start no more callbacks and wait for those that run; return whether all have ended in time."""
        is_over = super().shutdown(timeout_sec)
        self._pool.shutdown(wait=False)
        return is_over

    def _execute(self, work: Callable[[], None]) -> None:
        self._futures.append(self._pool.submit(work))
        ended = [one for one in self._futures if one.done()]
        self._futures = [one for one in self._futures if one not in ended]
        for one in ended:
            one.result()
