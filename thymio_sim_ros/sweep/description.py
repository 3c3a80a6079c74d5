"""A description of a sweep (a TOML or JSON file, options of the command) → a checked `Sweep`."""

from __future__ import annotations

import difflib
import json
import math
import tomllib
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import Any

from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.files import resources
from thymio_sim_ros.files.loading import load_playground, read_text
from thymio_sim_ros.sim.playground.writer import dumps
from thymio_sim_ros.sweep.errors import SweepError
from thymio_sim_ros.sweep.grid import Source, Sweep, Value
from thymio_sim_ros.sweep.measures import MEASURES, check_measure, measure_of
from thymio_sim_ros.sweep.parameters import check, notes

__all__ = ["Description", "described", "notes_of", "read_description"]

MAX_RUNS = 1_000_000
MAX_SECONDS = 1e6


@dataclass(frozen=True, slots=True)
class Description:
    """The content of a file of a sweep; its keys have the names of the fields. `folder`: base of relative paths.

    Raises SweepError for a value that is not possible by itself; `sweep` checks the rest.
    """

    programs: tuple[str, ...] = ("explorer",)
    playgrounds: tuple[str, ...] = ("obstacle",)
    seeds: tuple[int, ...] = (0,)
    seconds: float = 60.0
    measures: tuple[str, ...] = tuple(MEASURES)
    parameters: Mapping[str, tuple[Value, ...]] = field(default_factory=dict)
    limit_s: float = 600.0
    folder: Path = Path()

    def __post_init__(self) -> None:
        runs = math.prod(map(len, (self.programs, self.playgrounds, self.seeds, *self.parameters.values())))
        _expect("sweep", f"{runs} runs", runs <= MAX_RUNS, f"at most {MAX_RUNS}")
        for name in ("programs", "playgrounds", "seeds", "measures"):
            _check_list(name, getattr(self, name))
        for name, values in self.parameters.items():
            _check_list(f"parameters.{name}", values)
        _expect("seconds", self.seconds, 0.01 <= self.seconds <= MAX_SECONDS, f"0.01 to {MAX_SECONDS:g} s")
        _expect("limit_s", self.limit_s, self.limit_s > 0, "seconds of processor time above 0")

    def sweep(self) -> Sweep:
        """Read all files, and check each program, playground and value of a parameter.

        Raises SweepError with the first that is not possible.
        """
        for measure in self.measures:
            measure_of(measure)
        try:
            programs = tuple(Source(name, read_text(self._beside(name))[0]) for name in self.programs)
            playgrounds = tuple(
                Source(name, dumps(load_playground(self._beside(name))[1])) for name in self.playgrounds
            )
        except (ThymioSimError, OSError) as error:
            raise SweepError(str(error)) from error
        parameters = tuple(self.parameters.items())
        times = {"seconds": float(self.seconds), "limit_s": float(self.limit_s)}
        sweep = Sweep(programs, playgrounds, parameters, self.seeds, measures=self.measures, **times)
        _check(sweep)
        return sweep

    def _beside(self, name: str) -> str:
        """The path of a file of this name in the folder, or the name, which may be a shipped one.

        A name may end in that of one of several playgrounds in an archive: `maps.zip#a.playground`.
        """
        path = self.folder / resources.expanded(name)
        archive = self.folder / resources.expanded(name.partition("#")[0])
        return str(path) if path.is_file() or archive.is_file() else name


def read_description(path: Path) -> Description:
    """Read a file. Raises SweepError that says where, what was found and what was expected."""
    try:
        text = path.read_text(encoding="utf-8")
        data = tomllib.loads(text) if path.suffix == ".toml" else json.loads(text)
    except OSError as error:
        raise SweepError(f"{path}: {error.strerror}; expected a sweep in JSON or TOML") from error
    except (ValueError, RecursionError) as error:
        raise SweepError(f"{path}: {error}; expected a sweep in JSON, or in TOML with a name in .toml") from error
    try:
        if not isinstance(data, dict):
            raise SweepError("found no keys, expected an object with programs, playgrounds, seeds, …")
        return Description(**described(data), folder=path.parent)
    except SweepError as error:
        raise SweepError(f"{path}: {error}") from error
    except RecursionError as error:
        raise SweepError(
            f"{path}: parameters: found tables nested without measure, expected names with dots"
        ) from error


def described(data: Mapping[str, object]) -> dict[str, Any]:
    """Values of the fields of a description, from a file or from options. Raises SweepError."""
    known = {field.name for field in fields(Description)} - {"folder"}
    for key in data:
        if key not in known:
            near = difflib.get_close_matches(key, known, 1)
            hint = f"; did you mean '{near[0]}'?" if near else ""
            raise SweepError(f"found the key '{key}', expected some of {', '.join(sorted(known))}{hint}")
    values: dict[str, Any] = dict(data)
    if "seeds" in values:
        values["seeds"] = _seeds(values["seeds"])
    for key in ("programs", "playgrounds", "measures"):
        if key in values:
            values[key] = _list_of(key, values[key], str, "texts")
    for key in ("seconds", "limit_s"):
        if key in values:
            _expect(key, values[key], _is_number(values[key]), "a number")
    if "parameters" in values:
        values["parameters"] = _parameters(values["parameters"])
    return values


def _parameters(found: object) -> dict[str, tuple[Value, ...]]:
    if not isinstance(found, dict):
        raise SweepError(f"parameters: found {_shown(found)}, expected names, each with a list of values")
    return {
        name: tuple(_list_of(f"parameters.{name}", values, (bool, int, float, str), "numbers, texts, true and false"))
        for name, values in _flat(found).items()
    }


def _flat(found: Mapping[str, object], prefix: str = "") -> dict[str, object]:
    """The entries by name with dots: TOML reads `playground.box.x_m = [0.1]` as tables in tables."""
    flat: dict[str, object] = {}
    for name, value in found.items():
        flat |= _flat(value, f"{prefix}{name}.") if isinstance(value, dict) else {f"{prefix}{name}": value}
    return flat


def _seeds(found: object) -> tuple[int, ...]:
    """The seeds: a number of them, from 0, or a list."""
    if isinstance(found, int) and not isinstance(found, bool):
        _expect("seeds", found, 1 <= found <= MAX_RUNS, "a number of seeds above 0, or a list")
        return tuple(range(found))
    return tuple(int(seed) for seed in _list_of("seeds", found, int, "integers, or the number of seeds"))


def _list_of(key: str, found: object, types: type | tuple[type, ...], what: str) -> tuple[Value, ...]:
    items = found if isinstance(found, list) else [found]
    allowed = types if isinstance(types, tuple) else (types,)
    for item in items:
        _expect(key, item, type(item) in allowed, f"a list of {what}")
    return tuple(items)


def _check_list(name: str, values: Collection[Value]) -> None:
    _expect(name, list(values), len(values) > 0, "at least one value")
    seen = set()
    for value in values:
        if repr(value) in seen:
            raise SweepError(f"{name}: found {_shown(value)} twice, expected each value once")
        seen.add(repr(value))


def _expect(name: str, found: object, holds: bool, expected: str) -> None:
    if not holds:
        raise SweepError(f"{name}: found {_shown(found)}, expected {expected}")


def _shown(found: object) -> str:
    """A value of JSON or TOML, which also has dates."""
    return json.dumps(found, default=str)


def _is_number(value: object) -> bool:
    try:
        return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
    except OverflowError:  # an integer above all floats
        return False


def notes_of(sweep: Sweep) -> list[str]:
    """Mismatches between the files of the programs and the robots, each once."""
    first = _first(sweep)
    return list(dict.fromkeys(note for number in range(len(first)) for note in notes(first.run(number))))


def _first(sweep: Sweep) -> Sweep:
    """A run for each program and playground, with the first value of each parameter."""
    return replace(sweep, seeds=sweep.seeds[:1], parameters=tuple((name, some[:1]) for name, some in sweep.parameters))


def _check(sweep: Sweep) -> None:
    """Check a run for each program, playground and value; not for each combination, of which there may be many."""
    first = _first(sweep)
    programs = [program for number in range(len(first)) for program in check(first.run(number))]
    for measure in sweep.measures:
        check_measure(measure, programs)
    for index, (name, values) in enumerate(sweep.parameters):
        for value in values[1:]:
            changed = [*first.parameters]
            changed[index] = (name, (value,))
            check(replace(first, parameters=tuple(changed)).run(0))
