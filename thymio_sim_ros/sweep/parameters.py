"""Parameters of a run, by the form of their names.

| name | what |
|---|---|
| `motors`, `proximity`, `noise` | the models of the robot, and whether sensors and motors are noisy |
| `playground.NAME.FIELD` | a field of the robot or shape of this name in the playground |
| another | a constant of the program; if it has none of this name, a variable, set once the program has started |
"""

from __future__ import annotations

import difflib
import json
from collections.abc import Collection, Mapping
from functools import lru_cache
from typing import Any

from aseba_vm import AeslError
from thymio_sim_ros.device.programs.program import ProgramError, ThymioProgram, parse
from thymio_sim_ros.device.programs.program_assignment import Assignment, note_lines
from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.files.loading import assignments_of
from thymio_sim_ros.sim.commands import MOTOR_MODELS
from thymio_sim_ros.sim.ground.sampling import Ground
from thymio_sim_ros.sim.model.robot_constants import PROXIMITY_MODELS
from thymio_sim_ros.sim.playground import reader
from thymio_sim_ros.sim.playground.reader import Playground, PlaygroundError
from thymio_sim_ros.sweep.errors import SweepError
from thymio_sim_ros.sweep.grid import Run, Source, Value

__all__ = ["MODELS", "check", "notes", "start"]

MODELS: Mapping[str, tuple[Value, ...]] = {
    "motors": MOTOR_MODELS,
    "proximity": PROXIMITY_MODELS,
    "noise": (True, False),
}
"""Parameters of the simulator, and their values."""

_PLAYGROUND = "playground."
_INT16 = range(-0x8000, 0x8000)

Words = tuple[tuple[str, int], ...]


def check(run: Run) -> list[ThymioProgram]:
    """The programs of a run, without a world.

    Raises SweepError if a parameter does not fit program or playground.
    """
    return [*_prepared(run)[1].values()]


def notes(run: Run) -> list[str]:
    """Mismatches between the program's file and the robots. Raises SweepError as `check` does."""
    robots = tuple(robot.name for robot in _playground(run.playground, _fields(run)).robots)
    words = tuple((name, value) for name, value in run.values if isinstance(value, int))
    lines = note_lines((name, share.notes) for name, share in _assigned(run.program, robots, words).items())
    return [f"{run.program.name}: {line}" for line in lines]


def start(run: Run) -> Engine:
    """A run at time 0. Raises SweepError for a parameter that does not fit its program or playground.

    At most one run of a process may be under way: the next one with the same playground takes its ground over.
    """
    playground, programs, variables, models = _prepared(run)
    engine = Engine(
        playground,
        programs,
        motor_model=str(models.get("motors", MOTOR_MODELS[0])),
        proximity_model=str(models.get("proximity", PROXIMITY_MODELS[0])),
        noise=bool(models.get("noise", True)),
        seed=run.seed,
        ground=_ground(run.playground, _fields(run)),
    )
    for robot, device in engine.devices.items():
        for name, word in variables:
            if name in device.variables.addresses():
                engine.set_variable(robot, name, [word])
    return engine


def _prepared(run: Run) -> tuple[Playground, dict[str, ThymioProgram], Words, dict[str, Value]]:
    """Playground, programs by robot, variables to set, and parameters of the simulator."""
    models = {name: value for name, value in run.values if name in MODELS}
    for name, value in models.items():
        _expect(name, value, value in MODELS[name], f"one of {', '.join(map(json.dumps, MODELS[name]))}")
    playground = _playground(run.playground, _fields(run))
    words = []
    for name, value in run.values:
        if name not in models and not name.startswith(_PLAYGROUND):
            is_word = isinstance(value, int) and not isinstance(value, bool) and value in _INT16
            _expect(name, value, is_word, f"an integer from {_INT16[0]} to {_INT16[-1]} for the program")
            words.append((name, int(value)))
    robots = tuple(robot.name for robot in playground.robots)
    programs, variables = _programs(run.program, robots, tuple(words))
    return playground, programs, variables, models


def _expect(name: str, found: object, holds: bool, expected: str) -> None:
    if not holds:
        raise SweepError(f"parameter {name}: found {json.dumps(found)}, expected {expected}")


def _fields(run: Run) -> str:
    """Fields of the playground that are changed, name → value, as JSON, in which 1, 1.0 and true differ."""
    return json.dumps({name: value for name, value in run.values if name.startswith(_PLAYGROUND)})


@lru_cache(maxsize=4)
def _ground(source: Source, fields: str) -> Ground:
    """The ground of a playground, which takes a third of a short run to paint; a world restores it."""
    playground = _playground(source, fields)
    return Ground(playground.floors, playground.paints)


@lru_cache(maxsize=16)
def _playground(source: Source, fields: str) -> Playground:
    """A playground with changed fields, as `_fields` returns them."""
    data = json.loads(source.text)
    for name, value in json.loads(fields).items():
        _set_field(data, name, value, source.name)
    try:
        return reader.loads(json.dumps(data), source.name)
    except PlaygroundError as error:
        raise SweepError(str(error)) from error


def _set_field(data: Any, name: str, value: Value, playground: str) -> None:
    _, item, *path = name.split(".")
    items = {found["name"]: found for found in (*data["robots"], *data["shapes"])}
    here = items.get(item)
    if here is None:
        raise SweepError(f"parameter {name}: {playground} has no '{item}'{_near(item, items)}")
    _expect(name, value, bool(path), f"a name such as {_PLAYGROUND}{item}.x_m")
    for key in path[:-1]:
        here = here.get(key)
        if not isinstance(here, dict):
            raise SweepError(f"parameter {name}: {playground} has no '{key}' there, expected a field with fields")
    here[path[-1]] = value


def _constants(source: Source) -> dict[str, int]:
    try:
        return dict(parse(source.text).constants)
    except AeslError as error:
        raise SweepError(str(error)) from error


def _assigned(source: Source, robots: tuple[str, ...], words: Words) -> dict[str, Assignment]:
    known = _constants(source)
    constants = {name: word for name, word in words if name in known}
    try:
        return assignments_of(source.text, source.name, robots, constants=constants)
    except ProgramError as error:
        raise SweepError(str(error)) from error


@lru_cache(maxsize=64)
def _programs(source: Source, robots: tuple[str, ...], words: Words) -> tuple[dict[str, ThymioProgram], Words]:
    """The programs by robot, and the variables to set; the other parameters are constants."""
    assigned, known = _assigned(source, robots, words), _constants(source)
    programs = {robot: found.program for robot, found in assigned.items() if found.program is not None}
    variables = tuple((name, word) for name, word in words if name not in known)
    for name, _ in variables:
        _check_variable(name, source.name, programs, known)
    return programs, variables


def _check_variable(name: str, source: str, programs: Mapping[str, ThymioProgram], constants: Collection[str]) -> None:
    sizes: dict[str, int] = {}
    for program in programs.values():
        sizes |= {known: size for known, (_, size) in program.program.addresses.items()}
    if name not in sizes:
        near = _near(name, {*constants, *sizes, *MODELS})
        raise SweepError(f"parameter {name}: {source} has no constant or variable of this name{near}")
    if sizes[name] != 1:
        raise SweepError(f"parameter {name}: {source} has an array of {sizes[name]} words, expected a single word")


def _near(name: str, known: Collection[str]) -> str:
    found = difflib.get_close_matches(name, sorted(known), 1)
    return f"; did you mean '{found[0]}'?" if found else ""
