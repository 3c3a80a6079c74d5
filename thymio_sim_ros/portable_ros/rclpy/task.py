"""Futures and tasks: values that are there later, and callbacks or coroutines that an executor runs."""

from __future__ import annotations

import inspect
import sys
import threading
import warnings
import weakref
from collections.abc import Callable, Coroutine, Generator, Mapping, Sequence
from enum import Enum
from typing import TYPE_CHECKING, Any, Generic, TypeVar

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.graph.protocols import Scheduler, TaskCreator

__all__ = ["Future", "Task", "await_or_execute"]

T = TypeVar("T")


class _Driver(threading.local):
    """What drives the coroutines of this thread: a task, or something else, such as asyncio."""

    is_task = False


_driver = _Driver()


def _nothing() -> None:
    """Stand for a weak reference without an object."""


async def await_or_execute(callback: Callable[..., Any], *args: Any) -> Any:
    """The result of a function, or of a coroutine once it is there."""
    result = callback(*args)
    return await result if hasattr(result, "__await__") else result


class FutureState(Enum):
    """The states of a future."""

    PENDING = "PENDING"
    CANCELLED = "CANCELLED"
    FINISHED = "FINISHED"


class Future(Generic[T]):
    """A value, an exception or a cancellation that comes later."""

    def __init__(self, *, executor: TaskCreator | None = None) -> None:
        self._lock = threading.RLock()
        self._state = FutureState.PENDING
        self._is_raised = False
        self._result: T | None = None
        self._exception: BaseException | None = None
        self._callbacks: list[Callable[[Future[T]], object]] = []
        self._waiting: list[Task] = []
        self._set_executor(executor)

    def __del__(self) -> None:
        if self._exception is not None and not self._is_raised:
            print(f"The following exception was never retrieved: {self._exception}", file=sys.stderr)

    def __await__(self) -> Generator[Future[T] | None, None, T | None]:
        while self._pending():
            # A task waits for the future; asyncio and other loops, which know None only, ask again.
            yield self if _driver.is_task else None
        return self.result()

    def cancel(self) -> None:
        """Cancel, unless it is done."""
        with self._lock:
            if not self._pending():
                return
        self._end(FutureState.CANCELLED)

    def cancelled(self) -> bool:
        """Whether it was cancelled."""
        return self._state is FutureState.CANCELLED

    def done(self) -> bool:
        """Whether there is a result or an exception, which there is not after a cancellation."""
        return self._state is FutureState.FINISHED

    def _pending(self) -> bool:
        """Whether there is neither a result nor an exception nor a cancellation."""
        return self._state is FutureState.PENDING

    def result(self) -> T | None:
        """The result, None before it is there. Raises the exception if there is one."""
        if self._exception is not None:
            raise self._retrieved(self._exception)
        return self._result

    def exception(self) -> BaseException | None:
        """The exception, None without one."""
        self._is_raised = True
        return self._exception

    def set_result(self, result: T) -> None:
        """Set the result and call all callbacks."""
        self._result = result
        self._end(FutureState.FINISHED)

    def set_exception(self, exception: BaseException) -> None:
        """Set the exception and call all callbacks."""
        self._exception, self._is_raised = exception, False
        self._end(FutureState.FINISHED)

    def add_done_callback(self, callback: Callable[[Future[T]], object]) -> None:
        """Call the callback with the future once it is done; at once, with its exceptions, if it is done already."""
        with self._lock:
            if self._pending():
                self._callbacks.append(callback)
                return
            executor = self._executor()
        if executor is not None:
            executor.create_task(callback, self)
        else:
            callback(self)

    def remove_done_callback(self, callback: Callable[[Future[T]], object]) -> bool:
        """Remove a callback; return whether there was one."""
        with self._lock:
            if callback not in self._callbacks:
                return False
            self._callbacks.remove(callback)
            return True

    def _retrieved(self, exception: BaseException) -> BaseException:
        self._is_raised = True
        return exception

    def _set_executor(self, executor: TaskCreator | None) -> None:
        """Set the executor that runs the callbacks."""
        self._executor: Callable[[], TaskCreator | None] = _nothing if executor is None else weakref.ref(executor)

    def _resume_when_done(self, task: Task) -> None:
        """Resume a task that waits for this future."""
        with self._lock:
            if self._pending():
                self._waiting.append(task)
                return
        task._resume()

    def _end(self, state: FutureState) -> None:
        """Enter a final state, resume all tasks that wait and call all callbacks."""
        with self._lock:
            self._state = state
            executor = self._executor()
            callbacks, self._callbacks = self._callbacks, []
            waiting, self._waiting = self._waiting, []
        for task in waiting:
            task._resume()
        for callback in callbacks:
            if executor is not None:
                executor.create_task(callback, self)
                continue
            try:
                callback(self)
            except Exception as error:
                warnings.warn(f"Unhandled exception in done callback: {error}", stacklevel=2)


class Task(Future[Any]):
    """A callback or a coroutine; calling the task runs it, until it is done or waits for a future."""

    def __init__(
        self,
        handler: Callable[..., Any] | Coroutine[Any, Any, Any],
        args: Sequence[Any] | None = None,
        kwargs: Mapping[str, Any] | None = None,
        executor: TaskCreator | None = None,
    ) -> None:
        super().__init__(executor=executor)
        self._args, self._kwargs = tuple(args or ()), dict(kwargs or {})
        self._handler: Any = handler
        self._is_coroutine = inspect.iscoroutine(handler)
        if inspect.iscoroutinefunction(handler):
            self._handler, self._is_coroutine = handler(*self._args, **self._kwargs), True
        self._is_executing = threading.Lock()
        self._thread_id = 0
        self._scheduler: Callable[[], Scheduler | None] = _nothing

    def belong_to(self, scheduler: Callable[[], Scheduler | None]) -> None:
        """Make an executor, by a weak reference, the one that runs the task whenever it can proceed."""
        self._scheduler = scheduler

    def __call__(self) -> None:
        """Run the callback, or the coroutine to its next wait."""
        try:
            if self._pending() and self._is_executing.acquire(blocking=False):
                self._thread_id = threading.get_ident()
                self._run()
        finally:
            if (scheduler := self._scheduler()) is not None:
                scheduler.turn_ended(self)

    def executing(self) -> bool:
        """Whether a thread runs the task now."""
        return self._is_executing.locked()

    def runs_here(self) -> bool:
        """Whether the calling thread runs the task now."""
        return self.executing() and self._thread_id == threading.get_ident()

    def cancel(self) -> None:
        """Cancel, unless it is done."""
        if self._is_coroutine and self._pending() and not self.executing():
            self._handler.close()
        super().cancel()

    def _run(self) -> None:
        try:
            if self._is_coroutine:
                self._advance()
            else:
                self.set_result(self._handler(*self._args, **self._kwargs))
        except Exception as error:
            self.set_exception(error)
        finally:
            self._is_executing.release()

    def _advance(self) -> None:
        before, _driver.is_task = _driver.is_task, True
        try:
            awaited = self._handler.send(None)
        except StopIteration as end:
            self.set_result(end.value)
            return
        finally:
            _driver.is_task = before
        scheduler = self._scheduler()
        if scheduler is None:
            return
        if isinstance(awaited, Future):
            awaited._resume_when_done(self)
        else:
            scheduler.resume(self)

    def _resume(self) -> None:
        """Let the coroutine proceed after a wait."""
        if (scheduler := self._scheduler()) is not None:
            scheduler.resume(self)
