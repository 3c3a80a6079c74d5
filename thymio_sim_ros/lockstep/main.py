"""The process of a program under test: `python -m thymio_sim_ros.lockstep.main JSON`, started by the test only.

Everything that waits is replaced first, then rclpy is imported, then the program runs as `__main__`.
"""

from __future__ import annotations

import faulthandler
import importlib
import json
import os
import random
import runpy
import signal
import sys
import traceback
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType, TracebackType
from typing import TYPE_CHECKING, Any

from thymio_sim_ros import course_packages
from thymio_sim_ros.lockstep import clocks, keyboard, real_time, threads
from thymio_sim_ros.lockstep.channel import Channel, ClosedError
from thymio_sim_ros.lockstep.turns import Turns

if TYPE_CHECKING:
    from thymio_sim_ros.lockstep.program_graph import ProgramGraph

STACKS_SIGNAL = getattr(signal, "SIGXCPU", None)
"""On this signal the process writes the stacks of all threads to a file. Windows lacks it."""

INTERRUPTED = 130

FORKED_TURN_S = 0.01
"""Duration of a turn of a process that the program forked, in simulated and real time."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Options:
    """Options for a program; one of `file`, `module` and `function` is set."""

    read_fd: int
    write_fd: int
    stacks_fd: int
    name: str
    """A name that no other program of the test has; letters and digits."""
    file: str = ""
    module: str = ""
    function: str = ""
    """An entry point: `package.module:function`."""
    folder: str
    """First place for imports."""
    arguments: list[str]
    is_embedded: bool = True
    """Whether its nodes are on the embedded graph, not on that of an installed ROS 2."""
    seed: int = 0


class Session:
    """The side of the program: it ends turns and gets the next ones."""

    def __init__(self, options: Options) -> None:
        self._channel = Channel(options.read_fd, options.write_fd)
        self.turns = Turns(self.end_turn)
        threads.install(self.turns)
        clocks.install(self.turns)
        self._keyboard = keyboard.install(self.turns)
        self._graph: ProgramGraph = self._made_graph(options)
        self._is_forked = False
        os.register_at_fork(after_in_child=self._leave_test)

    def _made_graph(self, options: Options) -> ProgramGraph:
        """The graph of the program; imported now, since it is made of what has been replaced."""
        if options.is_embedded:
            from thymio_sim_ros.lockstep.program_graph import EmbeddedGraph

            return EmbeddedGraph(self.turns)
        from thymio_sim_ros.lockstep.installed_ros import waits
        from thymio_sim_ros.lockstep.installed_ros.graph import InstalledGraph

        waits.install(self.turns)
        return InstalledGraph(options.name, self.settle, self.turns.poll)

    def begin(self) -> None:
        """Get the first turn."""
        self._send("ready")
        self._receive_turn()

    def end_turn(self) -> None:
        """All threads wait: end the turn and wait for the next one."""
        if self._is_forked:
            real_time.sleep(FORKED_TURN_S)
            self.turns.begin(self.turns.until_ns, self.turns.until_ns + round(FORKED_TURN_S * clocks.SECOND_NS))
            return
        if self._graph.has_new:
            self.settle()
        self._send("done", waits=[thread.waits_for for thread in self.turns.threads], next_ns=self.turns.next_ns)
        self._receive_turn()

    def settle(self) -> None:
        """Wait in real time until new endpoints are matched."""
        if self._is_forked:
            return
        self._send("settle")
        self._graph.match(self._receive()["match"])

    def end(self) -> None:
        """Send what comes before the end of the process."""
        if self._graph.has_new:
            self.settle()
        if not self._is_forked:
            self._send("ending")

    def _leave_test(self) -> None:
        """In a process that the program forked: real time passes, and the connection is that of the program only."""
        self._is_forked = True
        self._channel.close()
        self._graph.leave_test()
        self.turns.keep_only_running()

    def _send(self, event: str, **values: Any) -> None:
        try:
            self._channel.send({"event": event, **self._graph.outgoing(event), **values})
        except ClosedError:
            os._exit(1)

    def _receive(self) -> dict[str, Any]:
        try:
            return self._channel.receive()
        except ClosedError:  # the test has ended
            os._exit(1)

    def _receive_turn(self) -> None:
        while "match" in (message := self._receive()):
            self._graph.match(message["match"])
            self._channel.send({"event": "matched"})
        self._graph.receive(message)
        for at_ns, line in message["lines"]:
            self._keyboard.type(at_ns, line)
        self._keyboard.is_closed_after = message["is_closed_after"]
        self.turns.begin(message["now_ns"], message["until_ns"])
        if message["is_interrupted"]:
            self._interrupt()

    def _interrupt(self) -> None:
        """Do what Ctrl-C does: rclpy shuts down, and Python raises KeyboardInterrupt in the main thread."""
        from rclpy.utilities import try_shutdown

        try_shutdown()
        self.turns.interrupt()


def main() -> None:
    """Run a program, and exit with its code."""
    options = Options(**json.loads(sys.argv[1]))
    for fd in (options.read_fd, options.write_fd, options.stacks_fd):
        os.set_inheritable(fd, False)  # positional only
    assert STACKS_SIGNAL is not None
    faulthandler.register(STACKS_SIGNAL, file=options.stacks_fd, all_threads=True)
    session = Session(options)
    session.begin()
    random.seed(options.seed)
    code = _run(options)
    try:
        threads.join_all()
    except KeyboardInterrupt as error:
        _print(error)
        session.end()
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(INTERRUPTED)  # Python would wait for threads that get no turn
    sys.stdout.flush()
    session.end()
    sys.exit(code)


def _run(options: Options) -> int | str | None:
    """Run the program; return what `sys.exit` takes."""
    sys.path[0] = options.folder
    course_packages.add_to_path()
    sys.argv = [options.file or options.module or options.function, *options.arguments]
    try:
        if options.file:
            _run_file(Path(options.file))
        elif options.module:
            runpy.run_module(options.module, run_name="__main__", alter_sys=True)
        else:
            module, _, function = options.function.partition(":")
            sys.exit(getattr(importlib.import_module(module), function)())
    except SystemExit as end:
        return end.code
    except KeyboardInterrupt as error:
        _print(error)
        return INTERRUPTED
    except BaseException as error:
        _print(error)
        return 1
    return 0


def _run_file(path: Path) -> None:
    module: Any = ModuleType("__main__")
    module.__file__ = str(path)
    sys.modules["__main__"] = module
    exec(compile(path.read_bytes(), str(path), "exec"), vars(module))


def _print(error: BaseException) -> None:
    """Print a traceback without the frames of this package."""
    here = str(Path(__file__).parent)
    frame: TracebackType | None = error.__traceback__
    while frame is not None and frame.tb_frame.f_code.co_filename.startswith((here, "<frozen", runpy.__file__)):
        frame = frame.tb_next
    traceback.print_exception(type(error), error, frame)


if __name__ == "__main__":
    main()
