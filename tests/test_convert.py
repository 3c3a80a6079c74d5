"""thymio-sim convert: what is written, what is told, and how it ends."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.sim.builders import PLAYGROUNDS
from thymio_sim_ros.cli import main
from thymio_sim_ros.sim import playground

MAZE = (
    '<aseba-playground><color name="w" r="1" g="1" b="1"/><world w="100" h="100" color="w"/>'
    '<robot x="50" y="50"/>{}</aseba-playground>'
)
FEEDER = '<feeder x="5" y="5"/>'


@pytest.fixture
def maze(tmp_path: Path) -> Path:
    path = tmp_path / "maze.playground"
    path.write_text(MAZE.format(""))
    return path


def test_the_result_is_our_json_on_standard_output(maze: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["convert", str(maze)]) == 0
    written = capsys.readouterr()
    assert playground.loads(written.out, "maze") == playground.load(maze)
    assert written.err == ""


def test_the_result_goes_into_a_file(maze: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = maze.with_name("out.json")
    assert main(["convert", str(maze), "-o", str(out)]) == 0
    assert json.loads(out.read_text())["title"] == "maze"
    assert capsys.readouterr() == ("", "")


def test_what_cannot_be_expressed_is_told_on_standard_error(maze: Path, capsys: pytest.CaptureFixture[str]) -> None:
    maze.write_text(MAZE.format(FEEDER))
    assert main(["convert", str(maze)]) == 0
    told = capsys.readouterr().err
    assert told == (f"thymio-sim convert: {maze}: line 1: <feeder> left out: energy feeders are for e-pucks only\n")


def test_strict_writes_nothing_then(maze: Path, capsys: pytest.CaptureFixture[str]) -> None:
    maze.write_text(MAZE.format(FEEDER))
    assert main(["convert", "--strict", str(maze)]) == 1
    assert capsys.readouterr().out == ""


def test_a_broken_file_is_refused_and_nothing_written(maze: Path, capsys: pytest.CaptureFixture[str]) -> None:
    maze.write_text("<aseba-playground>")
    out = maze.with_name("out.json")
    assert main(["convert", str(maze), "-o", str(out)]) == 2
    assert f"{maze}: line 1: found no element found" in capsys.readouterr().err
    assert not out.exists()


@pytest.mark.parametrize("arguments", [["nowhere.playground"], ["base", "-o", "/nowhere/out.json"]])
def test_files_that_cannot_be_used_are_named(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["convert", *arguments]) == 2
    assert "nowhere" in capsys.readouterr().err


def test_the_schema_that_is_written_is_the_published_one(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["convert", "--schema"]) == 0
    assert capsys.readouterr().out == (PLAYGROUNDS / "playground.schema.json").read_text()


def test_a_file_is_required(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["convert"])
    assert "one of the arguments FILE --schema is required" in capsys.readouterr().err
