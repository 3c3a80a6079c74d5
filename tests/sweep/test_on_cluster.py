"""Sweeps on real clusters: the table of a plain loop, whatever runs it, and whatever happens on the way."""

from __future__ import annotations

import json
from collections.abc import Callable
from functools import partial
from pathlib import Path

import pytest

from tests.batch_runs.tasks import run_and_kill_once
from thymio_sim_ros.batch_runs.failure import Failure
from thymio_sim_ros.cli.main import main
from thymio_sim_ros.sweep.description import Description
from thymio_sim_ros.sweep.grid import Sweep
from thymio_sim_ros.sweep.run import Row, run_robots
from thymio_sim_ros.sweep.table import write_table

engine = pytest.importorskip("thymio_sim_ros.batch_runs.engine", exc_type=ImportError)

pytestmark = pytest.mark.process

OPTIONS = ("--seeds", "6", "--seconds", "1", "--parameter", "SPEED=100,200")


@pytest.fixture(scope="module")
def sweep(describe: Callable[..., Description]) -> Sweep:
    return describe(seeds=tuple(range(6)), seconds=1, parameters={"SPEED": (100, 200)}).sweep()


@pytest.fixture(scope="module")
def rows(sweep: Sweep) -> dict[int, list[Row]]:
    """The rows of a plain loop."""
    return {number: run_robots(sweep, number) for number in range(len(sweep))}


def written(folder: Path, sweep: Sweep, rows: dict[int, list[Row]]) -> bytes:
    """The bytes of a table."""
    path = folder / "expected.csv"
    write_table(path, sweep, rows)
    return path.read_bytes()


@pytest.mark.slow
def test_a_worker_that_is_killed_changes_nothing(tmp_path: Path, sweep: Sweep, rows: dict[int, list[Row]]) -> None:
    function = partial(run_and_kill_once, tmp_path / "mark", sweep, 5)
    found = [one for outcomes in engine.run_all(function, range(len(sweep)), workers=2) for one in outcomes]
    assert (tmp_path / "mark").exists()
    assert sorted(number for number, _ in found) == list(rows)
    assert not [one for _, one in found if isinstance(one, Failure)]
    assert written(tmp_path, sweep, dict(found)) == written(tmp_path, sweep, rows)


def test_a_resumed_sweep_has_the_same_table(
    tmp_path: Path,
    folder: Path,
    sweep: Sweep,
    rows: dict[int, list[Row]],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(folder)
    path = tmp_path / "table.csv"
    write_table(path, sweep, {number: rows[number] for number in (0, 3, 4, 9)})
    command = ["sweep", "--program", "pulse.aesl", "--playground", "hall.json", *OPTIONS, "--workers", "1"]
    assert main([*command, "-o", str(path)]) == 0
    assert path.read_bytes() == written(tmp_path, sweep, rows)
    captured = capsys.readouterr()
    assert json.loads(captured.out) == {"table": str(path), "runs": 12, "finished": 12, "resumed": 4, "errors": 0}
    assert captured.err == "thymio-sim: 12 of 12 runs\n"
