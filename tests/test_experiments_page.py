"""docs/experiments.md is true: its commands and its script run, and its table names what there is."""

from __future__ import annotations

import csv
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests import pages
from tests.patience import PROGRAM_S
from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.engine.run_log import RunLog
from thymio_sim_ros.files.loading import load_playground, read_program
from thymio_sim_ros.sim.commands import MotorTargets

ROOT = Path(__file__).parents[1]
PAGE = pages.read("experiments.md")
((SHELL,), (SWEEP,)) = (pages.blocks(PAGE, language) for language in ("sh", "python"))
COMMAND = "import sys; from thymio_sim_ros.cli.main import main; sys.exit(main())"
SEEDS = 3


def run(folder: Path, *command: str) -> str:
    """What a command prints."""
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    ended = subprocess.run(
        command, cwd=folder, env=environment, capture_output=True, text=True, timeout=PROGRAM_S, check=False
    )
    assert (ended.returncode, ended.stderr) == (0, "")
    return ended.stdout


@pytest.mark.slow
@pytest.mark.process
def test_the_loop_of_the_shell_leaves_a_result_and_a_log_for_each_seed(tmp_path: Path) -> None:
    command = tmp_path / "bin" / "thymio-sim"
    command.parent.mkdir()
    command.write_text(f"#!/bin/sh\nexec {sys.executable} -c '{COMMAND}' \"$@\"\n")
    command.chmod(0o755)
    shorter = SHELL.replace("--seconds 60", "--seconds 2")
    assert shorter != SHELL
    replayed = run(tmp_path, "sh", "-c", f"PATH={command.parent}:$PATH\n{shorter}")
    assert json.loads(replayed)["identical"]
    ends = [json.loads((tmp_path / f"run_{seed}.json").read_text())["robots"]["thymio"] for seed in (1, 2, 3)]
    assert len({end["x_m"] for end in ends}) == len(ends)


@pytest.mark.slow
@pytest.mark.process
def test_the_script_gives_a_row_for_each_seed(tmp_path: Path) -> None:
    (tmp_path / "sweep.py").write_text(SWEEP)
    rows = list(csv.DictReader(run(tmp_path, sys.executable, "sweep.py", str(SEEDS)).splitlines()))
    assert [row["seed"] for row in rows] == [str(seed) for seed in range(SEEDS)]
    assert len({row["way_m"] for row in rows}) == SEEDS
    assert {row["program"] for row in rows} == {"running"}
    assert all(1 < float(row["way_m"]) < 10 for row in rows)
    assert all(0 < float(row["nearest_m"]) < 0.14 for row in rows)


def test_what_the_table_says_can_be_done(tmp_path: Path) -> None:
    playground = load_playground("two_robots")[1]
    program = read_program("obedient")
    file = tmp_path / "run.jsonl"
    log = RunLog(file.open("w", encoding="utf-8", newline="\n"))
    options = {"motor_model": "firmware", "proximity_model": "cone"}
    engine = Engine(playground, {"blue": program}, noise=False, **options)
    log.begin("two_robots", engine)
    engine.post("red", MotorTargets(100, 100))
    x_m = engine.world.robots["red"].pose.x_m
    assert engine.until(lambda: engine.world.robots["red"].pose.x_m > x_m + 0.01, 5)
    engine.press("blue", "forward")
    assert engine.until(lambda: engine.devices["blue"].variables.get("button.forward") == (1,), 1)
    engine.press("blue", "forward", pressed=False)
    engine.set_variable("blue", "leds.top", [32, 0, 0])
    assert engine.emitted == []
    log.close()
    assert json.loads(file.read_text().splitlines()[-1]) == {"end": True}


def test_links_and_files_of_the_page_exist() -> None:
    for target in re.findall(r"\]\(([^)#]+)", PAGE):
        assert (ROOT / "docs" / target).is_file(), target
    for path in re.findall(r"`((?:tests|thymio_sim_ros)/[\w/.]+)`", PAGE):
        assert (ROOT / path).exists(), path
