"""The suite as a process of its own, and what processes cost."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from tests.processes import Process, free_port, wait_for_port

SUITE = "thymio_sim_ros.cli.main"


@dataclass(frozen=True)
class Suite:
    """A running `thymio-sim`: its process, and the ports of its page and of its bridge."""

    process: Process
    page_port: int
    bridge_port: int


@contextlib.contextmanager
def suite(*arguments: str) -> Iterator[Suite]:
    """Run `thymio-sim` with these arguments while the context lasts; yields it once bridge and page listen."""
    import rclpy  # noqa: F401  # the suite needs it

    page_port, bridge_port = free_port(), free_port()
    ports = ("--port", str(page_port), "--foxglove-port", str(bridge_port))
    with tempfile.TemporaryDirectory() as folder:
        process = Process(Path(folder), SUITE, *ports, *arguments)
        try:
            wait_for_port(bridge_port)
            if "--no-web" not in arguments:
                wait_for_port(page_port)
            yield Suite(process, page_port, bridge_port)
        finally:
            process.end()


@contextlib.contextmanager
def child(code: str, *arguments: str) -> Iterator[int]:
    """Run Python code in a process group of its own while the context lasts; yields the process id."""
    process = subprocess.Popen([sys.executable, "-c", code, *arguments], stdout=subprocess.DEVNULL, process_group=0)
    try:
        yield process.pid
    finally:
        process.send_signal(signal.SIGINT)
        try:
            process.wait(10.0)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()


def cpu_s(pid: int) -> float:
    """CPU seconds that the threads of a process have used, as the scheduler counts them: ticks of 10 ms are too few."""
    tasks = Path(f"/proc/{pid}/task").glob("*/schedstat")
    return sum(int(task.read_text(encoding="ascii").split()[0]) for task in tasks) / 1e9


def pss_mb(pid: int) -> float:
    """Return the proportional set size of a process: memory that n processes share counts 1/n."""
    for line in Path(f"/proc/{pid}/smaps_rollup").read_text(encoding="ascii").splitlines():
        if line.startswith("Pss:"):
            return int(line.split()[1]) / 1024
    return 0.0
