"""Runs nodes, each with its own executor and thread, and shuts them down in order.

A `RunnableNode` owns one rclpy node and its resources. `run_main` runs one in its own process (`ros2 run`), or several
in one process with one thread each (`thymio`), with the same behavior.
The shutdown sequence follows docs/spec/ros-packaging.md section 5, so that the process always exits cleanly.
"""

from __future__ import annotations

import _thread
import faulthandler
import gc
import os
import signal
import sys
import threading
import time
import traceback
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from types import FrameType
from typing import Protocol, runtime_checkable

import rclpy
from rclpy._rclpy_pybind11 import RCLError, UnknownROSArgsError
from rclpy.context import Context
from rclpy.executors import Executor, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

from thymio_sim_ros.end_signals import END_SIGNALS
from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.ros.compat.shm_cleanup import remove_abandoned
from thymio_sim_ros.ros.rclpy_ext import log_directory
from thymio_sim_ros.ros.rclpy_ext.peers import HasPeers

SWITCH_INTERVAL_S = 0.0005
"""Thread switch interval of the interpreter, a tenth of Python's default: at 25 times real time, a command that waits
for 5 ms is 12 ticks late (measured: the line follower deviates by 36 mm instead of 17 mm)."""

GC_THRESHOLD = 20_000
"""Threshold of the youngest garbage collector generation, instead of 700: one tick of twenty robots allocates more than
that, and nearly all of it is freed soon (measured: 6 % of the simulator's time)."""

SPIN_SLICE_S = 0.1
"""Longest wait of one spin: the events executor needs finite time-outs (docs/spec/ros-packaging.md section 3)."""


MAX_CONSECUTIVE_ERRORS = 10
"""Consecutive failed iterations after which a node ends."""

STOP_S = 1.5
"""Longest time for all threads to finish their current iteration; after that they count as stuck."""

LEAVE_S = 4.0
"""Longest time from Ctrl-C to the end of the process. Fast DDS compares each endpoint with all others on shutdown, for
a minute with a hundred robots. `ros2 launch` kills after 10 s."""

CLOCK_JUMP_S = 0.5
"""Jump of the system clock after which the nodes are not destroyed. Fast DDS 2.14 considers a shared-memory port dead
if its listener has not been seen for a second of that clock. When a jump (a suspended laptop) makes it seem so, its
thread replaces the port while the destruction of the participant uses it, and the process crashes (measured: 6 of 7
ends). Other nodes then forget this participant when its lease ends, after 20 s."""

LAST_RESORT_S = 0.5
"""After this additional time the process ends even if a call into DDS holds the interpreter lock."""


STUCK = 1
"""Exit code if a thread did not stop."""


class StartError(ThymioSimError):
    """A node cannot start for a reason that the user can fix; the message is one line."""


class RunnableNode(Protocol):
    """An object that owns a node; its runner calls `run_once` repeatedly, then `stop` and `close`."""

    @property
    def node(self) -> Node:
        """The ROS node."""

    def run_once(self, executor: Executor) -> None:
        """Do what is due and return within `SPIN_SLICE_S`."""

    def stop(self) -> None:
        """Stop wheels, close files and server ports. Called after the last `run_once`; may be called twice."""

    def close(self) -> None:
        """Call `stop`, then destroy the node and all its endpoints."""


class AnnouncedNode(RunnableNode, Protocol):
    """A node that logs a message when it starts."""

    @property
    def startup_message(self) -> str:
        """One line for the user: what runs, and where."""


@runtime_checkable
class Interruptible(Protocol):
    """A node with callbacks that can take longer than `STOP_S`."""

    def interrupt(self) -> None:
        """Make the present `run_once` return soon. Called on another thread, before `stop`."""


@runtime_checkable
class HasAccessUrls(Protocol):
    """A node with URLs that contain an access token."""

    @property
    def access_urls(self) -> str:
        """The URLs, for standard output only, since clients may read the log (/rosout). Empty without a token."""


def announce(nodes: Iterable[AnnouncedNode]) -> Iterator[RunnableNode]:
    """Yield the nodes; log each startup message, and print URLs with tokens to standard output."""
    for node in nodes:
        for part in (node, *getattr(node, "attached", ())):
            part.node.get_logger().info(part.startup_message)
        if isinstance(node, HasAccessUrls) and node.access_urls:
            with suppress(OSError):  # standard output is closed
                print(node.access_urls, flush=True)
        yield node


def make_executor(context: Context) -> Executor:
    """Return an events executor if rclpy has one, else the standard one (docs/spec/ros-packaging.md section 3)."""
    try:
        from rclpy.experimental.events_executor import EventsExecutor
    except ImportError:
        return SingleThreadedExecutor(context=context)
    return EventsExecutor(context=context)


def deliver(executor: Executor) -> None:
    """Handle all messages that have arrived.

    `spin_once` of the events executor handles one entity only. Tasks run in order, so a task created now is done when
    everything queued before it has been handled.
    """
    last_in_line = executor.create_task(_no_op)
    while not last_in_line.done():
        executor.spin_once(timeout_sec=SPIN_SLICE_S)


def _no_op() -> None:
    """Task that marks the end of the queue."""


def nodes_of(runnable: RunnableNode) -> tuple[Node, ...]:
    """The ROS nodes that the executor of a node spins."""
    return (runnable.node, *(runnable.peers if isinstance(runnable, HasPeers) else ()))


def run_node(runnable: RunnableNode, context: Context, stop: Callable[[], bool]) -> None:
    """Spin a node on its own executor until `stop()` is true or the context is shut down.

    An exception in a callback is logged as an internal error and the node continues, so that one bug does not interrupt
    a lesson. After `MAX_CONSECUTIVE_ERRORS` failed iterations in a row the exception is raised.
    """
    executor = make_executor(context)
    nodes = nodes_of(runnable)
    for node in nodes:
        executor.add_node(node)
    errors = 0
    try:
        while not stop() and context.ok():
            try:
                runnable.run_once(executor)
                errors = 0
            except Exception:  # rclpy raises what a callback raises
                errors += 1
                if errors >= MAX_CONSECUTIVE_ERRORS or not context.ok():
                    raise
                runnable.node.get_logger().error(
                    f"internal error (please report); continuing:\n{traceback.format_exc()}"
                )
    finally:
        for node in nodes:
            executor.remove_node(node)
        executor.shutdown()


class NodeRunner:
    """Runs the nodes of one process, with one thread each; the first failure ends all."""

    def __init__(self, context: Context) -> None:
        self._context = context
        self._ended = threading.Event()
        self._is_end_requested = False
        self._stop = threading.Event()
        self._ending = threading.Lock()
        self._running: list[tuple[RunnableNode, threading.Thread]] = []
        self.failure: BaseException | None = None
        self.is_stuck = False
        """Whether a thread did not stop."""

    @property
    def is_end_requested(self) -> bool:
        """Whether `request_end` was called."""
        return self._is_end_requested

    def start(self, runnable: RunnableNode) -> None:
        """Run a node on a new daemon thread."""
        thread = threading.Thread(target=self._run_node, args=(runnable,), name=runnable.node.get_name(), daemon=True)
        self._running.append((runnable, thread))
        thread.start()

    def wait(self) -> None:
        """Block until a node ends or `request_end` is called."""
        while not self._is_end_requested and not self._ended.wait(SPIN_SLICE_S):
            pass

    def request_end(self) -> None:
        """Make `wait` return. Safe in signal handlers: takes no lock that the interrupted thread might hold."""
        self._is_end_requested = True

    def stop(self) -> None:
        """Stop all threads within `STOP_S`, then call `stop` of their nodes, last started first. Runs once.

        A stuck thread is logged with its stack trace, and its node is skipped.
        """
        with self._ending:
            if self._stop.is_set():
                return
            self._stop.set()
            for runnable, _ in self._running:
                if isinstance(runnable, Interruptible):
                    runnable.interrupt()
            deadline = time.monotonic() + STOP_S
            for _, thread in self._running:
                thread.join(max(0.0, deadline - time.monotonic()))
            stuck = [(runnable, thread) for runnable, thread in self._running if thread.is_alive()]
            self.is_stuck = bool(stuck)
            for runnable, thread in reversed(self._running):
                if not thread.is_alive():
                    runnable.stop()
            for runnable, thread in stuck:
                runnable.node.get_logger().fatal(f"{thread.name} did not stop within {STOP_S:g} s; {_place(thread)}")

    def close(self) -> None:
        """Call `stop`, then close all nodes in the same order, unless a thread is stuck: it may use any of them."""
        self.stop()
        if self.is_stuck:
            return
        for runnable, _ in reversed(self._running):
            runnable.close()
        self._running.clear()

    def _run_node(self, runnable: RunnableNode) -> None:
        try:
            run_node(runnable, self._context, self._stop.is_set)
        except Exception as error:
            self.failure = error
            runnable.node.get_logger().fatal(f"ended by {error!r}")
            traceback.print_exc()
        finally:
            self._ended.set()


def _place(thread: threading.Thread) -> str:
    """Return the current stack trace of a thread as text."""
    frame = sys._current_frames().get(thread.ident or 0)
    return "it has just ended" if frame is None else f"it is here:\n{''.join(traceback.format_stack(frame))}"


def run_main(
    build: Callable[[Context], Iterable[RunnableNode]],
    args: Sequence[str] | None = None,
    *,
    executable: str = "",
    on_ready: Callable[[], None] = lambda: None,
) -> int:
    """Run the nodes that `build` yields until one of END_SIGNALS and return the exit code.

    Each node gets its thread as soon as it is built; `on_ready` is called when all are running. A `StartError` or a
    non-ROS argument is reported in one line on stderr with exit code 2, and nothing is left running. `LEAVE_S` after a
    signal the process ends in any case: with code 0 if only DDS is slow to remove endpoints, with 1 if a thread does
    not stop. After a jump of the system clock it ends without destroying the nodes (`CLOCK_JUMP_S`).

    Args:
        build: Called with the context; a generator, so that the first nodes run while the next ones are built.
        args: ROS arguments; None for those of the process.
        executable: Name of the program, used with `args`.
        on_ready: Called when all nodes run.
    """
    words = sys.argv if args is None else [executable, *args]
    extra = _extra_arguments(words[1:])
    if extra:
        return _report_usage(Path(words[0]).name.removeprefix("thymio_"), extra)
    log_directory.ensure()
    context = Context()
    runner = NodeRunner(context)
    watchdog = _ExitWatchdog(runner)
    offset_s = _clock_offset_s()

    def end(_number: int, _frame: FrameType | None) -> None:
        runner.request_end()
        watchdog.start()

    sys.setswitchinterval(SWITCH_INTERVAL_S)
    gc.set_threshold(GC_THRESHOLD, *gc.get_threshold()[1:])
    for number in END_SIGNALS:
        signal.signal(number, end)
    remove_abandoned()
    code = 1
    try:
        _init(words[1:], context)
        for runnable in build(context):
            runner.start(runnable)
            if runner.is_end_requested:
                break
        else:
            on_ready()
        runner.wait()
        code = 1 if runner.failure else 0
    except StartError as error:
        print(f"thymio-sim: {error}", file=sys.stderr)
        code = 2
    finally:
        for number in END_SIGNALS:
            signal.signal(number, signal.SIG_IGN)
        watchdog.start()
        watchdog.code = code
        runner.stop()
        if runner.is_stuck or abs(_clock_offset_s() - offset_s) > CLOCK_JUMP_S:
            watchdog.exit_now()
        runner.close()
        context.try_shutdown()
        watchdog.cancel()
    return code


def _init(words: Sequence[str], context: Context) -> None:
    """Initialize the context. Raises StartError for arguments that ROS does not understand."""
    try:
        rclpy.init(args=list(words), context=context, signal_handler_options=SignalHandlerOptions.NO)
    except UnknownROSArgsError as error:
        raise StartError(f"not ROS arguments: {error}") from error
    except RCLError as error:
        reason, _, detail = str(error).removeprefix("failed to initialize rcl: ").partition(". Error: ")
        is_of_file = "--params-file" in reason  # only there is the detail for a user: what is wrong in which line
        detail = f": {detail.partition(', at ')[0]}" if is_of_file and detail else ""
        raise StartError(f"ROS cannot be initialized: {reason}{detail}") from error


class _ExitWatchdog:
    """Ends the process `LEAVE_S` after `start`, whatever its threads do, unless `cancel` is called.

    If the main thread is still building a node after `STOP_S`, the waiting thread stops the running nodes.
    """

    def __init__(self, runner: NodeRunner) -> None:
        self._runner = runner
        self._is_started = False
        self._is_over = threading.Event()
        self.code = 0
        """Exit code of the process, unless a thread is stuck."""

    def start(self) -> None:
        """Start the countdown, once. Safe in signal handlers: takes no Python lock."""
        if self._is_started:
            return
        self._is_started = True
        self._nowhere = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115  # as long as the process
        faulthandler.dump_traceback_later(LEAVE_S + LAST_RESORT_S, exit=True, file=self._nowhere)
        _thread.start_new_thread(self._wait, ())

    def cancel(self) -> None:
        """Cancel the countdown: the process ends normally."""
        if self._is_started:
            faulthandler.cancel_dump_traceback_later()
            self._nowhere.close()
        self._is_over.set()

    def exit_now(self) -> None:
        """End the process now."""
        with suppress(OSError, ValueError):
            sys.stdout.flush()
            sys.stderr.flush()
        os._exit(STUCK if self._runner.is_stuck else self.code)

    def _wait(self) -> None:
        deadline = time.monotonic() + LEAVE_S
        if self._is_over.wait(min(STOP_S, LEAVE_S)):
            return
        ender = threading.Thread(target=self._runner.stop, daemon=True)
        ender.start()
        if not self._is_over.wait(deadline - time.monotonic()):
            self.exit_now()


def _clock_offset_s() -> float:
    """Difference between the system clock and the monotonic clock; it changes if the system clock jumps."""
    return time.time() - time.monotonic()


def _extra_arguments(words: Sequence[str]) -> list[str]:
    """Return the arguments outside `--ros-args … --`.

    rclpy's function is not used: it also drops `NAME:=VALUE` without `-p`, which is a common mistake.
    """
    extra, is_of_ros = [], False
    for word in words:
        if word == "--ros-args" or (word == "--" and is_of_ros):
            is_of_ros = word == "--ros-args"
        elif not is_of_ros and not word.startswith("__"):  # __ns:=/anna, the old syntax
            extra.append(word)
    return extra


def _report_usage(executable: str, extra: Sequence[str]) -> int:
    """Print the usage, for `--help` or as an error message, and return the exit code."""
    usage = (
        f"usage: ros2 run thymio_sim_ros {executable} --ros-args -p PARAMETER:=VALUE ...\n"
        "Its parameters while it runs: ros2 param list, ros2 param describe; all of them: docs/ros.md"
    )
    if set(extra) & {"-h", "--help"}:
        print(usage)
        return 0
    print(f"thymio-sim: found argument '{extra[0]}', expected ROS arguments only\n{usage}", file=sys.stderr)
    return 2
