"""What processes use: threads of DDS also run now and then in programs that wait in vain."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator

import pytest

from tests.patience import until
from thymio_sim_ros.grading.sandbox.thread_states import is_working

pytestmark = pytest.mark.process

BUSY_THREAD = """
import ctypes, sys, threading
def work():
    ctypes.CDLL(None).prctl(15, sys.argv[1].encode(), 0, 0, 0)  # PR_SET_NAME
    print("named", flush=True)
    while True: pass
thread = threading.Thread(target=work)
thread.start()
thread.join()
"""


@pytest.fixture
def process(request: pytest.FixtureRequest) -> Iterator[subprocess.Popen[bytes]]:
    """A process whose main thread waits, and whose other thread, with the name of the parameter, is busy."""
    with subprocess.Popen([sys.executable, "-c", BUSY_THREAD, request.param], stdout=subprocess.PIPE) as started:
        assert started.stdout is not None
        assert started.stdout.readline() == b"named\n"
        yield started
        started.kill()


@pytest.mark.parametrize(("process", "is_busy"), [("dds.ev.0", False), ("worker", True)], indirect=["process"])
def test_threads_of_dds_make_no_program_busy(process: subprocess.Popen[bytes], is_busy: bool) -> None:
    # The main thread may still be on its way to `join`.
    until(lambda: any(is_working(process.pid) for _ in range(1000)) == is_busy)
