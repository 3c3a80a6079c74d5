"""The command `thymio-sim grade` on an example class: exact marks, whatever the submissions try."""

from __future__ import annotations

import csv
import json
import os
import re
import signal
import socket
import sys
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator
from pathlib import Path

import psutil
import pytest

from tests.grading.example_class import HARMLESS, PUPILS, moodle_zip, write_assignment
from tests.patience import until
from tests.processes import SUITE, Process
from thymio_sim_ros.cli import grade as grade_command
from thymio_sim_ros.cli import main
from thymio_sim_ros.cli.errors import USAGE_ERROR
from thymio_sim_ros.engine.replay import replay
from thymio_sim_ros.grading import grader
from thymio_sim_ros.grading.errors import GradingError
from thymio_sim_ros.grading.sandbox.job import Report
from thymio_sim_ros.grading.sandbox.levels import best_level

pytestmark = [
    pytest.mark.process,
    pytest.mark.skipif(not sys.platform.startswith("linux"), reason="sandboxes need Linux"),
]


@pytest.fixture(scope="module")
def level() -> str:
    """The strongest isolation of this machine, if it gives own processes and an own network."""
    try:
        found = best_level()
    except GradingError as error:
        pytest.skip(str(error))
    if found == "landlock":
        pytest.skip("namespaces are not available here")
    return found


def grade(folder: Path, names: tuple[str, ...], *where: object) -> Path:
    """Grade a part of the class; return the folder of the reports."""
    listener = socket.create_server(("127.0.0.1", 0))
    precious = folder / "precious"
    precious.mkdir()
    (precious / "file").write_text("kept")
    port = listener.getsockname()[1]
    class_ = moodle_zip(folder / "class.zip", names, host_folder=precious, host_port=port)
    assignment, output = write_assignment(folder / "assignment"), folder / "grades"
    with listener:
        words = ["grade", class_, "--assignment", assignment, "-o", output, *where]
        assert main.main(list(map(str, words))) == 0
        listener.setblocking(False)
        with pytest.raises(BlockingIOError):
            listener.accept()
    assert (precious / "file").read_text() == "kept"
    return output


def rows(output: Path) -> dict[str, dict[str, str]]:
    """The rows of the table by name."""
    with (output / "marks.csv").open(newline="") as file:
        return {row["name"]: row for row in csv.DictReader(file)}


def assert_marks(output: Path, names: tuple[str, ...]) -> None:
    """The exact marks of these pupils."""
    found = rows(output)
    assert {name: found[name]["points"] for name in names} == {name: PUPILS[name].points for name in names}
    for name in names:
        assert PUPILS[name].row in f"{found[name]['verdict']} {found[name]['remark']}", name


@pytest.fixture(scope="module")
def small(level: str, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The reports of a part of the class, graded by one worker."""
    return grade(tmp_path_factory.mktemp("small"), HARMLESS, "--workers", 1)


def test_a_small_class_gets_its_marks(small: Path) -> None:
    assert_marks(small, HARMLESS)
    assert rows(small)["Good"]["id"] == "1000"


def test_the_lines_of_the_documentation_are_true(small: Path) -> None:
    page = (Path(__file__).parents[2] / "docs" / "grading-a-class.md").read_text(encoding="utf-8")
    shown = re.findall(r"^ +(\d+)/6  ([^:\n]+?)(?:: (.+))?$", page, re.MULTILINE)
    assert len(shown) > 5
    found = rows(small)
    assert [(found[name]["points"], name, found[name]["remark"]) for _, name, _ in shown] == shown


@pytest.mark.slow
def test_the_class_of_thirty_gets_its_marks_and_harms_nothing(level: str, small: Path, tmp_path: Path) -> None:
    assert len(PUPILS) == 30
    output = grade(tmp_path, tuple(PUPILS), "--workers", 2)
    assert_marks(output, tuple(PUPILS))
    one, two = rows(small), rows(output)
    for name in HARMLESS:
        assert {**one[name], "id": ""} == {**two[name], "id": ""}  # one worker or two


@pytest.mark.slow
def test_a_cluster_with_an_address_gives_the_same_marks(small: Path, tmp_path: Path) -> None:
    engine = pytest.importorskip("thymio_sim_ros.batch_runs.engine", exc_type=ImportError)
    with engine._quiet(), engine._local(2, "") as client:
        output = grade(tmp_path, ("Good", "Straight"), "--scheduler", client.scheduler.address)
    one, other = rows(small), rows(output)
    assert {name: {**one[name], "id": ""} for name in other} == {name: {**other[name], "id": ""} for name in other}


def test_the_table_is_written_while_the_class_is_graded(
    level: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    class_ = moodle_zip(tmp_path / "class.zip", ("Good", "Stands"), host_folder=tmp_path, host_port=1)
    output = tmp_path / "grades"
    assignment = write_assignment(tmp_path / "assignment")

    def run_submissions(*_: object, **__: object) -> Iterator[list[tuple[int, Report]]]:
        yield [(0, Report({}, remark="this one came first"))]
        assert rows(output)["Good"]["remark"] == "this one came first"
        yield [(1, Report({}))]

    monkeypatch.setattr(grader, "run_submissions", run_submissions)
    monkeypatch.setattr(grade_command, "WRITE_S", 0.0)
    words = ["grade", class_, "--assignment", assignment, "-o", output]
    assert main.main(list(map(str, words))) == 0
    assert list(rows(output)) == ["Good", "Stands"]


def test_ctrl_c_in_a_terminal_is_no_verdict(level: str, tmp_path: Path) -> None:
    """It reaches all processes of the terminal, and must not look as if the submission had ended its sandbox."""
    class_ = moodle_zip(tmp_path / "class.zip", ("Sleeps",), host_folder=tmp_path, host_port=1)
    words = ["grade", class_, "--assignment", write_assignment(tmp_path / "assignment"), "-o", tmp_path / "grades"]
    command = Process(tmp_path, SUITE, *map(str, words))

    def sandboxes() -> list[psutil.Process]:
        children = psutil.Process(command.pid).children()
        return children if "1 submissions" in command.output else []

    sandbox = until(sandboxes)
    os.killpg(command.pid, signal.SIGINT)
    until(lambda: not command.is_running and not any(one.is_running() for one in sandbox))
    assert "stopped; the same command continues the grading" in command.output
    assert rows(tmp_path / "grades") == {}


def test_a_failure_has_a_page_with_a_picture_and_a_run_log(small: Path) -> None:
    page = next(small.glob("pupils/Straight-*/index.html")).read_text()
    assert "assert no_contact(thymio)" in page
    assert "data:image/svg+xml;base64," in page
    logs = sorted(small.glob("pupils/Straight-*/*.jsonl"))
    assert [log.name for log in logs] == ["test-2.jsonl", "test-3.jsonl", "test-4.jsonl"]
    assert f"thymio-sim --replay {logs[0].name}" in page
    result = replay(logs[0])
    assert (result.differs, result.is_complete, result.seconds) == (None, True, 6.0)


def test_pupils_do_not_see_what_a_hidden_test_says(small: Path) -> None:
    for name in ("index.html", "results.json", "../../junit.xml"):
        assert "the secret" not in next(small.glob(f"pupils/Stands-*/{name}")).read_text()
    assert "the secret of the hidden test" in next(small.glob("teacher/Stands-*.txt")).read_text()


def test_reports_for_platforms_have_points_and_verdicts(small: Path) -> None:
    result = json.loads(next(small.glob("pupils/Straight-*/results.json")).read_text())
    assert (result["score"], sum(test["max_score"] for test in result["tests"])) == (1.0, 6.0)
    assert {test["visibility"] for test in result["tests"]} == {"visible", "after_published"}
    suites = {suite.get("name"): suite for suite in ElementTree.parse(small / "junit.xml").getroot()}
    assert {name: suites[name].get("failures") for name in ("Good", "Straight")} == {"Good": "0", "Straight": "4"}
    assert suites["Ends the process"].get("errors") == "5"


@pytest.mark.parametrize(
    ("tests", "reported"),
    [
        ("import controller", "No module named 'controller'"),
        ("def helper(): pass", "no tests found"),
        ("import pytest\n@pytest.mark.points('3')\ndef test_a(): pass", "mark points: found '3', expected one number"),
    ],
)
def test_tests_that_cannot_be_collected_are_rejected(
    level: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], tests: str, reported: str
) -> None:
    (tmp_path / "class").mkdir()
    (tmp_path / "class" / "controller.py").write_text("")
    (tmp_path / "test_it.py").write_text(tests)
    words = ["grade", str(tmp_path / "class"), "--assignment", str(tmp_path / "test_it.py"), "-o", str(tmp_path / "o")]
    assert main.main(words) == USAGE_ERROR
    assert reported in capsys.readouterr().err
