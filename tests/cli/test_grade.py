"""The command `thymio-sim grade` without sandboxes: what it continues, repeats, and leaves when interrupted."""

from __future__ import annotations

import csv
import shutil
import signal
from pathlib import Path

import pytest

from tests.batch_runs.loop import Loop
from thymio_sim_ros.cli import grade as command
from thymio_sim_ros.cli.errors import USAGE_ERROR
from thymio_sim_ros.cli.main import main
from thymio_sim_ros.grading import grader
from thymio_sim_ros.grading.errors import DestroyedError, GradingError
from thymio_sim_ros.grading.sandbox.job import Job, Outcome, Report

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
    monkeypatch.setattr(grader, "why_unavailable", lambda level: "")
    monkeypatch.setattr(command, "best_level", lambda: "namespaces")
    monkeypatch.chdir(tmp_path)
    (tmp_path / "test_it.py").write_text("def test_a(): ...")
    for name, text in {"Anna": "good", "Ben": "bad", "Cleo": "good "}.items():
        hand_in(name, text)
    return found


@pytest.fixture
def loop(monkeypatch: pytest.MonkeyPatch, sandbox: Sandbox) -> Loop:
    found = Loop()
    monkeypatch.setattr(grader, "run_in_threads", found.run_all)
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
    for own in (pupils / "notes", next(pupils.glob("Anna-*")) / "test-1.jsonl"):
        own.write_text("")
    shutil.rmtree("class/Cleo")
    hand_in("Amir", "bad")
    assert main(GRADE) == 0
    names = sorted(path.name for path in pupils.iterdir())
    assert [name.partition("-")[0] for name in names] == ["Amir", "Anna", "Ben", "notes"]
    assert sorted(path.stem for path in teacher.iterdir()) == names[:-1]
    log = pupils / names[0] / "test-1.jsonl"
    log.write_text("")
    hand_in("Amir", "good")
    assert main(GRADE) == 0
    assert not log.exists()


def test_a_late_submission_moves_no_page(loop: Loop) -> None:
    assert main(GRADE) == 0
    pages = {path.name: (path / "index.html").read_text() for path in Path("grades/pupils").iterdir()}
    hand_in("Amir", "good")
    assert main(GRADE) == 0
    assert pages == {name: Path("grades/pupils", name, "index.html").read_text() for name in pages}
    assert len(list(Path("grades/pupils").iterdir())) == 4


def test_a_damaged_report_is_made_again(loop: Loop, sandbox: Sandbox) -> None:
    assert main(GRADE) == 0
    for damage, path in zip(("", "{}", '{"outcomes": 3}'), Path("grades", "finished").iterdir(), strict=True):
        path.write_text(damage)
    sandbox.runs.clear()
    assert main(GRADE) == 0
    assert len(sandbox.runs) == 3


def test_a_submission_that_no_machine_could_grade_is_said_and_repeated(
    sandbox: Sandbox, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    run_job = sandbox.run_job

    def full(job: Job) -> Report:
        if job.submission.get("a.py") == b"bad":
            raise OSError(28, "No space left on device")
        return run_job(job)

    monkeypatch.setattr(grader, "run_job", full)

    assert main(GRADE) == command.FAILED
    captured = capsys.readouterr()
    assert "0/2  Ben: could not be graded: OSError: [Errno 28] No space left on device" in captured.out
    assert "3 of 3 submissions, 1 with errors" in captured.err
    pages = "".join(path.read_text() for path in Path("grades/pupils").glob("Ben-*/*"))
    assert "could not be graded" in pages
    assert "No space left" not in pages  # on the machine of the teacher
    monkeypatch.setattr(grader, "run_job", run_job)
    sandbox.runs.clear()
    assert main(GRADE) == 0
    assert sandbox.runs == ["bad"]


@pytest.mark.parametrize(
    ("fault", "verdict", "code"),
    [
        (GradingError("the sandbox ended with code 1: OSError"), "could not be graded", command.FAILED),
        (DestroyedError("the sandbox ended with code -9"), "the tests were ended from outside", 0),
        (Report({}, remark="stopped before the first test: exit code 1"), "could not be graded", 0),
    ],
)
def test_a_fault_of_the_machine_is_no_fault_of_the_pupil(
    sandbox: Sandbox, monkeypatch: pytest.MonkeyPatch, fault: GradingError | Report, verdict: str, code: int
) -> None:
    run_job = sandbox.run_job

    def faulty(job: Job) -> Report:
        if job.submission.get("a.py") != b"bad":
            return run_job(job)
        if isinstance(fault, Report):
            return fault
        raise fault

    monkeypatch.setattr(grader, "run_job", faulty)
    assert main(GRADE) == code
    page = next(Path("grades/pupils").glob("Ben-*/index.html")).read_text()
    assert verdict in page
    assert "code 1" not in page
    assert points() == {"Anna": "2", "Ben": "0", "Cleo": "0"}


def test_a_worker_without_the_isolation_grades_nobody(sandbox: Sandbox, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(grader, "why_unavailable", lambda level: "unshare: not permitted")
    with pytest.raises(GradingError, match=r"isolation namespaces is not available on .*: unshare: not permitted"):
        grader.run_submission(None, assignment=None, tests=(), level="namespaces")  # type: ignore[arg-type]
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


NOT_HERE = Outcome("failed", "conftest.py:3: in robot\nE   RuntimeError: no free ROS domain", phase="setup")


def setups(monkeypatch: pytest.MonkeyPatch, sandbox: Sandbox, outcomes: dict[str, Outcome]) -> None:
    """Give submissions with these texts these outcomes."""

    def run_job(job: Job) -> Report:
        if job.selected is None:
            return Report({}, (("test_it.py::test_a", "2"),))
        return Report({"test_it.py::test_a": outcomes[job.submission["a.py"].decode().strip()]})

    monkeypatch.setattr(grader, "run_job", run_job)


@pytest.mark.parametrize("outcome", [NOT_HERE, Outcome("skipped", "ROS is not here", phase="setup")])
def test_a_set_up_that_fails_for_all_fails_the_command(
    loop: Loop,
    sandbox: Sandbox,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    outcome: Outcome,
) -> None:
    run_job = sandbox.run_job
    setups(monkeypatch, sandbox, {"good": outcome, "bad": outcome})
    assert main(GRADE) == command.FAILED
    reason = outcome.message.rpartition("E   ")[2]
    assert f"the same set-up failed for all submissions: test_it.py::test_a: {reason}" in capsys.readouterr().err
    monkeypatch.setattr(grader, "run_job", run_job)  # the machine was mended
    assert main(GRADE) == 0
    assert points() == {"Anna": "2", "Ben": "0", "Cleo": "0"}


@pytest.mark.parametrize(
    "outcomes",
    [
        {"good": NOT_HERE, "bad": Outcome("failed", "E   other", phase="setup")},
        {"good": NOT_HERE, "bad": Outcome("passed")},
        dict.fromkeys(("good", "bad"), Outcome("failed", "a.py:1: in <module>\nE   SyntaxError", phase="setup")),
        dict.fromkeys(("good", "bad"), Outcome("failed", "E   assert False", phase="call")),
    ],
)
def test_set_ups_that_fail_by_pupils_do_not_fail_the_command(
    loop: Loop, sandbox: Sandbox, monkeypatch: pytest.MonkeyPatch, outcomes: dict[str, Outcome]
) -> None:
    setups(monkeypatch, sandbox, outcomes)
    assert main(GRADE) == 0


def test_a_solution_is_graded_first_and_needs_all_points(
    loop: Loop, sandbox: Sandbox, capsys: pytest.CaptureFixture[str]
) -> None:
    Path("it.toml").write_text('tests = ["test_it.py"]\nfiles = ["a.py"]\nsolution = "solution"\n')
    Path("solution").mkdir()
    Path("solution/a.py").write_text("good")
    grade = [*GRADE[:-1], "it.toml"]
    assert main(grade) == 0
    assert sandbox.runs[0] == "good"
    assert "solution: 2 of 2 points" in capsys.readouterr().out
    for text, reason in {"bad": "test_it.py::test_a: failed", "": "no file a.py"}.items():
        sandbox.runs.clear()
        Path("solution/a.py").write_text(text)
        if not text:
            Path("solution/a.py").rename("solution/b.md")
        assert main(grade) == USAGE_ERROR
        assert f"the solution solution has 0 of 2 points, expected all: mend test, solution or machine: {reason}" in (
            capsys.readouterr().err
        )
        assert sandbox.runs in (["bad"], [])


def test_a_test_file_that_is_skipped_as_a_whole_is_an_error(
    loop: Loop, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    skipped = Report({}, (("test_it.py::test_a", "2"),), notes=("test_ros.py: could not import 'rclpy'",))
    monkeypatch.setattr(grader, "run_job", lambda job: skipped)
    assert main(GRADE) == USAGE_ERROR
    assert "test_ros.py: could not import 'rclpy'" in capsys.readouterr().err
