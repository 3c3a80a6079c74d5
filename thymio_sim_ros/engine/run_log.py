"""Run logs: all inputs of worlds, from which a run can be repeated bit for bit.

Version 1 is JSON lines in UTF-8:

    {"format": "thymio-sim run log", "version": 1, "made_by": "0.1.0"}
    {"world": {"name": "line", "playground": "the file's text", "seed": 0, "noise": true, …}}
    {"tick": 0, "to": "thymio", "do": "MotorTargets", "with": {"left": 100, "right": 100}}
    {"tick": 250, "spawn": {"name": "late", "x_m": 0.5, "y_m": 0.0}}
    {"tick": 300, "remove": "late"}
    {"tick": 300, "reset": true}
    {"ticks": 100, "crc": "eight hexadecimal digits for each of these ticks"}
    {"end": true}

`tick` is the number of ticks that had passed; it counts from 0 after `world` and `reset`. `crc` has the CRC-32 of the
result (`repr` of readings and contacts) of each tick since the previous such line. A log without its last line was cut
off, perhaps within a line; it is valid up to there.
"""

from __future__ import annotations

import json
import zlib
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, TextIO

import thymio_sim_ros
from thymio_sim_ros.engine import command_codec
from thymio_sim_ros.engine.command_codec import CommandJsonError
from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.sim.input_recorder import Input, Posted, Removed, Reset, Spawned, WorldOptions
from thymio_sim_ros.sim.model import fields
from thymio_sim_ros.sim.model.fields import FieldError
from thymio_sim_ros.sim.playground import reader as playgrounds
from thymio_sim_ros.sim.playground.reader import Playground, PlaygroundError, RobotStart
from thymio_sim_ros.sim.playground.writer import dumps
from thymio_sim_ros.sim.world import World

__all__ = ["LogEnded", "LogEntry", "RunLog", "RunLogError", "TicksChecked", "WorldStarted", "digest", "made_by", "read"]

FORMAT = "thymio-sim run log"
VERSION = 1
_TICKS_PER_LINE = 100
_WRONG = (ValueError, KeyError, TypeError, OverflowError, RecursionError, FieldError, PlaygroundError, CommandJsonError)
"""Exceptions caused by an invalid line."""
_DIGITS = 8


class RunLogError(ThymioSimError):
    """A log that cannot be read; the text has file, line, what was found and what was expected."""

    def __init__(self, path: str, line: int, problem: str) -> None:
        super().__init__(f"{path}: line {line}: {problem}")
        self.path, self.line = path, line


@dataclass(frozen=True, slots=True)
class WorldStarted:
    """Start of a world."""

    name: str
    playground: Playground
    options: WorldOptions


@dataclass(frozen=True, slots=True)
class TicksChecked:
    """Digests of the results of ticks, in order."""

    crcs: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class LogEnded:
    """End of a complete log."""


LogEntry = WorldStarted | TicksChecked | LogEnded | tuple[int, Input]
"""Content of a line; an input has the tick after which it came."""


def digest(result: object) -> str:
    """Digest of the result of a tick: 8 hexadecimal digits."""
    return f"{zlib.crc32(repr(result).encode()):0{_DIGITS}x}"


class RunLog:
    """Writes a log; the input recorder of one world at a time. Invariant: the file always ends with a whole line.

    If the file can no longer be written, `on_error` is called once and the log ends; without it OSError is raised, with
    the name of the file.
    """

    def __init__(self, file: TextIO, *, on_error: Callable[[OSError], None] | None = None) -> None:
        self._file: TextIO | None = file
        self._on_error = on_error
        self._crcs: list[str] = []
        self._write({"format": FORMAT, "version": VERSION, "made_by": thymio_sim_ros.__version__})

    def begin(self, name: str, world: World) -> None:
        """Start to record a new world."""
        self._flush()
        head = {"name": name, "playground": dumps(world.playground), **asdict(world.options)}
        self._write({"world": head})
        world.recorder = self

    def record(self, tick: int, happened: Input) -> None:
        """Record an input after `tick` ticks."""
        match happened:
            case Posted(name, command):
                kind, values = command_codec.encode(command)
                self._write({"tick": tick, "to": name, "do": kind, "with": values})
            case Spawned(start):
                self._write({"tick": tick, "spawn": fields.write(start)})
            case Removed(name):
                self._write({"tick": tick, "remove": name})
            case Reset():
                self._flush()
                self._write({"tick": tick, "reset": True})

    def record_step(self, result: object) -> None:
        """Record the result of a step."""
        self._crcs.append(digest(result))
        if len(self._crcs) == _TICKS_PER_LINE:
            self._flush()

    def close(self) -> None:
        """Write the last lines and close the file."""
        self._flush()
        self._write({"end": True})
        file, self._file = self._file, None
        if file is not None:
            with self._guarded(file):
                file.close()

    def _flush(self) -> None:
        if self._crcs:
            self._write({"ticks": len(self._crcs), "crc": "".join(self._crcs)})
            self._crcs.clear()
            if self._file is not None:
                with self._guarded(self._file):
                    self._file.flush()

    def _write(self, line: Mapping[str, Any]) -> None:
        if self._file is not None:
            with self._guarded(self._file):
                self._file.write(_json(line) + "\n")

    @contextmanager
    def _guarded(self, file: TextIO) -> Iterator[None]:
        """Context in which an OSError ends the log; data buffered by the file is dropped."""
        try:
            yield
        except OSError as error:
            self._file = None
            with suppress(OSError):
                file.close()
            if self._on_error is None:
                raise OSError(error.errno, error.strerror, getattr(file, "name", None)) from error
            self._on_error(error)


def _json(line: Mapping[str, Any]) -> str:
    """A line that UTF-8 can encode: bytes of file names that are no text, lone surrogates in Python, are escaped."""
    return json.dumps(line, ensure_ascii=False).encode("utf-8", "backslashreplace").decode("utf-8")


def read(path: Path) -> Iterator[tuple[int, LogEntry]]:
    """Yield number and content of the lines of a log after the first. Raises OSError or RunLogError."""
    number = 0
    with path.open("rb") as file:
        for number, text in enumerate(file, start=1):
            if number > 1 and not text.endswith(b"\n"):
                return  # cut off within a line, or within a character
            try:
                data = json.loads(text.decode("utf-8"))
                if number == 1:
                    _check_head(data)
                else:
                    yield number, _line(data)
            except _WRONG as error:
                raise RunLogError(str(path), number, _explained(error)) from error
    if number == 0:
        raise RunLogError(str(path), 1, f"found nothing, expected a {FORMAT}")


def made_by(path: Path) -> str:
    """Version of the program that wrote a log. The log must be valid for `read`."""
    with path.open("rb") as file:  # text would be decoded ahead, to where the log may be cut off
        return str(json.loads(file.readline()).get("made_by"))


def _check_head(data: object) -> None:
    if not isinstance(data, dict) or data.get("format") != FORMAT:
        raise ValueError(f"found something else, expected a {FORMAT}")
    if data.get("version") != VERSION:
        raise ValueError(f"found version {data.get('version')!r}, expected {VERSION}")


def _line(data: object) -> LogEntry:
    match data:
        case {"world": dict(head)}:
            return _world_started(head)
        case {"ticks": int(ticks), "crc": str(crc)} if len(crc) == ticks * _DIGITS:
            return TicksChecked(tuple(crc[start : start + _DIGITS] for start in range(0, len(crc), _DIGITS)))
        case {"end": True}:
            return LogEnded()
        case {"tick": int(tick), "to": str(name), "do": kind, "with": values}:
            return tick, Posted(name, command_codec.decode(kind, values))
        case {"tick": int(tick), "spawn": start}:
            return tick, Spawned(fields.read(RobotStart, start, "spawn"))
        case {"tick": int(tick), "remove": str(name)}:
            return tick, Removed(name)
        case {"tick": int(tick), "reset": True}:
            return tick, Reset()
    raise ValueError(f"found {fields.describe(data)}, expected a line of a {FORMAT}")


def _world_started(head: dict[str, Any]) -> WorldStarted:
    name, text, periods = head.pop("name"), head.pop("playground"), head.pop("periods_ns")
    if not isinstance(name, str) or not isinstance(text, str):
        raise ValueError("found a world whose name or playground is no text, expected both")
    pairs = None if periods is None else tuple((str(sensor), int(period_ns)) for sensor, period_ns in periods)
    return WorldStarted(name, playgrounds.loads(text, name), WorldOptions(**head, periods_ns=pairs))


def _explained(error: Exception) -> str:
    if isinstance(error, UnicodeDecodeError):
        return "found bytes that are not UTF-8, expected text"
    if isinstance(error, RecursionError):
        return f"found nesting without measure, expected a line of a {FORMAT}"
    if isinstance(error, json.JSONDecodeError):
        return f"found no JSON (column {error.colno}: {error.msg}), expected a line of a {FORMAT}"
    if isinstance(error, KeyError | TypeError):
        return f"found a world with {error}, expected name, playground and all options"
    return str(error)
