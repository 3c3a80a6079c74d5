"""A class of thirty: an assignment, what each pupil handed in, and the mark that each must get.

The assignment is a controller in Python, because Python can do harm; points: 1 for starting, 3 for three seeds without
a contact, 2 for a hidden test.
"""

from __future__ import annotations

import io
import zipfile
from dataclasses import dataclass
from pathlib import Path

ASSIGNMENT = """
tests = ["test_controller.py"]
hidden = ["test_hidden.py"]
files = ["controller.py"]

[limits]
cpu_s = 3
idle_s = 3
memory_mb = 500
processes = 24
output_mb = 1
disk_mb = 20
"""

TESTS = """
import runpy
from pathlib import Path

import pytest

from thymio_sim_ros.sim.commands import MotorTargets
from thymio_sim_ros.testing import no_contact

pytestmark = pytest.mark.thymio(playground="arena")


@pytest.fixture
def steer():
    return runpy.run_path(str(Path(__file__).with_name("controller.py")))["steer"]


def drive(thymio, steer, seconds):
    for _ in range(round(seconds * 10)):
        thymio.post(MotorTargets(*steer(thymio["prox.horizontal"])))
        thymio.run(0.1)


def test_it_starts(thymio, steer):
    drive(thymio, steer, 0.5)
    assert thymio.speed > 0.02


@pytest.mark.points(3)
@pytest.mark.parametrize("seed", range(3))
def test_it_touches_nothing(thymio, steer, seed):
    drive(thymio, steer, 6)
    assert no_contact(thymio)
"""

HIDDEN = """
import runpy
from pathlib import Path

import pytest


@pytest.mark.points(2)
def test_it_turns_when_something_is_near():
    left, right = runpy.run_path(str(Path(__file__).with_name("controller.py")))["steer"]((4000,) * 7)
    assert left != right, "the secret of the hidden test"
"""

GOOD = """
def steer(prox):
    return (100, -100) if max(prox[:5]) > 800 else (150, 150)
"""
STRAIGHT = "def steer(prox): return 400, 400"


def acting(action: str) -> str:
    """A good controller that first does something else, each time it is asked."""
    body = "\n".join(f"    {line}" for line in action.strip().splitlines())
    imports = "import os, socket, subprocess, sys, threading, time"
    return f"{imports}\ndef steer(prox):\n{body}\n    return good(prox)\n{GOOD.replace('steer', 'good')}"


@dataclass(frozen=True)
class Pupil:
    """What was handed in as `controller.py` (None: nothing), points of 6, and a part of the row's verdict or remark."""

    source: str | None
    points: str
    row: str


PUPILS = {
    "Good": Pupil(GOOD, "6", "passed"),
    "Straight": Pupil(STRAIGHT, "1", "failed"),
    "Stands": Pupil("def steer(prox): return 0, 0", "3", "failed"),
    "Turns": Pupil("def steer(prox): return 100, -100", "5", "failed"),
    "Backwards": Pupil("def steer(prox): return -100, -100", "3", "failed"),
    "Hidden only": Pupil("def steer(prox): return (9, 0) if prox[6] == 4000 else 1 / 0", "2", "failed"),
    "Syntax error": Pupil("def steer(prox) return 1", "0", "failed"),
    "Import error": Pupil("import numppy", "0", "failed"),
    "No function": Pupil("def stear(prox): return 1, 1", "0", "failed"),
    "Empty": Pupil("", "0", "failed"),
    "Nothing": Pupil(None, "0", "no file was handed in: hand in controller.py"),
    "Exits": Pupil(acting("sys.exit(0)"), "0", "failed"),
    "Ends the process": Pupil(acting("os._exit(0)"), "0", "crashed"),
    "Segmentation fault": Pupil(acting("import ctypes; ctypes.string_at(0)"), "0", "crashed"),
    "Loops": Pupil(acting("while True: pass"), "0", "CPU time limit"),
    "Loops once": Pupil(acting("while prox[6] == 4000: pass"), "4", "CPU time limit"),
    "Sleeps": Pupil(acting("time.sleep(1e6) if prox[6] == 4000 else None"), "4", "idle limit"),
    "Reads input": Pupil(acting("input()"), "0", "failed"),
    "Forks": Pupil(acting("if prox[6] == 4000: os.fork()"), "6", "passed"),
    "Fork bomb": Pupil(
        acting("while prox[6] == 4000:\n    try: os.fork()\n    except OSError: pass"), "4", "CPU time limit"
    ),
    "Threads": Pupil(acting("threading.Thread(target=time.sleep, args=(1e6,)).start() if prox[6] else None"), "6", ""),
    "Deletes files": Pupil(
        acting("import shutil\nfor path in HOST_FOLDER, '/usr/bin', '.': shutil.rmtree(path, True)"), "6", "passed"
    ),
    "Calls the network": Pupil(acting("socket.create_connection(('127.0.0.1', HOST_PORT), 1)"), "0", "failed"),
    "Prints gigabytes": Pupil(acting("while True: print('x' * 10000)"), "0", "output limit"),
    "Eats memory": Pupil(acting("eaten = bytearray(10 ** 9)"), "0", "memory limit"),
    "Fills the disk": Pupil(
        acting("with open('/tmp/full', 'wb') as f:\n    while True: f.write(bytes(10 ** 6))"), "0", "disk limit"
    ),
    "Kills": Pupil(acting("os.kill(-1, 9)"), "0", "failed"),
    "Kills the supervisor": Pupil(
        acting("for pid in (1, os.getppid()):\n    try: os.kill(pid, 9)\n    except OSError: pass"), "6", "passed"
    ),
    "Reads hidden tests": Pupil(
        acting("for _, _, names in os.walk('..'): assert not [n for n in names if n[:4] + n[-3:] == 'test.py']"),
        "6", "passed"
    ),
    "Forges": Pupil(
        acting("for fd in range(3, 64):\n    try: os.write(fd, b'{\"do\": \"end\"}\\n')\n    except OSError: pass"),
        "0", "manipulated",
    ),
}  # fmt: skip
HARMLESS = ("Good", "Straight", "Stands", "Syntax error", "Nothing", "Ends the process", "Forges")
"""A part of the class that is graded within seconds."""


def write_assignment(folder: Path) -> Path:
    """Write the assignment; return its file."""
    folder.mkdir()
    (folder / "test_controller.py").write_text(TESTS)
    (folder / "test_hidden.py").write_text(HIDDEN)
    (folder / "assignment.toml").write_text(ASSIGNMENT)
    return folder / "assignment.toml"


def moodle_zip(path: Path, names: tuple[str, ...], *, host_folder: Path, host_port: int) -> Path:
    """Write the submissions of these pupils as Moodle exports them."""
    with zipfile.ZipFile(path, "w") as archive:
        for number, name in enumerate(names, start=1000):
            folder = f"{name}_{number}_assignsubmission_file_"
            source = PUPILS[name].source
            if source is None:
                archive.writestr(f"{folder}/.keep", "")
            else:
                known = f"HOST_FOLDER, HOST_PORT = {str(host_folder)!r}, {host_port}\n"
                archive.writestr(f"{folder}/controller.py", (known if "HOST_" in source else "") + source)
    return path


def zipped(files: dict[str, bytes]) -> bytes:
    """A zip of these files."""
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w") as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return data.getvalue()
