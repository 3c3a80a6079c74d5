"""Executors: run the callbacks of nodes, on one thread or on several."""

from __future__ import annotations

import os
import warnings
import weakref
from collections.abc import Callable
from concurrent.futures import Future as PoolFuture
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from typing import TYPE_CHECKING

from thymio_sim_ros.portable_ros.rclpy.task import await_or_execute
from thymio_sim_ros.portable_ros.rclpy_parts.executor_base import (
    ConditionReachedException,
    Executor,
    ExternalShutdownException,
    ShutdownException,
    TimeoutException,
)

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.rclpy.context import Context
    from thymio_sim_ros.portable_ros.rclpy.task import Task

__all__ = [
    "ConditionReachedException",
    "Executor",
    "ExternalShutdownException",
    "MultiThreadedExecutor",
    "ShutdownException",
    "SingleThreadedExecutor",
    "TimeoutException",
    "await_or_execute",
]


class SingleThreadedExecutor(Executor):
    """Executes callbacks on the thread that spins."""


class MultiThreadedExecutor(Executor):
    """Executes callbacks on several threads."""

    _has_one_thread = False

    def __init__(self, num_threads: int | None = None, *, context: Context | None = None) -> None:
        """`num_threads`: by default, the number of processors that the process may use."""
        super().__init__(context=context)
        if num_threads is None:
            num_threads = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 2
        if num_threads == 1:
            warnings.warn(
                "MultiThreadedExecutor is used with a single thread.\nUse the SingleThreadedExecutor instead.",
                stacklevel=2,
            )
        self._num_threads = num_threads
        self._executor = ThreadPoolExecutor(num_threads)
        self._futures: list[PoolFuture[None]] = []
        weakref.finalize(self, self._executor.shutdown, wait=False)

    def shutdown(self, timeout_sec: float | None = None) -> bool:
        """Start no more callbacks and wait for those that run; return whether all have ended in time."""
        is_over = super().shutdown(timeout_sec)
        self._executor.shutdown(wait=False)
        return is_over

    def _has_free_thread(self) -> bool:
        """Whether a thread is free: what waits for one stays in its entity, whose limits hold."""
        return len(self._running) < self._num_threads

    def _spin_once(self, timeout_sec: float | None, condition: Callable[[], bool]) -> None:
        with suppress(ExternalShutdownException):
            super()._spin_once(timeout_sec, condition)

    def _execute(self, task: Task) -> None:
        self._futures.append(self._executor.submit(super()._execute, task))
        ended = [one for one in self._futures if one.done()]
        self._futures = [one for one in self._futures if one not in ended]
        for one in ended:
            one.result()
