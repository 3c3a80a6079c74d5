"""Submissions that try to lead the grading astray: each gets the points of what it does, and learns nothing."""

from __future__ import annotations

import csv
import json
import sys
from pathlib import Path

import pytest

from tests.grading.test_grade import level
from thymio_sim_ros.cli import main

__all__ = ["level"]

pytestmark = [
    pytest.mark.process,
    pytest.mark.skipif(not sys.platform.startswith("linux"), reason="sandboxes need Linux"),
]

ASSIGNMENT = """
tests = ["test_shown.py"]
hidden = ["test_hidden.py"]
files = ["answer.py", "own.json"]
data = ["shown.json", "secret.json", "numbers.txt"]
"""
SHOWN = """
import runpy
from pathlib import Path

import pytest

from thymio_sim_ros.testing import no_contact


@pytest.fixture
def answer():
    return runpy.run_path(str(Path(__file__).with_name("answer.py")))["answer"]


@pytest.mark.thymio(playground="line", program="motor.left.target = 100")
def test_shipped_names(thymio, answer):
    answer()
    assert "track" in {shape.kind for shape in thymio.stage.world.playground.shapes}


@pytest.mark.thymio(playground="shown.json")
def test_data(thymio, answer):
    answer()
    assert thymio.stage.world.playground.title == "Shown"
    assert Path("numbers.txt").read_text() == "1 2 3"


@pytest.mark.thymio(playground="own.json")
def test_what_is_handed_in(thymio):
    assert thymio.stage.world.playground.title == "Own"


@pytest.mark.thymio(playground="base")
def test_distance(thymio, answer):
    answer()
    thymio.run(0.1)
    assert not no_contact(thymio), "it stands in the middle"
"""
HIDDEN = """
import runpy
from pathlib import Path

import pytest


@pytest.mark.thymio(playground="secret.json")
def test_secret(thymio):
    "SECRET-TEST"
    assert thymio.stage.world.playground.title == "SECRET-TRACK"
    assert runpy.run_path(str(Path(__file__).with_name("answer.py")))["answer"]() == 42, "SECRET-ANSWER"
"""
ATTACKS = {
    "Knows": ("def answer(): return 42", {}),
    "Overwrites": (
        """
import os, pathlib
def answer():
    for folder in (pathlib.Path("."), pathlib.Path("../assignment")):
        for name in ("shown.json", "secret.json", "numbers.txt", "own.json", "answer.py", "line"):
            try:
                (folder / name).unlink(missing_ok=True)
            except OSError:
                pass
            try:
                (folder / name).write_text("{}")
            except OSError:
                pass
    return 42
""",
        dict.fromkeys(("line", "base", "shown.json", "secret.json", "test_hidden.py"), ""),
    ),
    "Prints": (
        """
import gc, linecache, os, pathlib
def answer():
    for lines in linecache.cache.values():
        print(*(lines[2] if len(lines) > 2 else ()))
    for folder, _, names in os.walk("/grade"):
        for name in names:
            print(name, (pathlib.Path(folder) / name).read_text(errors="replace"))
    os.write(1, b"printed last")
""",
        {},
    ),
    "Replaces a fixture": (
        "from thymio_sim_ros.testing import Thymio\ndef answer(): Thymio.touches = property(lambda self: [1])",
        {},
    ),
    "Replaces a test": (
        "import sys\ndef answer(): sys.modules['test_shown'].no_contact.__code__ = (lambda thymio: False).__code__",
        {},
    ),
    "Replaces a function of Python": ("import builtins\ndef answer(): builtins.abs = lambda of: 0", {}),
    "Adds a method": ("from thymio_sim_ros.testing import Thymio\ndef answer(): Thymio.__getattr__ = abs", {}),
    "Changes reports": (
        "from _pytest.reports import TestReport\ndef answer(): TestReport.passed = True; TestReport.outcome = 'passed'",
        {},
    ),
}
"""What was handed in as `answer.py`, and other files."""
POINTS = {
    "Knows": "4",
    "Overwrites": "4",
    "Prints": "3",
    "Replaces a fixture": "0",
    "Replaces a test": "0",
    "Replaces a function of Python": "0",
    "Adds a method": "0",
    "Changes reports": "3",
}
"""3 for the shown tests but the last, 1 for the hidden one; a process with replaced functions has none."""


def playground(title: str) -> str:
    """A playground of its own."""
    start = {"name": "thymio", "x_m": 0.0, "y_m": 0.0, "yaw_rad": 0.0}
    ground = {"kind": "rectangle", "name": "ground", "size_x_m": 1.0, "size_y_m": 1.0, "color": "#ffffff"}
    return json.dumps({"format": 1, "title": title, "shapes": [ground], "robots": [start]})


@pytest.fixture(scope="module")
def graded(level: str, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The reports of the class."""
    folder = tmp_path_factory.mktemp("attacks")
    texts = {"assignment.toml": ASSIGNMENT, "test_shown.py": SHOWN, "test_hidden.py": HIDDEN, "numbers.txt": "1 2 3"}
    texts |= {"shown.json": playground("Shown"), "secret.json": playground("SECRET-TRACK")}
    for name, (answer, others) in ATTACKS.items():
        texts |= {f"class/{name}/{file}": text for file, text in others.items()}
        texts |= {f"class/{name}/answer.py": answer, f"class/{name}/own.json": playground("Own")}
    for name, text in texts.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)
    words = ["grade", folder / "class", "--assignment", folder / "assignment.toml", "-o", folder / "grades"]
    assert main.main([*map(str, words), "--workers", "2"]) == 0
    return folder / "grades"


def test_attacks_gain_nothing(graded: Path) -> None:
    with (graded / "marks.csv").open(newline="") as file:
        points = {row["name"]: row["points"] for row in csv.DictReader(file)}
    assert points == POINTS


def test_pupils_see_nothing_of_hidden_tests_and_their_data(graded: Path) -> None:
    shown = "".join(path.read_text() for path in (graded / "pupils").rglob("*") if path.is_file())
    shown += (graded / "junit.xml").read_text() + (graded / "marks.csv").read_text()
    assert "printed last" in shown
    assert "SECRET" not in shown
    everything = "".join(path.read_text() for path in (graded / "teacher").iterdir())
    assert "SECRET-TRACK" in everything


def test_what_was_replaced_is_named(graded: Path) -> None:
    pages = "".join(path.read_text() for path in graded.glob("teacher/Replaces*.txt"))
    assert "replaced thymio_sim_ros.testing.thymio.Thymio.touches" in pages
    assert "no_contact, a function of the tests" in pages
