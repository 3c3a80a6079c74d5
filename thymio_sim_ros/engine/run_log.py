"""Run logs: the start of each run and all its inputs, from which it can be repeated bit for bit.

Version 2 is JSON lines in UTF-8:

    {"format": "thymio-sim run log", "version": 2, "made_by": "0.1.0"}
    {"world": {"name": "line", "playground": "the file's text", "seed": 0, "programs": [{"text": …}], …}}
    {"tick": 0, "to": "thymio", "do": "SetPen", "with": {"down": true, …}}
    {"tick": 250, "spawn": {"name": "late", "x_m": 0.5, "y_m": 0.0}}
    {"tick": 260, "load": "thymio", "program": {"name": "mine.aesl", "text": …}}
    {"tick": 270, "input": "Controlled", "with": {"robot": "thymio", "action": "pause"}}
    {"tick": 300, "remove": "late"}
    {"tick": 300, "state": "16 hexadecimal digits"}
    {"tick": 300, "reset": true, "programs": […], "devices": {…}}
    {"end": true}

`tick` is the number of ticks that had passed; it counts from 0 after `world` and `reset`. `state` is `Engine.digest`,
in each second and at the end of a run. A log without its last line was cut off, perhaps within a line; it is valid up
to the last `state`.

Logs of version 1 can be read as well. They have no programs, but what these commanded, and in place of `state`

    {"ticks": 100, "crc": "eight hexadecimal digits for each of these ticks"}

with the CRC-32 of the result (`repr` of readings and contacts) of each tick since the previous such line.
"""

from __future__ import annotations

import gzip
import json
import zlib
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO, Protocol, cast

import thymio_sim_ros
from aseba_vm import AeslError
from thymio_sim_ros.device.programs.program import ProgramError
from thymio_sim_ros.engine.command_codec import CommandJsonError
from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.engine.input_codec import (
    pop_devices,
    read_input,
    read_start,
    write_devices,
    write_input,
    write_start,
)
from thymio_sim_ros.engine.inputs import DevicesAdded, Input, Reset, RunStart
from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.sim.model import fields
from thymio_sim_ros.sim.model.fields import FieldError
from thymio_sim_ros.sim.playground.reader import PlaygroundError

__all__ = [
    "LogEnded",
    "LogEntry",
    "LogFile",
    "RunLog",
    "RunLogError",
    "StateSeen",
    "TicksChecked",
    "WorldReset",
    "WorldStarted",
    "digest",
    "made_by",
    "read",
]

FORMAT = "thymio-sim run log"
VERSION = 2
VERSIONS = (1, VERSION)
"""The versions that can be read."""
_WRONG = (
    ValueError, KeyError, IndexError, TypeError, AttributeError, OverflowError, RecursionError,
    FieldError, PlaygroundError, CommandJsonError, ProgramError, AeslError,
)  # fmt: skip
"""Exceptions caused by an invalid line."""
_DIGITS = 8


class RunLogError(ThymioSimError):
    """A log that cannot be read; the text has file, line, what was found and what was expected."""

    def __init__(self, path: str, line: int, problem: str) -> None:
        super().__init__(f"{path}: line {line}: {problem}")
        self.path, self.line = path, line


@dataclass(frozen=True, slots=True)
class WorldStarted:
    """Start of a world; `name` is that of its playground."""

    name: str
    start: RunStart


@dataclass(frozen=True, slots=True)
class StateSeen:
    """Digest of the state after so many ticks."""

    tick: int
    digest: str


@dataclass(frozen=True, slots=True)
class TicksChecked:
    """Digests of the results of ticks, in order, in a log of version 1."""

    crcs: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class LogEnded:
    """End of a complete log."""


@dataclass(frozen=True, slots=True)
class WorldReset:
    """The run was reset after so many ticks; `added`: the devices that it starts with, None as before."""

    tick: int
    added: DevicesAdded | None


LogEntry = WorldStarted | WorldReset | StateSeen | TicksChecked | LogEnded | tuple[int, Input]
"""Content of a line; an input has the tick after which it came."""


_END = {"end": True}
"""The last line of a complete log."""

_GZIP = b"\x1f\x8b"
"""First bytes of a file that is compressed with gzip."""


def digest(result: object) -> str:
    """Digest of the result of a tick in a log of version 1: 8 hexadecimal digits."""
    return f"{zlib.crc32(repr(result).encode()):0{_DIGITS}x}"


class LogFile(Protocol):
    """A file for text."""

    def write(self, text: str, /) -> int:
        """Append text."""

    def flush(self) -> None:
        """Write what is buffered."""

    def close(self) -> None:
        """Write what is buffered, and close the file."""


class RunLog:
    """Writes a log; a recorder of one engine at a time. Invariant: the file always ends with a whole line.

    If the file can no longer be written, `on_error` is called once and the log ends; without it OSError is raised, with
    the name of the file.
    """

    def __init__(self, file: LogFile, *, on_error: Callable[[OSError], None] | None = None) -> None:
        self._file: LogFile | None = file
        self._on_error = on_error
        self._engine: Engine | None = None
        self._write({"format": FORMAT, "version": VERSION, "made_by": thymio_sim_ros.__version__})

    def begin(self, name: str, engine: Engine) -> None:
        """Start to record an engine at its start; `name` is that of its playground. The one before ends."""
        self._end()
        self._write({"world": write_start(name, engine.start)})
        engine.recorders.append(self)
        self._engine = engine

    def record(self, tick: int, happened: Input) -> None:
        """Record an input after `tick` ticks; with a reset, what the devices start with from then on."""
        line = {"tick": tick, **write_input(happened)}
        if isinstance(happened, Reset) and self._engine is not None:
            start = self._engine.start
            line |= write_devices(DevicesAdded(start.devices, start.options, start.shares_numbers))
        self._write(line)

    def record_digest(self, tick: int, digest: str) -> None:
        """Record the digest of the state after `tick` ticks."""
        self._write(_state(tick, digest))
        if self._file is not None:
            with self._guarded(self._file):
                self._file.flush()

    def ending(self) -> str:
        """Return the lines that would complete the log at this moment; the log continues."""
        engine = self._engine
        states = [] if engine is None else [_state(engine.tick, engine.digest())]
        return "".join(_json(line) + "\n" for line in (*states, _END))

    def close(self) -> None:
        """Write the last lines and close the file."""
        self._end()
        self._write(_END)
        file, self._file = self._file, None
        if file is not None:
            with self._guarded(file):
                file.close()

    def _end(self) -> None:
        engine, self._engine = self._engine, None
        if engine is not None:
            engine.release(self)

    def _write(self, line: Mapping[str, Any]) -> None:
        if self._file is not None:
            with self._guarded(self._file):
                self._file.write(_json(line) + "\n")

    @contextmanager
    def _guarded(self, file: LogFile) -> Iterator[None]:
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


def _state(tick: int, digest: str) -> dict[str, Any]:
    return {"tick": tick, "state": digest}


def _json(line: Mapping[str, Any]) -> str:
    """A line that UTF-8 can encode: bytes of file names that are no text, lone surrogates in Python, are escaped."""
    return json.dumps(line, ensure_ascii=False).encode("utf-8", "backslashreplace").decode("utf-8")


def read(path: Path) -> Iterator[tuple[int, LogEntry]]:
    """Yield number and content of the lines of a log after the first. Raises OSError or RunLogError."""
    number = 0
    with _opened(path) as file:
        for number, text in enumerate(_lines(file), start=1):
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
    with _opened(path) as file:  # text would be decoded ahead, to where the log may be cut off
        return str(json.loads(file.readline()).get("made_by"))


def _opened(path: Path) -> BinaryIO:
    """Open a log, which may be compressed with gzip."""
    with path.open("rb") as file:
        is_compressed = file.read(len(_GZIP)) == _GZIP
    return cast(BinaryIO, gzip.open(path)) if is_compressed else path.open("rb")


def _lines(file: BinaryIO) -> Iterator[bytes]:
    """The lines of a log, up to where a compressed one is cut off or damaged."""
    with suppress(EOFError, zlib.error, gzip.BadGzipFile):
        yield from file


def _check_head(data: object) -> None:
    if not isinstance(data, dict) or data.get("format") != FORMAT:
        raise ValueError(f"found something else, expected a {FORMAT}")
    if data.get("version") not in VERSIONS:
        raise ValueError(f"found version {data.get('version')!r}, expected one of {', '.join(map(str, VERSIONS))}")


def _line(data: Any) -> LogEntry:
    match data:
        case {"world": dict(head)}:
            return WorldStarted(*read_start(head))
        case {"tick": int(tick), "state": str(state)}:
            return StateSeen(tick, state)
        case {"ticks": int(ticks), "crc": str(crc)} if len(crc) == ticks * _DIGITS:
            return TicksChecked(tuple(crc[start : start + _DIGITS] for start in range(0, len(crc), _DIGITS)))
        case {"end": True}:
            return LogEnded()
        case {"tick": int(tick), "reset": True, "programs": _, "devices": _}:
            return WorldReset(tick, pop_devices(dict(data)))
        case {"tick": int(tick), "reset": True}:
            return WorldReset(tick, None)
        case {"tick": int(tick), **members} if (happened := read_input(members)) is not None:
            return tick, happened
    raise ValueError(f"found {fields.describe(data)}, expected a line of a {FORMAT}")


def _explained(error: Exception) -> str:
    if isinstance(error, UnicodeDecodeError):
        return "found bytes that are not UTF-8, expected text"
    if isinstance(error, RecursionError):
        return f"found nesting without measure, expected a line of a {FORMAT}"
    if isinstance(error, json.JSONDecodeError):
        return f"found no JSON (column {error.colno}: {error.msg}), expected a line of a {FORMAT}"
    if isinstance(error, KeyError | TypeError | AttributeError | IndexError):
        return f"found a world with {error}, expected name, playground and all options"
    return str(error)
