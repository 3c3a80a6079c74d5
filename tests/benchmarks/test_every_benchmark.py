"""Every benchmark of the folder runs in quick mode, with --help, and has a section of the page of results."""

from __future__ import annotations

import importlib.util
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from benchmarks.lib import command, page, report
from tests.patience import PROGRAM_S

ROOT = Path(__file__).parents[2]
FOUND = {
    "module": lambda name: importlib.util.find_spec(name) is not None,
    "program": lambda name: shutil.which(name) is not None,
    "file": lambda name: (ROOT / name).exists(),
}
"""Whether something that a benchmark reports as missing is there."""

MARKS = {"page": pytest.mark.browser}
EACH = [pytest.param(name, marks=MARKS.get(name, ())) for name in command.names()]


def run(*arguments: str) -> subprocess.CompletedProcess[str]:
    """Run the command from the root of the repository, as a user would."""
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    argv = [sys.executable, "-m", "benchmarks", *arguments]
    return subprocess.run(
        argv, cwd=ROOT, env=environment, capture_output=True, text=True, timeout=PROGRAM_S, check=False
    )


def skip_if_missing(code: int | str | None, stderr: str) -> None:
    """Skip the test if a benchmark needs something that is missing indeed; fail if it is there."""
    if code != command.MISSING:
        return
    last = stderr.splitlines()[-1]
    kind, _, name = last.removeprefix("missing ").partition(": ")
    assert kind in FOUND, stderr
    assert not FOUND[kind](name), f"{kind} {name} is there"
    pytest.skip(last)


def test_the_folder_has_benchmarks() -> None:
    assert {"page", "simulator"} <= set(command.names())


@pytest.mark.process
@pytest.mark.slow
@pytest.mark.parametrize("name", EACH)
def test_a_benchmark_runs_in_quick_mode(name: str, tmp_path: Path) -> None:
    path = tmp_path / "found.json"
    done = run(name, "--quick", "--json", str(path))
    skip_if_missing(done.returncode, done.stderr)
    assert done.returncode == 0, done.stderr
    stored = json.loads(path.read_text(encoding="utf-8"))
    assert stored["benchmark"] == name
    assert any(table["rows"] for table in stored["tables"])
    for table in stored["tables"]:
        assert all(len(row) == len(table["columns"]) for row in table["rows"])
    assert report.markdown(stored) in done.stdout


def help_of(name: str) -> int | str | None:
    """Print the help of a benchmark; return the exit code."""
    try:
        return command.run(name, ["--help"])
    except SystemExit as ended:
        return ended.code


@pytest.mark.parametrize("name", command.names())
def test_a_benchmark_has_help(name: str, capsys) -> None:
    code = help_of(name)
    out, err = capsys.readouterr()
    skip_if_missing(code, err)
    assert code == 0
    for option in ("--quick", "--json"):
        assert option in out


def test_every_benchmark_has_a_section_of_the_page() -> None:
    text = page.PAGE.read_text(encoding="utf-8")
    assert sorted(page.names(text)) == sorted([*command.names(), "goals"])


def test_every_result_is_that_of_a_benchmark() -> None:
    assert {path.stem for path in page.RESULTS.glob("*.json")} <= set(command.names())


def test_the_page_agrees_with_the_stored_results() -> None:
    text = page.PAGE.read_text(encoding="utf-8")
    assert page.rendered(text) == text, "run `python -m benchmarks --render`"


def test_the_page_has_no_table_that_is_written_by_hand() -> None:
    text = re.sub(r"<!-- results: \w+ -->.*?<!-- end of results -->", "", page.PAGE.read_text("utf-8"), flags=re.DOTALL)
    assert not [line for line in text.splitlines() if line.startswith("|")]


@pytest.mark.process
@pytest.mark.slow
def test_another_checkout_is_measured_in_turn(tmp_path: Path) -> None:
    path = tmp_path / "found.json"
    done = run("simulator_runner", "--quick", "--against", str(ROOT), "--json", str(path))
    assert done.returncode == 0, done.stderr
    stored = json.loads(path.read_text(encoding="utf-8"))
    assert stored["tables"][0]["columns"] == ["× real time", "now", "before", "ratio"]
    assert all(now and before and ratio for _, now, before, ratio in stored["tables"][0]["rows"])


@pytest.mark.process
@pytest.mark.slow
def test_a_quick_run_of_all_stores_nothing() -> None:
    before = page.PAGE.read_bytes(), sorted((path, path.read_bytes()) for path in page.RESULTS.iterdir())
    done = run("--quick", "--only", "aseba_machine", "simulator_runner")
    assert done.returncode == 0, done.stderr
    assert re.findall("^== .*$", done.stdout, re.MULTILINE) == ["== aseba_machine", "== simulator_runner"]
    assert before == (page.PAGE.read_bytes(), sorted((path, path.read_bytes()) for path in page.RESULTS.iterdir()))


@pytest.mark.process
def test_an_unknown_benchmark_is_an_error() -> None:
    done = run("nothing")
    assert done.returncode == 2
    assert "there is no benchmark 'nothing'" in done.stderr
