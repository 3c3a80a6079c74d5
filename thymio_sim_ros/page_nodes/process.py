"""A running node, seen from the suite: the process of its supervisor, started anew for each level of isolation.

A thread reads what the supervisor says and waits while a page reads slowly, so that the program waits in the end.
"""

from __future__ import annotations

import contextlib
import json
import os
import subprocess
import sys
import threading
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from socket import socket
from typing import Any

import thymio_sim_ros
from thymio_sim_ros.page_nodes.program import NodeProgram

__all__ = ["ISOLATED", "LEVELS", "Connect", "NodeProcess"]

ISOLATED = ("namespaces",) if sys.platform.startswith("linux") else ()
"""Levels of isolation (`grading.sandbox.levels`) for visitors of other computers: files and network of this one are
closed."""
LEVELS = (*ISOLATED, "landlock", "limits") if sys.platform.startswith("linux") else ("process",)
"""Those for the user of this computer, strongest first."""

_SUPERVISOR = "thymio_sim_ros.cli.ros.page_node.supervisor"
_NOT_CONNECTED = 2
"""Exit code of a node that the bridge rejects, at any level."""
_END_S = 15.0
"""Time in which a supervisor ends its node before it is killed."""
_UNAVAILABLE = "this computer gives no isolation for programs of others"

Connect = Callable[[], "socket | int"]
"""Gives each start of a node its way to the bridge, without TLS: one end of a connection, or, where a node can connect
by itself, a port of loopback. Called in the thread of the node."""

Report = Callable[[Mapping[str, Any]], object]
"""Called with each event of the supervisor, in the thread of the node; the last one is `ended`."""


class NodeProcess:
    """A node from its start to its end. All methods return at once, and may be called in any thread."""

    def __init__(
        self, program: NodeProgram, levels: Sequence[str], report: Report, connect: Connect, token: str = ""
    ) -> None:
        """Start it at the first of these levels that the computer gives. `token`: that of the bridge."""
        self._program, self._levels, self._report = program, tuple(levels), report
        self._connect, self._token = connect, token
        self.level = ""
        """The level that was tried last."""
        self._process: subprocess.Popen[bytes] | None = None
        self._is_ending = False
        self._lock = threading.Lock()
        """Guards `_process` and `_is_ending`: no supervisor starts after `end`."""
        self._thread = threading.Thread(target=self._run, name="page node", daemon=True)
        self._thread.start()

    def begin(self) -> None:
        """Begin the program, which is ready."""
        self._command(b"go\n")

    def stop(self) -> None:
        """End it as Ctrl-C does, by force if it does not end."""
        self._command(b"stop\n")

    def end(self) -> None:
        """End it by force, with all that it has started."""
        with self._lock:
            self._is_ending = True
            if self._process is not None and self._process.stdin is not None:
                with contextlib.suppress(OSError):
                    self._process.stdin.close()
                threading.Thread(target=_kill_late, args=(self._process,), daemon=True).start()

    def join(self, timeout_s: float) -> None:
        """Wait until it has ended."""
        self._thread.join(timeout_s)

    def _command(self, line: bytes) -> None:
        with self._lock:
            if self._process is not None and self._process.stdin is not None:
                with contextlib.suppress(OSError, ValueError):  # it has ended
                    self._process.stdin.write(line)
                    self._process.stdin.flush()

    def _run(self) -> None:
        reason = _UNAVAILABLE
        for level in self._levels:
            self.level = level
            ended, reason = self._run_at(level)
            if ended is not None:
                self._report(ended)
                return
        self._report({"event": "ended", "code": None, "reason": "isolation", "text": reason})

    def _run_at(self, level: str) -> tuple[Mapping[str, Any] | None, str]:
        """Run the node at a level; return its end, or None and why the level is not available."""
        process = self._start(level)
        if process is None:
            return {"event": "ended", "code": None, "reason": ""}, ""
        assert process.stdout is not None
        is_ready, words = False, ""
        early: list[str] = []
        with process:
            for line in process.stdout:
                event = _event(line)
                if event is None:  # a warning or traceback of the supervisor
                    words = line.decode("utf-8", "replace").strip() or words
                elif event["event"] == "unavailable":
                    return None, f"{event['reason']} {words}".strip()
                elif event["event"] == "ended":
                    is_isolation = not is_ready and event["code"] != _NOT_CONNECTED
                    if is_isolation and level != self._levels[-1] and not self._is_ending:
                        return None, "".join(early)
                    for each in early:
                        self._report({"event": "output", "text": each})
                    return event, ""
                elif not is_ready and event["event"] == "output":
                    early.append(event["text"])
                else:
                    is_ready = True
                    self._report(event)
        return {"event": "ended", "code": process.returncode, "reason": "lost", "text": words}, ""

    def _start(self, level: str) -> subprocess.Popen[bytes] | None:
        program = self._program
        with self._lock, contextlib.ExitStack() as stack:
            if self._is_ending:
                return None
            way = self._connect()
            port, link = (way, -1) if isinstance(way, int) else (0, stack.enter_context(way).fileno())
            process = self._process = subprocess.Popen(
                [sys.executable, "-P", "-m", _SUPERVISOR],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                env=_environment(),
                pass_fds=() if link < 0 else (link,),
            )
        job = {"level": level, "port": port, "link": link, "token": self._token}
        job |= {"file": program.name, "text": program.text, "arguments": program.arguments}
        assert process.stdin is not None
        with contextlib.suppress(OSError):  # `_run_at` finds its end
            process.stdin.write(json.dumps(job).encode() + b"\n")
            process.stdin.flush()
        return process


def _environment() -> dict[str, str]:
    """The variables of this process; the supervisor finds this package as it does."""
    folder = str(Path(thymio_sim_ros.__file__).resolve().parents[1])
    given = os.environ.get("PYTHONPATH", "")
    return {**os.environ, "PYTHONUTF8": "1", "PYTHONPATH": os.pathsep.join(filter(None, (folder, given)))}


def _event(line: bytes) -> Mapping[str, Any] | None:
    try:
        found = json.loads(line)
    except ValueError:
        return None
    return found if isinstance(found, dict) and isinstance(found.get("event"), str) else None


def _kill_late(process: subprocess.Popen[bytes]) -> None:
    with contextlib.suppress(subprocess.TimeoutExpired):
        process.wait(_END_S)
        return
    process.kill()
