"""How our nodes live: one executor each, driven by one thread, ended in order.

A `RunnableNode` owns one rclpy node and what belongs to it. `run_main` gives it a process of its own
(`ros2 run`); `thymio` gives several of them a thread each in one process. Same behaviour both ways.
The shutdown pattern is the one of docs/spec/ros-packaging.md section 5 that always exits cleanly.
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

from thymio_sim_ros.ros.compat.shm_cleanup import remove_incomplete_ports
from thymio_sim_ros.ros.rclpy_ext import log_directory

SWITCH_INTERVAL_S = 0.0005
"""How long a thread may keep the interpreter while others wait: a tenth of Python's default, since a command that waits
for 5 ms is 12 ticks late at 25 times real time (measured: the line follower strays 36 mm instead of 17 mm)."""

GC_THRESHOLD = 20_000
"""New objects after which Python looks for cycles among them, instead of 700: a tick of twenty robots makes more than
that, nearly all of which are gone soon (measured: 6 % of the simulator's time)."""

SPIN_SLICE_S = 0.1
"""Longest wait in one spin: the events executor needs finite time-outs (docs/spec/ros-packaging.md section 3)."""


MAX_CONSECUTIVE_ERRORS = 10
"""Turns that fail one after the other before a node gives up."""

STOP_S = 1.5
"""Longest time for all threads to come to the end of their turns; then they count as stuck."""

LEAVE_S = 4.0
"""Longest time from Ctrl-C to the end of the process: Fast DDS compares each endpoint with all others once more, which
takes a minute with a hundred robots. `ros2 launch` kills after 10 s."""

LAST_RESORT_S = 0.5
"""So much later the process ends even if no thread gets the interpreter, which a call into DDS may keep."""


STUCK = 1
"""Exit code of a process with a thread that did not stop."""


class StartError(Exception):
    """A node cannot start for a reason that the user can mend; the text is one line."""


class RunnableNode(Protocol):
    """Something that owns a node: it is turned until it shall end, then closed."""

    @property
    def node(self) -> Node:
        """The ROS node."""

    def run_once(self, executor: Executor) -> None:
        """Handle what is due; returns after `SPIN_SLICE_S` at the latest."""

    def stop(self) -> None:
        """Nobody turns it any more: let wheels stand, close files and what people connect to. Twice does no harm."""

    def close(self) -> None:
        """`end` it, and take everything out of the graph."""


class AnnouncedNode(RunnableNode, Protocol):
    """A runnable that has something to say when it begins."""

    @property
    def startup_message(self) -> str:
        """One line for a person: what there is, and where."""


@runtime_checkable
class HasAccessUrls(Protocol):
    """A runnable with addresses that contain a token."""

    @property
    def access_urls(self) -> str:
        """The addresses, for standard output only: clients may read the log (/rosout). Empty: there is no token."""


def announce(nodes: Iterable[AnnouncedNode]) -> Iterator[RunnableNode]:
    """The same lives, each with its greeting in the log, and its addresses with tokens on standard output."""
    for node in nodes:
        node.node.get_logger().info(node.startup_message)
        if isinstance(node, HasAccessUrls) and node.access_urls:
            with suppress(OSError):  # nobody reads it
                print(node.access_urls, flush=True)
        yield node


def make_executor(context: Context) -> Executor:
    """The events executor where this rclpy has it, else the standard one (docs/spec/ros-packaging.md section 3)."""
    try:
        from rclpy.experimental.events_executor import EventsExecutor
    except ImportError:
        return SingleThreadedExecutor(context=context)
    return EventsExecutor(context=context)


def deliver(executor: Executor) -> None:
    """Handle all messages that are there now; `spin_once` of the events executor handles those of one entity."""
    last_in_line = executor.create_task(_no_op)
    while not last_in_line.done():
        executor.spin_once(timeout_sec=SPIN_SLICE_S)


def _no_op() -> None:
    """A task whose turn comes after everything that waited before it."""


def run_node(runnable: RunnableNode, context: Context, stop: Callable[[], bool]) -> None:
    """Spin a node on its own executor until `stop()` is true or the context is shut down.

    An exception in a callback is logged as an internal error and the node continues, so that one bug does not interrupt
    a lesson. After `MAX_CONSECUTIVE_ERRORS` failed iterations in a row the exception is raised.
    """
    executor = make_executor(context)
    executor.add_node(runnable.node)
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
                runnable.node.get_logger().error(f"a fault of ours, and on it goes:\n{traceback.format_exc()}")
    finally:
        executor.remove_node(runnable.node)
        executor.shutdown()


class NodeRunner:
    """Lives of one process, a thread each; the first failure ends all."""

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
        """Give the runnable a thread, which does not keep the process alive."""
        thread = threading.Thread(target=self._run_node, args=(runnable,), name=runnable.node.get_name(), daemon=True)
        self._running.append((runnable, thread))
        thread.start()

    def wait(self) -> None:
        """Block until a runnable ends by itself or `request_end` is called."""
        while not self._is_end_requested and not self._ended.wait(SPIN_SLICE_S):
            pass

    def request_end(self) -> None:
        """Let `wait` return; safe in a signal handler, which may have interrupted a thread that holds a lock."""
        self._is_end_requested = True

    def stop(self) -> None:
        """Stop all runner, then end the lives whose threads have stopped, last started first; once.

        It takes at most `STOP_S` for the runner. One that is stuck is reported, with the place where it is.
        """
        with self._ending:
            if self._stop.is_set():
                return
            self._stop.set()
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
        """`end` them, then close them in the same order; not where a thread is stuck, which may use any of them."""
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
    """Where a thread is now, as a traceback."""
    frame = sys._current_frames().get(thread.ident or 0)
    return "it has just ended" if frame is None else f"it is here:\n{''.join(traceback.format_stack(frame))}"


def run_main(
    build: Callable[[Context], Iterable[RunnableNode]],
    args: Sequence[str] | None = None,
    *,
    executable: str = "",
    on_ready: Callable[[], None] = lambda: None,
) -> int:
    """Run the lives that `build` gives until SIGINT or SIGTERM; the exit code. `executable`: its name, with `args`.

    Each runnable gets its thread as soon as it is built; `on_ready` is called when all run. A `StartError` is one
    line on stderr and exit code 2, with nothing left running; arguments that are not of ROS likewise. `LEAVE_S` after
    a signal the process ends in any case: with 0 where only DDS is slow to forget all endpoints, with 1 where a thread
    does not stop.
    """
    words = sys.argv if args is None else [executable, *args]
    extra = _extra_arguments(words[1:])
    if extra:
        return _report_usage(Path(words[0]).name.removeprefix("thymio_"), extra)
    log_directory.ensure()
    context = Context()
    runner = NodeRunner(context)
    watchdog = _ExitWatchdog(runner)

    def end(_number: int, _frame: FrameType | None) -> None:
        runner.request_end()
        watchdog.start()

    sys.setswitchinterval(SWITCH_INTERVAL_S)
    gc.set_threshold(GC_THRESHOLD, *gc.get_threshold()[1:])
    signal.signal(signal.SIGINT, end)
    signal.signal(signal.SIGTERM, end)
    remove_incomplete_ports()
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
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
        watchdog.start()
        watchdog.code = code
        runner.close()
        if runner.is_stuck:
            watchdog.exit_now()
        context.try_shutdown()
        watchdog.cancel()
    return code


def _init(words: Sequence[str], context: Context) -> None:
    """Begin with these arguments; StartError for one that ROS does not understand."""
    try:
        rclpy.init(args=list(words), context=context, signal_handler_options=SignalHandlerOptions.NO)
    except UnknownROSArgsError as error:
        raise StartError(f"no arguments of ROS: {error}") from error
    except RCLError as error:
        reason = str(error).removeprefix("failed to initialize rcl: ").partition(". Error:")[0]
        raise StartError(f"ROS does not begin: {reason}") from error


class _ExitWatchdog:
    """Ends the process `LEAVE_S` after the begin, whatever its threads do; `end` calls that off.

    The thread that waits for it also ends the lives, if the main thread is still busy with building one.
    """

    def __init__(self, runner: NodeRunner) -> None:
        self._runner = runner
        self._is_started = False
        self._is_over = threading.Event()
        self.code = 0
        """That of the process, unless a thread is stuck."""

    def start(self) -> None:
        """Start to count, once; safe in a signal handler: no lock of Python's is taken here."""
        if self._is_started:
            return
        self._is_started = True
        self._nowhere = open(os.devnull, "w")  # noqa: SIM115  # as long as the process
        faulthandler.dump_traceback_later(LEAVE_S + LAST_RESORT_S, exit=True, file=self._nowhere)
        _thread.start_new_thread(self._wait, ())

    def cancel(self) -> None:
        """All has ended in order."""
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


def _extra_arguments(words: Sequence[str]) -> list[str]:
    """What stands outside of `--ros-args … --`; rclpy's own function also drops a forgotten `-p`'s `NAME:=VALUE`."""
    extra, is_of_ros = [], False
    for word in words:
        if word == "--ros-args" or (word == "--" and is_of_ros):
            is_of_ros = word == "--ros-args"
        elif not is_of_ros and not word.startswith("__"):  # __ns:=/anna, as it was once written
            extra.append(word)
    return extra


def _report_usage(executable: str, extra: Sequence[str]) -> int:
    """How parameters are given: to who asks for it, and to who wrote something else; the exit code."""
    usage = (
        f"usage: ros2 run thymio_sim_ros {executable} --ros-args -p PARAMETER:=VALUE ...\n"
        "Its parameters while it runs: ros2 param list, ros2 param describe; all of them: docs/ros.md"
    )
    if set(extra) & {"-h", "--help"}:
        print(usage)
        return 0
    print(f"thymio-sim: argument '{extra[0]}' found, expected none but those of ROS\n{usage}", file=sys.stderr)
    return 2
