"""thymio-sim convert: files, messages and exit codes."""

from __future__ import annotations

import json
import os
import random
import subprocess
import sys
from pathlib import Path

import pytest

from tests.sim.builders import PLAYGROUNDS
from thymio_sim_ros.cli.main import main
from thymio_sim_ros.sim.playground import reader
from thymio_sim_ros.sim.playground.reader import PlaygroundError

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
    assert reader.loads(written.out, "maze") == reader.load(maze)
    assert written.err == ""


@pytest.mark.process
def test_the_result_is_utf_8_whatever_the_terminal_has(maze: Path) -> None:
    maze.write_text(MAZE.format("<description>Größe 5 €</description>"), encoding="utf-8")
    out = maze.with_name("out.json")
    program = [
        sys.executable,
        "-c",
        "import sys; from thymio_sim_ros.cli.main import main; sys.exit(main())",
        "convert",
    ]
    with out.open("wb") as file:
        environment = os.environ | {"PYTHONIOENCODING": "latin-1"}
        assert subprocess.run([*program, maze], stdout=file, env=environment, check=False).returncode == 0
    assert reader.load(out).description == "Größe 5 €"


@pytest.mark.process
def test_a_reader_that_has_enough_is_no_error(maze: Path) -> None:
    program = f"{sys.executable} -c 'from thymio_sim_ros.cli.main import main; main()' convert {maze} | true"
    done = subprocess.run(program, shell=True, capture_output=True, check=False)
    assert (done.returncode, done.stderr) == (0, b"")


def test_two_large_pictures_can_be_read_again(tmp_path: Path) -> None:
    pixels = random.Random(1).randbytes(1000 * 1000 * 3)
    pytest.importorskip("PIL.Image").frombytes("RGB", (1000, 1000), pixels).save(tmp_path / "a.png")
    shapes = [{"kind": "picture", "name": f"p{i}", "image": "a.png", "size_x_m": 1, "x_m": i} for i in range(3)]
    path, out = tmp_path / "big.json", tmp_path / "out.json"
    path.write_text(json.dumps({"format": 1, "title": "Big", "shapes": shapes, "robots": []}))
    assert main(["convert", str(path), "-o", str(out)]) == 0
    assert out.stat().st_size > 10_000_000
    assert reader.load(out).shapes == reader.load(path).shapes
    shapes += [{**shape, "name": f"q{i}"} for i, shape in enumerate(shapes * 2)]
    path.write_text(json.dumps({"format": 1, "title": "Big", "shapes": shapes, "robots": []}))
    with pytest.raises(PlaygroundError, match=r"shapes\[\d\]\.image: found more than 24000000 bytes of images"):
        reader.load(path)


def test_the_result_goes_into_a_file(maze: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = maze.with_name("out.json")
    assert main(["convert", str(maze), "-o", str(out)]) == 0
    assert json.loads(out.read_text())["title"] == "maze"
    assert capsys.readouterr() == ("", "")


def test_what_cannot_be_converted_is_reported_on_stderr(maze: Path, capsys: pytest.CaptureFixture[str]) -> None:
    maze.write_text(MAZE.format(FEEDER))
    assert main(["convert", str(maze)]) == 0
    reported = capsys.readouterr().err
    assert reported == (f"thymio-sim convert: {maze}: line 1: <feeder> skipped: energy feeders are for e-pucks only\n")


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
