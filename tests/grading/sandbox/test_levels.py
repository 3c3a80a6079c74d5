"""Every level of isolation that this machine gives: what a submission can and cannot do in it."""

from __future__ import annotations

import os
import socket
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest

from thymio_sim_ros.grading.assignment import Limits
from thymio_sim_ros.grading.sandbox import levels
from thymio_sim_ros.grading.sandbox.job import Job
from thymio_sim_ros.grading.sandbox.levels import AUTOMATIC, run_job, why_unavailable
from thymio_sim_ros.grading.sandbox.readable import UNPRIVILEGED_ID, closed_path

pytestmark = [
    pytest.mark.process,
    pytest.mark.skipif(not sys.platform.startswith("linux"), reason="sandboxes need Linux"),
]

TESTS = """
import os, runpy, socket
from pathlib import Path

def probe(name):
    return runpy.run_path(str(Path(__file__).with_name("probe.py")))[name]

def test_it_writes_its_own_folder(): probe("write_here")()
def test_it_reads_files_of_others(): probe("read")()
def test_it_connects_by_tcp(): probe("connect")()
def test_it_signals_others(): probe("signal")()
def test_it_gets_rights(): probe("unshare")()
def test_it_fills_memory_of_no_process(): probe("memfd")()
def test_it_maps_shared_memory(): probe("shared")()
def test_it_maps_zeros(): probe("zeros")()
def test_it_gets_a_segment(): probe("segment")()
def test_it_fills_the_root(): probe("fill")("/")
def test_it_fills_devices(): probe("fill")("/dev")
def test_it_fills_shared_memory(): probe("fill")("/dev/shm")
def test_its_program_reads_the_tests_in_memory(): probe("read_parent")()
"""
PROBE = """
import ctypes, mmap, os, socket, subprocess, sys
def write_here():
    with open("file", "w") as file: file.write("1")
def read(): open({path!r}).read()
def connect(): socket.create_connection(("127.0.0.1", {port}), 1)
def signal(): os.kill({pid}, 0)
def unshare():
    if ctypes.CDLL(None).unshare(0x10000000): raise OSError("refused")
def memfd(): os.write(os.memfd_create("a"), bytes(1000))
def shared(): mmap.mmap(-1, 4096)
def zeros(): mmap.mmap(os.open("/dev/zero", os.O_RDWR), 4096)
def segment():
    if ctypes.CDLL(None).shmget(0, 4096, 0o1600) < 0: raise OSError("refused")
def fill(folder):
    for name in "a", "b":
        with open(os.path.join(folder, name), "wb") as file: file.write(bytes(40 * 10 ** 6))
def read_parent():
    subprocess.run([sys.executable, "-c", "import os; open(f'/proc/{{os.getppid()}}/mem', 'rb')"], check=True)
"""


@pytest.mark.parametrize("level", AUTOMATIC)
def test_a_level_gives_what_it_promises(level: str, tmp_path: Path) -> None:
    if reason := why_unavailable(level):
        pytest.skip(f"{level}: {reason}")
    (tmp_path / "secret").write_text("secret")
    with socket.create_server(("127.0.0.1", 0)) as listener:
        probe = PROBE.format(path=str(tmp_path / "secret"), port=listener.getsockname()[1], pid=os.getpid())
        names = [f"test_probe.py::{line.split('(')[0][4:]}" for line in TESTS.splitlines() if "def test" in line]
        files = {"test_probe.py": TESTS.encode()}
        report = run_job(Job(level, ("test_probe.py",), files, {"probe.py": probe.encode()}, tuple(names), Limits()))
    assert report.remark == ""
    assert {name: one.outcome for name, one in report.outcomes.items()} == dict.fromkeys(names, "failed") | {
        names[0]: "passed"
    }


USER = UNPRIVILEGED_ID if sys.platform.startswith("linux") and os.geteuid() == 0 else None
"""A user to whom a folder of mode 0 is closed."""


@pytest.fixture
def closed_folder() -> Iterator[Path]:
    """A folder with an interpreter and a package, in a folder that is closed as /root is."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        folder.chmod(0o755)
        home = folder / "home"
        (home / "python" / "bin").mkdir(parents=True)
        python = home / "python" / "bin" / "python"
        python.write_text("")
        python.chmod(0o755)
        (folder / "venv").mkdir(mode=0o755)
        (folder / "venv" / "python").symlink_to(python)
        home.chmod(0)
        yield folder
        home.chmod(0o700)


def test_a_closed_folder_is_found_on_every_way_to_a_path(closed_folder: Path) -> None:
    home, link, inside = closed_folder / "home", closed_folder / "venv" / "python", closed_folder / "home" / "python"
    for path in (home, inside, link):
        assert closed_path([str(closed_folder), str(path)], USER) == (str(path), str(home))
    home.chmod(0o755)
    assert closed_path([str(home), str(inside), str(link)], USER) is None
    (inside / "bin" / "python").chmod(0)
    assert closed_path([str(link)], USER) == (str(link), str(inside / "bin" / "python"))


@pytest.mark.parametrize("level", ["landlock", "limits"])
def test_a_level_of_root_says_which_folder_is_closed_to_the_tests(
    level: str, closed_folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    link, home = str(closed_folder / "venv" / "python"), str(closed_folder / "home")
    monkeypatch.setattr(os, "geteuid", lambda: 0)
    monkeypatch.setattr(levels, "UNPRIVILEGED_ID", USER)
    monkeypatch.setattr(levels, "needed_paths", lambda: [link])
    begin = f"started by root, tests run as a user without rights, and this user may not use {home}"
    advice = "grade as an ordinary user, or install Python and this package elsewhere, as in /opt"
    assert why_unavailable(level) == f"{begin}, which leads to {link}: {advice}"
    monkeypatch.setattr(levels, "needed_paths", list)
    monkeypatch.setattr(tempfile, "tempdir", home)
    advice = "set TMPDIR to a folder that is open to all users"
    assert why_unavailable(level) == f"{begin}, the place of temporary files: {advice}"
