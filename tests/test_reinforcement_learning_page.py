"""docs/reinforcement-learning.md is true: its examples run, and what learns gets better."""

from __future__ import annotations

import csv
import re
import runpy
import sys
import xml.etree.ElementTree as ElementTree
from dataclasses import fields
from pathlib import Path

import pytest

gymnasium = pytest.importorskip("gymnasium", reason="needs gymnasium (pip install gymnasium)")
pytest.importorskip("pettingzoo", reason="needs pettingzoo (pip install pettingzoo)")

from tests import pages
from thymio_sim_ros.rl import TASKS, Rewards, Task
from thymio_sim_ros.rl.observations import SENSORS

ROOT = Path(__file__).parents[1]
PAGE = pages.read("reinforcement-learning.md")
*SHORT, LEARN, PICTURE = pages.blocks(PAGE, "python")


def _run(folder: Path, monkeypatch: pytest.MonkeyPatch, name: str, text: str, *arguments: str) -> None:
    folder.mkdir(exist_ok=True)
    (folder / name).write_text(text)
    monkeypatch.chdir(folder)
    monkeypatch.setattr(sys, "argv", [name, *arguments])
    runpy.run_path(name)


def _curve(folder: Path, seed: int) -> list[dict[str, str]]:
    with (folder / f"curve_{seed}.csv").open(newline="") as file:
        return list(csv.DictReader(file))


@pytest.mark.parametrize("example", SHORT)
def test_an_example_runs(example: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    _run(tmp_path, monkeypatch, "example.py", example)


def test_the_example_learns_and_repeats_bit_for_bit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    small = ("--seed", "2", "--generations", "5", "--robots", "16", "--steps", "150")
    for name in ("first", "second"):
        _run(tmp_path / name, monkeypatch, "learn.py", LEARN, *small)
    for name in ("curve_2.csv", "policy_2.csv"):
        assert (tmp_path / "first" / name).read_bytes() == (tmp_path / "second" / name).read_bytes()
    rows = _curve(tmp_path / "first", 2)
    assert [row["generation"] for row in rows] == ["1", "2", "3", "4", "5"]
    assert rows[-1]["simulated_min"] == "20.0"
    assert float(rows[-1]["mean_return_m"]) > float(rows[0]["mean_return_m"]) + 0.5


def test_the_picture_has_a_line_for_each_curve(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for seed, values in ((1, "-1.5 0 2"), (2, "-1 1 1.5")):
        rows = [f"{number},{value}" for number, value in enumerate(values.split(), start=1)]
        (tmp_path / f"curve_{seed}.csv").write_text("\n".join(["generation,mean_return_m", *rows, ""]))
    _run(tmp_path, monkeypatch, "picture.py", PICTURE, "curve_1.csv", "curve_2.csv")
    picture = ElementTree.fromstring(capsys.readouterr().out)
    lines = [line.get("points", "").split() for line in picture.iter("{http://www.w3.org/2000/svg}polyline")]
    assert [len(points) for points in lines] == [3, 3]
    assert lines[0][-1].endswith(",20.0")  # the largest value is at the top
    assert lines[0][0].endswith(",300.0")


def test_the_tables_name_what_there_is() -> None:
    for field in (*fields(Task), *fields(Rewards)):
        assert f"`{field.name}`" in PAGE, field.name
    for sensor in SENSORS:
        assert f'`"{sensor}"`' in PAGE, sensor
    for name, task in TASKS.items():
        assert f"`thymio/{name.capitalize()}-v0`" in PAGE
        assert f"`{task.playground}`" in PAGE
        assert gymnasium.spec(f"thymio/{name.capitalize()}-v0").kwargs == {"task": name}


def test_links_and_files_of_the_page_exist() -> None:
    for target in re.findall(r"\]\(([^)#:]+)\)", PAGE):
        assert (ROOT / "docs" / target).is_file(), target
    for path in re.findall(r"`((?:tests|thymio_sim_ros)/[\w/.]+)`", PAGE):
        assert (ROOT / path).exists(), path
