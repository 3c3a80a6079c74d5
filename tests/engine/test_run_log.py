"""Run logs: what they hold, and how damaged ones are refused."""

from __future__ import annotations

import io
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.sim.builders import FLOOR, make
from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.engine.inputs import DevicesAdded, Posted, Removed, Spawned
from thymio_sim_ros.engine.run_log import LogEnded, RunLog, RunLogError, StateSeen, WorldReset, WorldStarted, read
from thymio_sim_ros.sim.commands import MotorTargets
from thymio_sim_ros.sim.playground.reader import RobotStart
from thymio_sim_ros.sim.world import WorldOptions


class Full(io.StringIO):
    """A file on a disk that is full after some lines."""

    def __init__(self, room: int) -> None:
        super().__init__()
        self._room = room

    def write(self, text: str) -> int:
        self._room -= 1
        if self._room < 0:
            raise OSError(28, "No space left on device")
        return super().write(text)


class FullWhen(io.StringIO):
    """A file whose disk is found to be full by one method, as by a buffered one."""

    def __init__(self, method: str) -> None:
        super().__init__()
        self._method = method

    def flush(self) -> None:
        if self._method == "flush":
            raise OSError(28, "No space left on device")

    def close(self) -> None:
        method, self._method = self._method, ""
        super().close()
        if method == "close":
            raise OSError(28, "No space left on device")


@pytest.mark.parametrize("method", ["flush", "close"])
def test_a_disk_that_becomes_full_is_reported_once_and_the_world_continues(method: str) -> None:
    reported: list[OSError] = []
    log = RunLog(FullWhen(method), on_error=reported.append)
    engine = Engine(make([FLOOR]))
    log.begin("small", engine)
    engine.run(2.5)
    log.close()
    assert [error.errno for error in reported] == [28]
    assert engine.now_ns == 2_500_000_000


def run_and_close(log: RunLog, engine: Engine) -> None:
    engine.run(2.5)
    log.close()


@pytest.mark.parametrize("method", ["flush", "close"])
def test_without_a_handler_it_is_raised(method: str) -> None:
    log = RunLog(FullWhen(method))
    engine = Engine(make([FLOOR]))
    log.begin("small", engine)
    with pytest.raises(OSError, match="No space left"):
        run_and_close(log, engine)


@pytest.fixture
def written(tmp_path: Path) -> Path:
    """The log of a small run."""
    path = tmp_path / "run.jsonl"
    log = RunLog(path.open("w", encoding="utf-8"))
    engine = Engine(make([FLOOR]), seed=4, noise=False, proximity_model="enki", periods_ns={"proximity": 100_000_000})
    log.begin("small", engine)
    engine.post("thymio", MotorTargets(100, 200))
    engine.run(1.5)
    engine.spawn(RobotStart("late", 1.0, 1.0))
    engine.remove("late")
    engine.reset()
    engine.run(0.02)
    log.close()
    return path


def test_a_log_contains_everything_in_order(written: Path) -> None:
    lines = [line for _, line in read(written)]
    start = lines[0]
    assert isinstance(start, WorldStarted)
    assert start.name == "small"
    assert start.start.world == WorldOptions(4, False, "enki", "ideal", (("proximity", 100_000_000),))
    assert start.start.playground.solids == make([FLOOR]).solids
    inputs = [line for line in lines if isinstance(line, tuple)]
    assert inputs == [
        (0, Posted("thymio", MotorTargets(100, 200))),
        (150, Spawned(RobotStart("late", 1.0, 1.0))),
        (150, Removed("late")),
    ]
    assert [line for line in lines if isinstance(line, WorldReset)] == [WorldReset(150, DevicesAdded({}))]
    assert [line.tick for line in lines if isinstance(line, StateSeen)] == [100, 150, 2]
    assert lines[-1] == LogEnded()


def test_every_line_is_json_and_names_the_format_first(written: Path) -> None:
    first, *_ = lines = [json.loads(line) for line in written.read_text().splitlines()]
    assert (first["format"], first["version"]) == ("thymio-sim run log", 2)
    assert all(isinstance(line, dict) for line in lines)


def test_a_full_disk_ends_the_log_and_not_the_world() -> None:
    reported: list[OSError] = []
    log = RunLog(Full(3), on_error=reported.append)
    engine = Engine(make([FLOOR]))
    log.begin("small", engine)
    for _ in range(5):
        engine.post("thymio", MotorTargets(1, 1))
    engine.run(2.0)
    log.close()
    assert [error.strerror for error in reported] == ["No space left on device"]


def test_without_a_callback_a_full_disk_is_an_error() -> None:
    with pytest.raises(OSError, match="No space left"):
        RunLog(Full(0))


def _line(number: int, text: str) -> Callable[[list[str]], list[str]]:
    return lambda lines: [*lines[: number - 1], text, *lines[number:]]


def _change(number: int, **members: Any) -> Callable[[list[str]], list[str]]:
    def change(lines: list[str]) -> list[str]:
        data = json.loads(lines[number - 1])
        data = {"world": data["world"] | members} if "world" in data else data | members
        return [*lines[: number - 1], json.dumps(data), *lines[number:]]

    return change


@pytest.mark.parametrize(
    ("damage", "text"),
    [
        (lambda _: [], "line 1: found nothing, expected a thymio-sim run log"),
        (_line(1, "{}"), "line 1: found something else, expected a thymio-sim run log"),
        (_line(1, "hello"), r"line 1: found no JSON \(column 1: Expecting value\)"),
        (_change(1, version=3), "line 1: found version 3, expected one of 1, 2"),
        (_line(2, '{"world": {}}'), "line 2: found a world with 'name', expected name, playground and all options"),
        (_change(2, speed=3), "line 2: found a world with .*speed"),
        (_change(2, playground="{"), "line 2: small: .*expected JSON"),
        (_line(3, '{"tick": 0, "to": "thymio"}'), "line 3: found {'tick': 0, 'to': 'thymio'}, expected a line"),
        (_change(3, do="Fly"), "line 3: found the command 'Fly'"),
        (_change(4, state=5), "line 4: found {'tick': 100, 'state': 5}"),
        (_change(2, playground=5), "line 2: found a world whose name or playground is no text"),
        (_change(2, periods_ns=[["ground", "x"]]), "line 2: invalid literal"),
        (_line(4, "[" * 100_000), "line 4: found nesting without measure"),
        (_line(6, '{"tick": 1, "spawn": {}}'), "line 6: spawn.name: found nothing"),
        (_line(4, '{"tick'), "line 4: found no JSON"),
    ],
)
def test_a_damaged_log_is_refused_with_its_line(
    written: Path, damage: Callable[[list[str]], list[str]], text: str
) -> None:
    lines = damage(written.read_text().splitlines())
    written.write_text("".join(f"{line}\n" for line in lines))
    with pytest.raises(RunLogError, match=text):
        list(read(written))


def test_a_log_that_was_cut_off_within_a_line_is_good_up_to_there(written: Path) -> None:
    whole = [line for _, line in read(written)]
    written.write_text(written.read_text()[:-20])
    assert [line for _, line in read(written)] == whole[:-2]


def test_and_within_a_character(tmp_path: Path) -> None:
    path = tmp_path / "run.jsonl"
    log = RunLog(path.open("w", encoding="utf-8"))
    log.begin("größer", Engine(make([FLOOR])))
    log.begin("größer", Engine(make([FLOOR])))
    log.close()
    data = path.read_bytes()
    path.write_bytes(data[: data.rindex("ö".encode()) + 1])
    assert [type(line) for _, line in read(path)] == [WorldStarted, StateSeen]


def test_bytes_that_are_no_text_are_refused(written: Path) -> None:
    written.write_bytes(written.read_bytes() + b"\xff\n")
    with pytest.raises(RunLogError, match="found bytes that are not UTF-8"):
        list(read(written))


def test_a_name_whose_bytes_are_no_text_is_kept(tmp_path: Path) -> None:
    path = tmp_path / "run.jsonl"
    log = RunLog(path.open("w", encoding="utf-8"))
    log.begin("gr\udcfcn – ü", Engine(make([FLOOR])))
    log.close()
    path.read_bytes().decode("utf-8")
    assert [entry.name for _, entry in read(path) if isinstance(entry, WorldStarted)] == ["gr\udcfcn – ü"]
