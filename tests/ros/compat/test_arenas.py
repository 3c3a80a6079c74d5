"""The limit of glibc's arenas: threads that allocate memory share few of them."""

from __future__ import annotations

import platform
import subprocess
import sys

import pytest

from thymio_sim_ros.ros.compat.arenas import MOST_ARENAS

PROGRAM = """
import ctypes, sys, threading
from thymio_sim_ros.ros.compat.arenas import limit_arenas

if sys.argv[1] == "limited":
    limit_arenas()
everyone = threading.Barrier(8)

def allocate():
    everyone.wait()
    kept = [bytes(10_000) for _ in range(100)]  # more than Python's own allocator serves
    everyone.wait()

threads = [threading.Thread(target=allocate) for _ in range(8)]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
libc = ctypes.CDLL(None)
libc.malloc_info(0, ctypes.c_void_p.in_dll(libc, "stdout"))
libc.fflush(None)
"""


@pytest.mark.process
@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="this C library has no arenas")
@pytest.mark.parametrize(("word", "is_limited"), [("limited", True), ("free", False)])
def test_threads_share_the_arenas(word: str, is_limited: bool) -> None:
    run = subprocess.run([sys.executable, "-c", PROGRAM, word], capture_output=True, text=True, check=True)
    arenas = run.stdout.count("<heap nr=")
    assert arenas > 0
    assert (arenas <= MOST_ARENAS) is is_limited
