"""Runs tasks on Dask: on a cluster of processes of this machine, or on one with a scheduler's address.

Dask repeats what a lost worker did. A group whose workers were lost again and again is taken apart: once nothing else
runs, its tasks run one by one, so that one that ends its process fails alone (`Failure`).
"""

from __future__ import annotations

import contextlib
import logging
import queue
import signal
import threading
import time
from collections import deque
from collections.abc import Callable, Generator, Iterator, Sequence
from typing import Any, Generic, TypeVar

import dask
from distributed import Client, Future, KilledWorker, LocalCluster, Worker, WorkerPlugin

from thymio_sim_ros import __version__
from thymio_sim_ros.batch_runs.errors import EngineError
from thymio_sim_ros.batch_runs.failure import Failure, attempt, line_of
from thymio_sim_ros.batch_runs.group_size import GROUP_S, GroupSize

__all__ = ["run_all"]

PULSE_S = 0.5
"""The caller of `run_all` gets something at least this often, in s."""

ATTEMPTS = 2
"""Number of processes that a group may lose on a cluster of this machine; other schedulers have their own setting."""

CONNECT_S = 20.0
"""Time-out for the scheduler and its first worker, in s."""

AHEAD = 2
"""Groups per thread that are scheduled at the same time: one runs, one waits, so that no thread is idle."""

Task = TypeVar("Task")
Result = TypeVar("Result")

_one_at_a_time = threading.Lock()
"""Tasks of a process run one after the other, also where a worker has several threads."""


Outcomes = list[tuple[int, Result | Failure]]
"""Results with the numbers of their tasks."""


def run_all(
    function: Callable[[Task], Result],
    tasks: Sequence[Task],
    *,
    workers: int | None = None,
    scheduler: str = "",
    dashboard: str = "",
    group_s: float = GROUP_S,
) -> Generator[Outcomes[Result], None, None]:
    """Call a function with each task; yield the outcomes as they come, each exactly once, in any order.

    The function must be importable, or a `functools.partial` of one; what is bound to it is sent to each worker once.
    At least every `PULSE_S` a list is yielded, if need be an empty one, so that the caller can show progress or end.
    When the generator is closed, running tasks are abandoned.

    Args:
        function: Called in other processes; an exception becomes a `Failure`.
        tasks: Arguments, which are sent in groups.
        workers: Processes on this machine; None: one per core. They listen on loopback only.
        scheduler: Address of a running Dask scheduler, such as "tcp://10.0.0.1:8786", instead of this machine.
        dashboard: Address at which this machine's cluster has a dashboard, such as "127.0.0.1:8787"; "": none.
        group_s: Duration of a group of tasks in s, or more on a large cluster; 0: each task is scheduled alone.

    Raises:
        EngineError: The cluster cannot be used, or was lost.
    """
    cluster = _connected(scheduler) if scheduler else _local(workers, dashboard)
    with _quiet(), cluster as client:
        try:
            yield from _Dispatch(client, function, tasks, GroupSize(group_s)).outcomes()
        except OSError as error:  # of a connection; those of tasks are failures
            raise EngineError(f"the cluster was lost: {line_of(error)}") from error


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
    """Keep the messages of Dask from the terminal; whatever matters is an outcome or an EngineError."""
    logger = logging.getLogger("distributed")
    before = logger.level
    logger.setLevel(logging.CRITICAL + 1)
    try:
        yield
    finally:
        logger.setLevel(before)


class _IgnoreInterrupt(WorkerPlugin):
    """Ctrl-C in a terminal reaches all processes of the group; this process decides what happens to the workers.

    SIG_IGN would not do: programs that a task starts would inherit it.
    """

    def setup(self, worker: Worker) -> None:
        signal.signal(signal.SIGINT, lambda number, frame: None)


@contextlib.contextmanager
def _local(workers: int | None, dashboard: str) -> Iterator[Client]:
    # The profiler of Dask samples the stack 100 times a second. Without routes the HTTP server, which Dask always
    # starts, answers nothing.
    settings: dict[str, Any] = {
        "distributed.scheduler.allowed-failures": ATTEMPTS - 1,
        "distributed.worker.profile.enabled": False,
    }
    if not dashboard:
        settings["distributed.scheduler.http.routes"] = []
    page = {"dashboard": bool(dashboard), "dashboard_address": dashboard or "127.0.0.1:0"}
    with (
        dask.config.set(settings),
        LocalCluster(
            n_workers=workers or dask.system.CPU_COUNT,
            threads_per_worker=1,
            processes=True,
            host="127.0.0.1",
            dashboard_address=None,
            scheduler_kwargs=page,
            memory_limit=None,
            silence_logs=logging.CRITICAL,
        ) as cluster,
        Client(cluster, set_as_default=False) as client,
    ):
        client.register_plugin(_IgnoreInterrupt())
        yield client


@contextlib.contextmanager
def _connected(scheduler: str) -> Iterator[Client]:
    try:
        client = Client(scheduler, timeout=CONNECT_S, set_as_default=False)
    except (OSError, ValueError) as error:
        raise EngineError(
            f"scheduler {scheduler}: {line_of(error)}; expected the address of a running `dask scheduler`"
        ) from error
    with client:
        try:
            client.wait_for_workers(1, timeout=CONNECT_S)
        except TimeoutError as error:
            raise EngineError(f"scheduler {scheduler}: no workers; start `dask worker {scheduler}`") from error
        yield client


class _Dispatch(Generic[Task, Result]):
    """Sends groups of tasks to a cluster. Invariant: each task is waiting, suspected, in a group, or has an outcome."""

    def __init__(
        self, client: Client, function: Callable[[Task], Result], tasks: Sequence[Task], size: GroupSize
    ) -> None:
        self._client, self._tasks, self._size = client, tasks, size
        self._function = client.submit(_same, function, pure=False)  # a task of its own: sent to each worker once
        self._waiting = deque(range(len(tasks)))
        self._suspects: deque[int] = deque()
        """Tasks of groups whose workers were lost; each runs while nothing else does."""
        self._groups: dict[object, tuple[Future[Any], list[int]]] = {}
        self._ended: queue.SimpleQueue[tuple[object, Any]] = queue.SimpleQueue()
        """Keys of groups with what they returned, or their exception."""
        self._threads, self._counted_s = 1, 0.0

    def outcomes(self) -> Iterator[Outcomes[Result]]:
        """The outcomes of all tasks, as they end."""
        while self._waiting or self._suspects or self._groups:
            self._send()
            try:
                ended = self._ended.get(timeout=PULSE_S)
            except queue.Empty:
                yield []
            else:
                yield self._collect(*ended)

    def _send(self) -> None:
        self._count_threads()
        while self._waiting and not self._suspects and len(self._groups) < AHEAD * self._threads:
            size = self._size.next(len(self._waiting), self._threads)
            self._submit([self._waiting.popleft() for _ in range(size)])
        if self._suspects and not self._groups:
            self._submit([self._suspects.popleft()])

    def _submit(self, numbers: list[int]) -> None:
        tasks = [self._tasks[number] for number in numbers]
        future = self._client.submit(_run_group, self._function, tasks, __version__, pure=False)
        self._groups[future.key] = (future, numbers)
        future.add_done_callback(self._fetch)

    def _fetch(self, future: Future[Any]) -> None:
        """Get what a group has returned, on a thread of Dask: it waits if a worker was lost with the result.

        `Future.result(timeout)` is of no use here: when the time is over, it raises an UnboundLocalError.
        """
        try:
            found = future.result()
        except BaseException as error:  # cancellation is not an Exception
            found = error
        self._ended.put((future.key, found))

    def _count_threads(self) -> None:
        """Count the threads of the cluster, which may grow and shrink, once per second."""
        now_s = time.monotonic()
        if now_s - self._counted_s > 1.0:
            self._counted_s = now_s
            self._threads = max(1, sum(self._client.nthreads().values()))

    def _collect(self, key: object, found: Any) -> Outcomes[Result]:
        """The outcomes of a group that has ended: its seconds and results, or an exception."""
        _, numbers = self._groups.pop(key)
        if isinstance(found, KilledWorker):
            return self._suspect(numbers)
        if isinstance(found, BaseException):  # whatever the cluster says instead of running our code
            raise EngineError(f"the cluster does not run the tasks: {line_of(found)}") from found
        seconds, results = found
        self._size.add(len(numbers), seconds)
        return list(zip(numbers, results, strict=True))

    def _suspect(self, numbers: list[int]) -> Outcomes[Result]:
        if len(numbers) == 1 and not self._groups:
            return [(numbers[0], Failure("its process ended each time, without an exception"))]
        self._suspects += numbers
        return []


def _same(value: Result) -> Result:
    return value


def _run_group(
    function: Callable[[Task], Result], tasks: Sequence[Task], version: str
) -> tuple[float, list[Result | Failure]]:
    """Run tasks in a worker; return the seconds that they took, and their results."""
    if version != __version__:
        raise EngineError(f"a worker has version {__version__} of thymio_sim_ros, expected {version}, as here")
    with _one_at_a_time:
        started_s = time.monotonic()
        results = [attempt(function, task) for task in tasks]
        return time.monotonic() - started_s, results
