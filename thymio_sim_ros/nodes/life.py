"""How our nodes live: one executor each, driven by one thread, ended in order.

A `Life` owns one rclpy node and what belongs to it. `run_main` gives it a process of its own
(`ros2 run`); `thymio` gives several of them a thread each in one process. Same behaviour both ways.
The shutdown pattern is the one of ros-packaging.md section 5 that always exits cleanly.
"""

from __future__ import annotations

import gc
import os
import signal
import sys
import threading
import traceback
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from types import FrameType
from typing import Protocol, runtime_checkable

import rclpy
from rclpy._rclpy_pybind11 import RCLError, UnknownROSArgsError
from rclpy.context import Context
from rclpy.executors import Executor, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

from thymio_sim_ros.nodes.leftovers import remove_half_made_ports

SWITCH_INTERVAL_S = 0.0005
"""How long a thread may keep the interpreter while others wait: a tenth of Python's default, since a command that waits
for 5 ms is 12 ticks late at 25 times real time (measured: the line follower strays 36 mm instead of 17 mm)."""

YOUNG_OBJECTS = 20_000
"""New objects after which Python looks for cycles among them, instead of 700: a tick of twenty robots makes more than
that, nearly all of which are gone soon (measured: 6 % of the simulator's time)."""

SPIN_SLICE_S = 0.1
"""Longest wait in one spin: the events executor needs finite time-outs (ros-packaging.md section 3)."""


MOST_FAULTS = 10
"""Turns that fail one after the other before a node gives up."""

CLOSE_S = 3.0
"""Longest time for leaving the graph: Fast DDS compares each endpoint with all others once more, which takes a minute
with a hundred robots. `ros2 launch` kills after 10 s, and Ctrl-C ends within 5 s, whatever programs do."""


class StartError(Exception):
    """A node cannot start for a reason that the user can mend; the text is one line."""


class Life(Protocol):
    """Something that owns a node: it is turned until it shall end, then closed."""

    @property
    def node(self) -> Node:
        """The ROS node."""

    def turn(self, executor: Executor) -> None:
        """Handle what is due; returns after `SPIN_SLICE_S` at the latest."""

    def end(self) -> None:
        """Nobody turns it any more: let wheels stand, close files and what people connect to. Twice does no harm."""

    def close(self) -> None:
        """`end` it, and take everything out of the graph."""


class Host(Life, Protocol):
    """A life that has something to say when it begins."""

    @property
    def greeting(self) -> str:
        """One line for a person: what there is, and where."""


@runtime_checkable
class Inviting(Protocol):
    """A life with addresses that contain a token."""

    @property
    def invitation(self) -> str:
        """The addresses, for standard output only: clients may read the log (/rosout). Empty: there is no token."""


def greeted(hosts: Iterable[Host]) -> Iterator[Life]:
    """The same lives, each with its greeting in the log, and its addresses with tokens on standard output."""
    for host in hosts:
        host.node.get_logger().info(host.greeting)
        if isinstance(host, Inviting) and host.invitation:
            with suppress(OSError):  # nobody reads it
                print(host.invitation, flush=True)
        yield host


def make_executor(context: Context) -> Executor:
    """The events executor where this rclpy has it, else the standard one (performance.md section 7)."""
    try:
        from rclpy.experimental.events_executor import EventsExecutor
    except ImportError:
        return SingleThreadedExecutor(context=context)
    return EventsExecutor(context=context)


def deliver(executor: Executor) -> None:
    """Handle all messages that are there now; `spin_once` of the events executor handles those of one entity."""
    last_in_line = executor.create_task(_nothing)
    while not last_in_line.done():
        executor.spin_once(timeout_sec=SPIN_SLICE_S)


def _nothing() -> None:
    """A task whose turn comes after everything that waited before it."""


def drive(life: Life, context: Context, stop: Callable[[], bool]) -> None:
    """Turn a life on an executor of its own until `stop` says so or the context ends.

    A fault of our own in a callback is logged and does not end a node that a class works with; `MOST_FAULTS` turns in a
    row that fail do.
    """
    executor = make_executor(context)
    executor.add_node(life.node)
    faults = 0
    try:
        while not stop() and context.ok():
            try:
                life.turn(executor)
                faults = 0
            except Exception:  # rclpy raises what a callback raises
                faults += 1
                if faults >= MOST_FAULTS or not context.ok():
                    raise
                life.node.get_logger().error(f"a fault of ours, and on it goes:\n{traceback.format_exc()}")
    finally:
        executor.remove_node(life.node)
        executor.shutdown()


class Threads:
    """Lives of one process, a thread each; the first failure ends all."""

    def __init__(self, context: Context) -> None:
        self._context = context
        self._ended = threading.Event()
        self._stop = threading.Event()
        self._running: list[tuple[Life, threading.Thread]] = []
        self.failure: BaseException | None = None

    def start(self, life: Life) -> None:
        """Give the life a thread."""
        thread = threading.Thread(target=self._drive, args=(life,), name=life.node.get_name())
        self._running.append((life, thread))
        thread.start()

    def wait(self) -> None:
        """Block until a life ends by itself or `request_end` is called."""
        while not self._ended.wait(SPIN_SLICE_S):
            pass

    def request_end(self) -> None:
        """Let `wait` return; safe in a signal handler."""
        self._ended.set()

    def end(self) -> None:
        """Stop all threads, then end the lives, last started first; once."""
        if self._stop.is_set():
            return
        self._stop.set()
        for _, thread in self._running:
            thread.join()
        for life, _ in reversed(self._running):
            life.end()

    def close(self) -> None:
        """`end` them, then close them in the same order."""
        self.end()
        for life, _ in reversed(self._running):
            life.close()
        self._running.clear()

    def _drive(self, life: Life) -> None:
        try:
            drive(life, self._context, self._stop.is_set)
        except Exception as error:
            self.failure = error
            life.node.get_logger().fatal(f"ended by {error!r}")
            traceback.print_exc()
        finally:
            self._ended.set()


def run_main(
    build: Callable[[Context], Iterable[Life]],
    args: Sequence[str] | None = None,
    *,
    executable: str = "",
    on_ready: Callable[[], None] = lambda: None,
) -> int:
    """Run the lives that `build` gives until SIGINT or SIGTERM; the exit code. `executable`: its name, with `args`.

    Each life gets its thread as soon as it is built; `on_ready` is called when all run. A `StartError` is one
    line on stderr and exit code 2, with nothing left running; arguments that are not of ROS likewise. Where DDS takes
    longer than `CLOSE_S` to forget all endpoints, the process ends without it.
    """
    words = sys.argv if args is None else [executable, *args]
    stray = _stray(words[1:])
    if stray:
        return _explain(Path(words[0]).name.removeprefix("thymio_"), stray)
    context = Context()
    threads = Threads(context)

    def end(_number: int, _frame: FrameType | None) -> None:
        threads.request_end()

    sys.setswitchinterval(SWITCH_INTERVAL_S)
    gc.set_threshold(YOUNG_OBJECTS, *gc.get_threshold()[1:])
    signal.signal(signal.SIGINT, end)
    signal.signal(signal.SIGTERM, end)
    remove_half_made_ports()
    code = 1
    try:
        _init(words[1:], context)
        for life in build(context):
            threads.start(life)
        on_ready()
        threads.wait()
        code = 1 if threads.failure else 0
    except StartError as error:
        print(f"thymio-sim: {error}", file=sys.stderr)
        code = 2
    finally:
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
        threads.end()
        with _at_most(CLOSE_S, code):
            threads.close()
            context.try_shutdown()
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


@contextmanager
def _at_most(seconds: float, code: int) -> Iterator[None]:
    """End the process with this code if what is done meanwhile takes longer; nothing that matters may be left to it."""

    def leave() -> None:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)

    timer = threading.Timer(seconds, leave)
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()


def _stray(words: Sequence[str]) -> list[str]:
    """What stands outside of `--ros-args … --`; rclpy's own function also drops a forgotten `-p`'s `NAME:=VALUE`."""
    stray, is_of_ros = [], False
    for word in words:
        if word == "--ros-args" or (word == "--" and is_of_ros):
            is_of_ros = word == "--ros-args"
        elif not is_of_ros and not word.startswith("__"):  # __ns:=/anna, as it was once written
            stray.append(word)
    return stray


def _explain(executable: str, stray: Sequence[str]) -> int:
    """How parameters are given: to who asks for it, and to who wrote something else; the exit code."""
    usage = (
        f"usage: ros2 run thymio_sim_ros {executable} --ros-args -p PARAMETER:=VALUE ...\n"
        "Its parameters while it runs: ros2 param list, ros2 param describe; all of them: docs/ros.md"
    )
    if set(stray) & {"-h", "--help"}:
        print(usage)
        return 0
    print(f"thymio-sim: argument '{stray[0]}' found, expected none but those of ROS\n{usage}", file=sys.stderr)
    return 2
