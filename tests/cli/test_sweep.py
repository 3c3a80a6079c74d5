"""The command `thymio-sim sweep` without a cluster: options, resuming, errors and what an interruption leaves."""

from __future__ import annotations

import csv
import json
import signal
from pathlib import Path

import pytest

from tests.batch_runs.loop import Loop
from thymio_sim_ros.cli import batch
from thymio_sim_ros.cli import sweep as command
from thymio_sim_ros.cli.batch import duration_text, progress_text
from thymio_sim_ros.cli.errors import USAGE_ERROR
from thymio_sim_ros.cli.main import main

engine = pytest.importorskip("thymio_sim_ros.batch_runs.engine", exc_type=ImportError)

SHORT = ("--program", "none", "--playground", "base", "--seconds", "0.1", "--measure", "x_m,variable.acc[2]")


@pytest.fixture
def loop(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Loop:
    found = Loop()
    monkeypatch.setattr(engine, "run_all", found.run_all)
    monkeypatch.chdir(tmp_path)
    return found


def table(path: str = "sweep.csv") -> list[dict[str, str]]:
    """The rows of a table."""
    with Path(path).open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def test_options_describe_a_sweep(loop: Loop, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["sweep", *SHORT, "--seeds", "3,5", "--parameter", "motors=ideal,firmware"]) == 0
    assert json.loads(capsys.readouterr().out)["finished"] == 4
    rows = table()
    assert [(row["run"], row["motors"], row["seed"]) for row in rows] == [
        ("0", "ideal", "3"),
        ("1", "ideal", "5"),
        ("2", "firmware", "3"),
        ("3", "firmware", "5"),
    ]
    assert {row["variable.acc[2]"] for row in rows} <= {"20", "21", "22", "23", "24"}


def test_a_program_that_no_robot_runs_is_a_note(loop: Loop, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    nodes = "".join(f'<node name="{name}">const C = 1\nvar n = C</node>' for name in ("thymio-II", "emma"))
    (tmp_path / "pair.aesl").write_text(f"<network>{nodes}</network>")
    options = ("--program", "pair.aesl", "--seeds", "3", "--parameter", "n=1,2", "--seconds", "0.1")
    assert main(["sweep", *options]) == 0
    lines = [line for line in capsys.readouterr().err.splitlines() if "emma" in line]
    assert lines == ["thymio-sim: pair.aesl: thymio: no robot is left for node 'emma'"]


def test_options_replace_what_the_file_says(loop: Loop, tmp_path: Path) -> None:
    lines = ['programs = "none"', 'playgrounds = "base"', "seeds = 4", "seconds = 0.1", "[parameters]", "noise = true"]
    (tmp_path / "small.toml").write_text("\n".join(lines))
    assert main(["sweep", "small.toml", "--seeds", "2", "--parameter", "motors=firmware"]) == 0
    assert [(row["noise"], row["motors"], row["seed"]) for row in table("small.csv")] == [
        ("true", "firmware", "0"),
        ("true", "firmware", "1"),
    ]


def test_a_finished_sweep_runs_nothing_again(loop: Loop) -> None:
    assert main(["sweep", *SHORT, "--seeds", "2"]) == 0
    before = Path("sweep.csv").read_bytes()
    assert main(["sweep", *SHORT, "--seeds", "2"]) == 0
    assert loop.calls == [[0, 1]]
    assert Path("sweep.csv").read_bytes() == before


def test_a_failed_run_is_a_row_and_is_repeated_on_request(loop: Loop, capsys: pytest.CaptureFixture[str]) -> None:
    loop.failing = {1}
    assert main(["sweep", *SHORT, "--seeds", "3"]) == command.FAILED
    assert [row["error"] for row in table()] == ["", "broken", ""]
    assert "3 of 3 runs, 1 with errors" in capsys.readouterr().err
    assert main(["sweep", *SHORT, "--seeds", "3"]) == command.FAILED
    loop.failing = set()
    assert main(["sweep", *SHORT, "--seeds", "3", "--repeat-errors"]) == 0
    assert loop.calls == [[0, 1, 2], [1]]
    assert [row["error"] for row in table()] == ["", "", ""]


def test_an_interrupted_sweep_keeps_what_is_there_and_continues(
    loop: Loop, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    ended: list[int] = []
    monkeypatch.setattr(command, "exit_by_signal", ended.append)
    loop.after_each = lambda: signal.raise_signal(signal.SIGINT)
    main(["sweep", *SHORT, "--seeds", "3"])
    assert ended == [signal.SIGINT]
    assert len(table()) < 3
    assert "stopped; the same command continues the sweep" in capsys.readouterr().err
    loop.after_each = lambda: None
    assert main(["sweep", *SHORT, "--seeds", "3"]) == 0
    assert [row["run"] for row in table()] == ["0", "1", "2"]


def test_the_table_of_another_sweep_is_not_touched(loop: Loop, capsys: pytest.CaptureFixture[str]) -> None:
    main(["sweep", *SHORT, "--seeds", "2"])
    before = Path("sweep.csv").read_bytes()
    assert main(["sweep", *SHORT, "--seeds", "3"]) == USAGE_ERROR
    assert "sweep.csv: it has the results of another sweep" in capsys.readouterr().err
    assert Path("sweep.csv").read_bytes() == before


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("missing.toml",), "missing.toml: No such file"),
        (("--program", "explorr"), "did you mean 'explorer'"),
        (("-o", "table.txt"), "table.txt: expected a name that ends in .csv or .parquet"),
        (("-o", "nowhere/table.csv"), "No such file or directory; expected a file that can be written"),
    ],
)
def test_rejected_input_is_one_line(
    loop: Loop, capsys: pytest.CaptureFixture[str], options: tuple[str, ...], message: str
) -> None:
    assert main(["sweep", *SHORT, *options]) == USAGE_ERROR
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("thymio-sim: ")
    assert message in line
    assert loop.calls == []


@pytest.mark.parametrize("options", [("--seeds", "x"), ("--parameter", "CRUISE"), ("--workers", "0")])
def test_wrong_options_are_rejected(options: tuple[str, ...], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["sweep", *options])
    assert ended.value.code == USAGE_ERROR
    assert "expected" in capsys.readouterr().err


def test_without_dask_the_command_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(batch, "find_spec", lambda _: None)
    assert main(["sweep"]) == USAGE_ERROR
    assert capsys.readouterr().err == "thymio-sim: Dask is not installed; run `pip install 'thymio_sim_ros[sweep]'`\n"


@pytest.mark.parametrize(
    ("state", "text"),
    [
        ((0, 10, 0, 0.0), "0 of 10 runs"),
        ((10, 5000, 2, 41.53), "10 of 5000 runs, 2 with errors, 41.5 per second, 2 min 0 s left"),
        ((1, 10_001, 0, 0.5), "1 of 10001 runs, 30 per minute, 5 h 33 min left"),
    ],
)
def test_progress_names_the_time_left(state: tuple[int, int, int, float], text: str) -> None:
    assert progress_text("runs", *state) == text


def test_durations_have_their_two_largest_units() -> None:
    assert [duration_text(seconds) for seconds in (0.4, 59.6, 3599.0, 90_000.0)] == [
        "0 s",
        "1 min 0 s",
        "59 min 59 s",
        "25 h 0 min",
    ]
