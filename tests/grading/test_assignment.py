"""Assignments: a pytest file, or TOML with tests, files and limits."""

from __future__ import annotations

from pathlib import Path

import pytest

from thymio_sim_ros.cli import grade
from thymio_sim_ros.grading.assignment import Limits, load
from thymio_sim_ros.grading.errors import GradingError


def test_a_pytest_file_is_an_assignment(tmp_path: Path) -> None:
    (tmp_path / "test_it.py").write_text("# test")
    (tmp_path / "conftest.py").write_text("# conftest")
    assignment = load(tmp_path / "test_it.py")
    assert (assignment.tests, assignment.expected, assignment.limits) == (("test_it.py",), (), Limits())
    assert assignment.content == {"test_it.py": b"# test", "conftest.py": b"# conftest"}


def test_hidden_tests_run_last(tmp_path: Path) -> None:
    for name in ("test_a.py", "test_b.py"):
        (tmp_path / name).write_text("")
    (tmp_path / "a.toml").write_text('hidden = ["test_a.py"]\ntests = ["test_b.py"]\n[limits]\ncpu_s = 3\n')
    assignment = load(tmp_path / "a.toml")
    assert (assignment.tests, assignment.limits.cpu_s) == (("test_b.py", "test_a.py"), 3.0)
    assert assignment.is_hidden("test_a.py::test_it[1]")
    assert not assignment.is_hidden("test_b.py::test_it")


@pytest.mark.parametrize(
    ("text", "reported"),
    [
        ("tests = 3", "tests: found 3, expected a list of relative paths"),
        ('tests = ["../test_a.py"]', "expected a list of relative paths below its folder"),
        ('tests = ["missing.py"]', "missing.py: No such file"),
        ("", "tests: found none"),
        ('test = ["a.py"]', "found the key 'test', expected tests, hidden, files, data, solution, mission or limits"),
        ("limits = 3", "limits: found 3, expected a table"),
        ("[limits]\ncpu = 3", "limits.cpu: unknown, expected one of cpu_s"),
        ("[limits]\ncpu_s = 0", "limits.cpu_s: found 0, expected a number above 0"),
        ("[limits]\nprocesses = 1.5", "limits.processes: found 1.5"),
        ("tests = [", "expected TOML"),
    ],
)
def test_an_invalid_assignment_is_explained(tmp_path: Path, text: str, reported: str) -> None:
    (tmp_path / "a.toml").write_text(text)
    with pytest.raises(GradingError) as caught:
        load(tmp_path / "a.toml")
    assert reported in str(caught.value)


def test_another_kind_of_file_is_rejected(tmp_path: Path) -> None:
    with pytest.raises(GradingError, match=r"expected a pytest file \(\*.py\) or an assignment"):
        load(tmp_path / "a.json")


HIDDEN = 'tests = ["test_a.py"]\nhidden = ["test_b.py"]\n'


@pytest.mark.parametrize(
    ("shown", "hidden", "secret"),
    [
        ("'one.json'", "'two.json'", ["two.json", "helper.py", "image.png"]),
        ("'one.json' 'two.json'", "'two.json'", ["helper.py", "image.png"]),
        ("import helper", "'two.json'", ["two.json", "image.png"]),
        ("'mine_one.json'", "f'{n}.json'", ["one.json", "two.json", "helper.py", "image.png"]),
        ("'folder/one.json' 'two.json'", "", ["helper.py", "image.png"]),
        ("import helpers", "", ["one.json", "two.json", "helper.py", "image.png"]),
    ],
)
def test_data_that_no_visible_test_names_is_hidden(tmp_path: Path, shown: str, hidden: str, secret: list[str]) -> None:
    data = {"one.json": "{}", "two.json": "{}", "helper.py": "'one.json'", "image.png": "", "conftest.py": ""}
    for name, text in {"test_a.py": shown, "test_b.py": hidden, **data}.items():
        (tmp_path / name).write_text(text)
    (tmp_path / "a.toml").write_text(f"{HIDDEN}data = {list(data)}")
    assignment = load(tmp_path / "a.toml")
    assert assignment.hidden_data() == secret
    visible, secrets = assignment.parts()
    assert (visible.tests, secrets.tests) == (("test_a.py",), ("test_b.py",))
    assert set(visible.content) == {"test_a.py", "conftest.py", *data} - set(secret)
    assert set(secrets.content) == {"test_b.py", *data}


def test_without_hidden_tests_there_is_one_part_with_all_files(tmp_path: Path) -> None:
    for name in ("test_a.py", "one.json"):
        (tmp_path / name).write_text("")
    (tmp_path / "a.toml").write_text('tests = ["test_a.py"]\ndata = ["one.json"]')
    (only,) = load(tmp_path / "a.toml").parts()
    assert set(only.content) == {"test_a.py", "one.json"}


def test_programs_of_their_own_cannot_be_graded_on_windows(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "test_it.py").write_text("def test_it(ros):\n    ros.run('node.py')\n")
    monkeypatch.setattr(grade.sys, "platform", "win32")
    with pytest.raises(GradingError, match=r"test_it\.py: found ros\.run on Windows, expected ros\.start"):
        grade.check_system(load(tmp_path / "test_it.py"))
