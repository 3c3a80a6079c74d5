"""The processes of a submission where no kernel keeps them together: all are found, counted and ended."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator

import pytest

from tests.patience import until
from thymio_sim_ros.grading.assignment import Limits

psutil = pytest.importorskip("psutil")
tracked_processes = pytest.importorskip("thymio_sim_ros.grading.sandbox.tracked_processes", exc_type=ImportError)

pytestmark = pytest.mark.process

FAMILY = """
import os, subprocess, sys
wait = [sys.executable, "-c", "import time; time.sleep(10000)"]
child = subprocess.Popen(wait)
leaver = subprocess.Popen(wait, start_new_session=True)
middle = "import subprocess, sys; print(subprocess.Popen(sys.argv[1:], stdout=subprocess.DEVNULL).pid)"
orphan = subprocess.run([sys.executable, "-c", middle, *wait], stdout=subprocess.PIPE, check=True).stdout
print(child.pid, leaver.pid, int(orphan), flush=True)
while True: pass
"""


@pytest.fixture
def family() -> Iterator[tuple[object, subprocess.Popen[bytes], list[int]]]:
    """The tracker, a busy process, and its child, its child with a session of its own, and its orphaned grandchild.

    Another child of this process is left alone.
    """
    tracked = tracked_processes.TrackedProcesses(Limits())
    started = subprocess.Popen([sys.executable, "-c", FAMILY], stdout=subprocess.PIPE, **tracked.options())
    tracked.started(started)
    assert started.stdout is not None
    with started.stdout as output:
        pids = list(map(int, output.readline().split()))
    with subprocess.Popen([sys.executable, "-c", "import sys; sys.stdin.read()"], stdin=subprocess.PIPE) as other:
        yield tracked, started, pids
        tracked.end(started)
        assert other.poll() is None


def test_all_are_counted_and_ended(family) -> None:  # type: ignore[no-untyped-def]  # the module may be missing
    tracked, started, pids = family
    until(lambda: tracked.used().cpu_s > 0.2)
    assert tracked.memory_used(1) > psutil.Process(started.pid).memory_info().rss
    tracked.end(started)
    assert started.returncode < 0
    until(lambda: not any(_runs(pid) for pid in pids))
    assert tracked.used().cpu_s > 0.2  # also of those that have ended


SUPERVISOR = """
import subprocess, sys, time
from pathlib import Path
from thymio_sim_ros.grading.assignment import Limits
from thymio_sim_ros.grading.sandbox.tracked_processes import TrackedProcesses
tracked = TrackedProcesses(Limits())
started = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(10000)"], **tracked.options())
tracked.started(started)
print(started.pid, flush=True)
try:
    while True:
        tracked.used()
        time.sleep(0.01)
finally:
    tracked.end(started)
"""
GRADER = "import subprocess, sys; subprocess.run([sys.executable, '-c', sys.argv[1]])"


def test_they_end_with_the_grader() -> None:
    with subprocess.Popen([sys.executable, "-c", GRADER, SUPERVISOR], stdout=subprocess.PIPE) as grader:
        assert grader.stdout is not None
        pid = int(grader.stdout.readline())
        assert _runs(pid)
        grader.kill()
        until(lambda: not _runs(pid))


def _runs(pid: int) -> bool:
    try:
        return bool(psutil.Process(pid).status() != psutil.STATUS_ZOMBIE)
    except psutil.NoSuchProcess:
        return False
