"""Futures and tasks: values that are there later, and callbacks or coroutines that an executor runs."""

from __future__ import annotations

import inspect
import threading
import warnings
import weakref
from collections.abc import Callable, Coroutine, Generator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.graph.protocols import Tasks

__all__ = ["Future", "Task"]


class Future:
    """A value, an exception or a cancellation that comes later."""

    def __init__(self, *, executor: Tasks | None = None) -> None:
        self._lock = threading.RLock()
        self._is_done = self._is_cancelled = self._is_raised = False
        self._result: Any = None
        self._exception: BaseException | None = None
        self._callbacks: list[Callable[[Any], Any]] = []
        self._executor: Callable[[], Tasks | None] = lambda: None
        self._set_executor(executor)

    def __del__(self) -> None:
        if self._exception is not None and not self._is_raised:
            warnings.warn(f"The following exception was never retrieved: {self._exception}", stacklevel=2)

    def __await__(self) -> Generator[Future, None, Any]:
        while not self._is_done:
            yield self
        return self.result()

    def cancel(self) -> None:
        """Cancel, unless it is done."""
        self._end(is_cancelled=True)

    def cancelled(self) -> bool:
        """Whether it was cancelled."""
        return self._is_cancelled

    def done(self) -> bool:
        """Whether there is a result, an exception or a cancellation."""
        return self._is_done

    def result(self) -> Any:
        """The result, None before it is there. Raises the exception if there is one."""
        if self._exception is not None:
            raise self._retrieved(self._exception)
        return self._result

    def exception(self) -> BaseException | None:
        """The exception, None without one."""
        self._is_raised = True
        return self._exception

    def set_result(self, result: Any) -> None:
        """Set the result and call all callbacks."""
        self._end(result=result)

    def set_exception(self, exception: BaseException) -> None:
        """Set the exception and call all callbacks."""
        self._is_raised = False
        self._end(exception=exception)

    def add_done_callback(self, callback: Callable[[Any], Any]) -> None:
        """Call the callback with the future once it is done; at once if it is done already."""
        with self._lock:
            if not self._is_done:
                self._callbacks.append(callback)
                return
        self._invoke(callback)

    def remove_done_callback(self, callback: Callable[[Any], Any]) -> bool:
        """Remove a callback; return whether there was one."""
        with self._lock:
            count = len(self._callbacks)
            self._callbacks = [one for one in self._callbacks if one != callback]
            return len(self._callbacks) < count

    def _retrieved(self, exception: BaseException) -> BaseException:
        self._is_raised = True
        return exception

    def _set_executor(self, executor: Tasks | None) -> None:
        """Set the executor that runs the callbacks."""
        self._executor = weakref.ref(executor) if executor is not None else lambda: None

    def _end(self, *, result: Any = None, exception: BaseException | None = None, is_cancelled: bool = False) -> None:
        with self._lock:
            if is_cancelled and self._is_done:
                return
            self._result, self._exception = result, exception
            self._is_done, self._is_cancelled = True, is_cancelled
            callbacks, self._callbacks = self._callbacks, []
        for callback in callbacks:
            self._invoke(callback)

    def _invoke(self, callback: Callable[[Any], Any]) -> None:
        executor = self._executor()
        if executor is not None:
            executor.create_task(callback, self)
            return
        try:
            callback(self)
        except Exception as error:
            warnings.warn(f"Unhandled exception in done callback: {error}", stacklevel=2)


class Task(Future):
    """A callback or a coroutine; calling the task runs it, until it is done or waits for a future."""

    def __init__(
        self,
        handler: Callable[..., Any] | Coroutine[Any, Any, Any],
        args: Sequence[Any] | None = None,
        kwargs: Mapping[str, Any] | None = None,
        executor: Tasks | None = None,
    ) -> None:
        super().__init__(executor=executor)
        self._args, self._kwargs = tuple(args or ()), dict(kwargs or {})
        self._handler: Any = handler
        self._is_coroutine = inspect.iscoroutine(handler)
        if inspect.iscoroutinefunction(handler):
            self._handler, self._is_coroutine = handler(*self._args, **self._kwargs), True
        self._is_executing = threading.Lock()

    def __call__(self) -> None:
        """Run the callback, or the coroutine to its next wait."""
        try:
            if not self._is_done and self._is_executing.acquire(blocking=False):
                self._run()
        finally:
            if (executor := self._executor()) is not None:
                executor.turn_ended(self)

    def executing(self) -> bool:
        """Whether a thread runs the task now."""
        return self._is_executing.locked()

    def cancel(self) -> None:
        """Cancel, unless it is done."""
        if self._is_coroutine and not self._is_done and not self.executing():
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
        try:
            awaited = self._handler.send(None)
        except StopIteration as end:
            self.set_result(end.value)
            return
        executor = self._executor()
        if executor is None:
            return
        if isinstance(awaited, Future):
            awaited.add_done_callback(lambda _: executor.resume(self))
        else:
            executor.resume(self)
