"""The command `thymio-sim grade` without sandboxes: what it continues, repeats, and leaves when interrupted."""

from __future__ import annotations

import csv
import signal
from pathlib import Path

import pytest

from tests.batch_runs.loop import Loop
from thymio_sim_ros.cli import grade as command
from thymio_sim_ros.cli.errors import USAGE_ERROR
from thymio_sim_ros.cli.main import main
from thymio_sim_ros.grading import grader
from thymio_sim_ros.grading.errors import GradingError
from thymio_sim_ros.grading.sandbox.job import Job, Outcome, Report

engine = pytest.importorskip("thymio_sim_ros.batch_runs.engine", exc_type=ImportError)

GRADE = ["grade", "class", "--assignment", "test_it.py"]


class Sandbox:
    """Stands for the sandbox: `a.py` of a submission says whether its only test passes. `runs` has each `a.py`."""

    def __init__(self) -> None:
        self.runs: list[str] = []

    def run_job(self, job: Job) -> Report:
        if job.selected is None:
            return Report({}, (("test_it.py::test_a", "2"),))
        text = job.submission["a.py"].decode()
        self.runs.append(text)
        return Report({"test_it.py::test_a": Outcome("passed" if text == "good" else "failed")})


@pytest.fixture
def sandbox(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Sandbox:
    found = Sandbox()
    monkeypatch.setattr(grader, "run_job", found.run_job)
    monkeypatch.setattr(grader, "_why_unavailable", lambda level: "")
    monkeypatch.setattr(command, "best_level", lambda: "namespaces")
    monkeypatch.chdir(tmp_path)
    (tmp_path / "test_it.py").write_text("def test_a(): ...")
    for name, text in {"Anna": "good", "Ben": "bad", "Cleo": "good "}.items():
        hand_in(name, text)
    return found


@pytest.fixture
def loop(monkeypatch: pytest.MonkeyPatch, sandbox: Sandbox) -> Loop:
    found = Loop()
    monkeypatch.setattr(engine, "run_all", found.run_all)
    return found


def hand_in(name: str, text: str) -> None:
    """Write the file of a pupil."""
    folder = Path("class", name)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "a.py").write_text(text)


def points(output: str = "grades") -> dict[str, str]:
    """The points of each pupil."""
    with Path(output, "marks.csv").open(encoding="utf-8", newline="") as file:
        return {row["name"]: row["points"] for row in csv.DictReader(file)}


def test_a_class_is_printed_in_order_whatever_is_ready_first(loop: Loop, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(GRADE) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split() for line in lines[2:5]] == [["2/2", "Anna"], ["0/2", "Ben"], ["0/2", "Cleo"]]
    assert points() == {"Anna": "2", "Ben": "0", "Cleo": "0"}


def test_a_late_or_changed_submission_is_graded_alone(loop: Loop, sandbox: Sandbox) -> None:
    assert main(GRADE) == 0
    hand_in("Ben", "good")
    hand_in("Dora", "also bad")
    sandbox.runs.clear()
    assert main(GRADE) == 0
    assert sorted(sandbox.runs) == ["also bad"]  # what Ben has now is known from Anna
    assert points() == {"Anna": "2", "Ben": "2", "Cleo": "0", "Dora": "0"}
    sandbox.runs.clear()
    Path("test_it.py").write_text("def test_a(): 'another test'")
    assert main(GRADE) == 0
    assert len(sandbox.runs) == 4
    sandbox.runs.clear()
    assert main([*GRADE, "--again"]) == 0
    assert len(sandbox.runs) == 4


def test_reports_of_an_earlier_grading_do_not_stay(loop: Loop) -> None:
    assert main(GRADE) == 0
    pupils, teacher = Path("grades/pupils"), Path("grades/teacher")
    for own in (pupils / "notes", pupils / "001-Anna" / "test-1.jsonl"):
        own.write_text("")
    hand_in("Amir", "good")
    assert main(GRADE) == 0
    numbered = ["001-Amir", "002-Anna", "003-Ben", "004-Cleo"]
    assert sorted(path.name for path in pupils.iterdir()) == [*numbered, "notes"]
    assert sorted(path.stem for path in teacher.iterdir()) == numbered
    hand_in("Amir", "bad")
    (pupils / "001-Amir" / "test-1.jsonl").write_text("")
    assert main(GRADE) == 0
    assert not (pupils / "001-Amir" / "test-1.jsonl").exists()


def test_a_damaged_report_is_made_again(loop: Loop, sandbox: Sandbox) -> None:
    assert main(GRADE) == 0
    for damage, path in zip(("", "{}", '{"outcomes": 3}'), Path("grades", "finished").iterdir(), strict=True):
        path.write_text(damage)
    sandbox.runs.clear()
    assert main(GRADE) == 0
    assert len(sandbox.runs) == 3


def test_a_submission_that_no_machine_could_grade_is_said_and_repeated(
    loop: Loop, sandbox: Sandbox, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    run_job = sandbox.run_job

    def full(job: Job) -> Report:
        if job.submission.get("a.py") == b"bad":
            raise OSError(28, "No space left on device")
        return run_job(job)

    monkeypatch.setattr(grader, "run_job", full)

    def run_all(function, tasks, **_):  # type: ignore[no-untyped-def]
        yield [(index, engine._run_one(function, task)) for index, task in enumerate(tasks)]

    monkeypatch.setattr(engine, "run_all", run_all)
    assert main(GRADE) == command.FAILED
    captured = capsys.readouterr()
    assert "0/2  Ben: could not be graded: OSError: [Errno 28] No space left on device" in captured.out
    assert "3 of 3 submissions, 1 with errors" in captured.err
    monkeypatch.setattr(grader, "run_job", run_job)
    sandbox.runs.clear()
    assert main(GRADE) == 0
    assert sandbox.runs == ["bad"]


def test_a_worker_without_the_isolation_grades_nobody(sandbox: Sandbox, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(grader, "_why_unavailable", lambda level: "bwrap is not installed")
    with pytest.raises(GradingError, match=r"isolation bubblewrap is not available on .*: bwrap is not installed"):
        grader.run_submission(None, assignment=None, tests=(), level="bubblewrap")  # type: ignore[arg-type]
    assert sandbox.runs == []


def test_an_interrupted_grading_keeps_what_is_there_and_continues(
    loop: Loop, sandbox: Sandbox, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    ended: list[int] = []
    monkeypatch.setattr(command, "exit_by_signal", ended.append)
    loop.after_each = lambda: signal.raise_signal(signal.SIGINT)
    main(GRADE)
    assert ended == [signal.SIGINT]
    assert points() == {"Cleo": "0"}
    assert "stopped; the same command continues the grading" in capsys.readouterr().err
    loop.after_each = lambda: None
    sandbox.runs.clear()
    assert main(GRADE) == 0
    assert sorted(sandbox.runs) == ["bad", "good"]
    assert points() == {"Anna": "2", "Ben": "0", "Cleo": "0"}


def test_a_folder_that_cannot_be_written_is_one_line(loop: Loop, capsys: pytest.CaptureFixture[str]) -> None:
    Path("taken").write_text("")
    assert main([*GRADE, "-o", "taken"]) == USAGE_ERROR
    (line,) = capsys.readouterr().err.splitlines()[-1:]
    assert "expected a folder that can be written" in line
