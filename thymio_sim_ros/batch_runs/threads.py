"""Runs tasks that wait for processes of their own, on threads of this process: no cluster is needed for them."""

from __future__ import annotations

import os
from collections.abc import Callable, Generator, Sequence
from concurrent.futures import FIRST_COMPLETED, ThreadPoolExecutor, wait
from functools import partial
from typing import TypeVar

from thymio_sim_ros.batch_runs.failure import Failure, attempt

__all__ = ["run_in_threads"]

_PULSE_S = 0.5
"""The caller gets something at least this often."""

Task = TypeVar("Task")
Result = TypeVar("Result")


def run_in_threads(
    function: Callable[[Task], Result], tasks: Sequence[Task], workers: int | None = None
) -> Generator[list[tuple[int, Result | Failure]], None, None]:
    """Call a function with each task; yield the outcomes as `engine.run_all` does.

    `workers`: number of threads; None: one per core. Tasks that run when the generator is closed are abandoned.
    """
    pool = ThreadPoolExecutor(workers or os.cpu_count() or 1)
    try:
        numbers = {pool.submit(partial(attempt, function), task): number for number, task in enumerate(tasks)}
        while numbers:
            ended, _ = wait(numbers, timeout=_PULSE_S, return_when=FIRST_COMPLETED)
            yield [(numbers.pop(future), future.result()) for future in ended]
    finally:
        pool.shutdown(wait=False, cancel_futures=True)
