"""Lossless conversion of inputs and of the start of a run to members of a JSON object, and back."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from thymio_sim_ros.device.options import DeviceOptions
from thymio_sim_ros.device.programs.foreign import foreign_program
from thymio_sim_ros.device.programs.program import ThymioProgram, load_node, place_of
from thymio_sim_ros.engine import command_codec
from thymio_sim_ros.engine.inputs import (
    BreakpointsSet,
    Controlled,
    DeviceStart,
    EventSent,
    Input,
    Loaded,
    Posted,
    Removed,
    Reset,
    RunStart,
    Spawned,
    VariableSet,
)
from thymio_sim_ros.sim.model import fields
from thymio_sim_ros.sim.playground import reader as playgrounds
from thymio_sim_ros.sim.playground.reader import RobotStart
from thymio_sim_ros.sim.playground.writer import dumps
from thymio_sim_ros.sim.world import WorldOptions

__all__ = ["read_devices", "read_input", "read_start", "write_devices", "write_input", "write_start"]

_PLAIN = {kind.__name__: kind for kind in (BreakpointsSet, Controlled, EventSent, VariableSet)}
"""Inputs whose fields are numbers and texts."""


def write_input(happened: Input) -> dict[str, Any]:
    """Return the members of an input."""
    match happened:
        case Posted(name, command):
            kind, values = command_codec.encode(command)
            return {"to": name, "do": kind, "with": values}
        case Spawned(start):
            return {"spawn": fields.write(start)}
        case Removed(name):
            return {"remove": name}
        case Reset():
            return {"reset": True}
        case Loaded(robot, program):
            return {"load": robot, "program": _write_program(program)}
        case _:
            kind, values = command_codec.encode(happened)
            return {"input": kind, "with": values}


def read_input(data: Mapping[Any, Any]) -> Input | None:
    """Return the input with these members, None if there is none. Raises what `fields.read`, `decode`, compilers do."""
    match data:
        case {"to": str(name), "do": kind, "with": values}:
            return Posted(name, command_codec.decode(kind, values))
        case {"spawn": start}:
            return Spawned(fields.read(RobotStart, start, "spawn"))
        case {"remove": str(name)}:
            return Removed(name)
        case {"load": str(robot), "program": dict(program)}:
            return Loaded(robot, _read_program(program))
        case {"input": kind, "with": values}:
            read: Input = command_codec.decode(kind, values, _PLAIN)
            return read
    return None


def write_start(name: str, start: RunStart) -> dict[str, Any]:
    """Return the members of the start of a run; `name` is that of the playground."""
    options = start.options
    folders = {"card": options.card, "settings": options.settings}
    return {
        "name": name,
        "playground": dumps(start.playground),
        **asdict(start.world),
        **write_devices(start.devices),
        "layout": options.layout,
        "events": options.events,
        **{key: str(folder) for key, folder in folders.items() if folder is not None},
    }


def read_start(head: dict[str, Any]) -> tuple[str, RunStart]:
    """Return name and start of a run. Raises ValueError, KeyError, TypeError or what playgrounds and programs raise."""
    name, text, periods = head.pop("name"), head.pop("playground"), head.pop("periods_ns")
    if not isinstance(name, str) or not isinstance(text, str):
        raise ValueError("found a world whose name or playground is no text, expected both")
    pairs = None if periods is None else tuple((str(sensor), int(period_ns)) for sensor, period_ns in periods)
    devices = read_devices({"programs": head.pop("programs", ()), "devices": head.pop("devices", {})})
    options: dict[str, Any] = {key: head.pop(key) for key in ("layout", "events") if key in head}
    options |= {key: Path(head.pop(key)) for key in ("card", "settings") if key in head}
    playground = playgrounds.loads(text, name)
    return name, RunStart(playground, WorldOptions(**head, periods_ns=pairs), devices, DeviceOptions(**options))


def write_devices(devices: Mapping[str, DeviceStart]) -> dict[str, Any]:
    """Return the members of the starts of devices: each program once, and its place for each device."""
    programs = list(dict.fromkeys(start.program for start in devices.values() if start.program is not None))
    return {
        "programs": [_write_program(program) for program in programs],
        "devices": {
            name: {
                "number": start.number,
                "program": None if start.program is None else programs.index(start.program),
                "behaviour": start.behaviour,
            }
            for name, start in devices.items()
        },
    }


def read_devices(members: Mapping[str, Any]) -> dict[str, DeviceStart]:
    """Return the starts of devices. Raises as `read_start` does."""
    programs = [_read_program(program) for program in members["programs"]]
    return {
        str(name): DeviceStart(
            int(start["number"]),
            None if start["program"] is None else programs[start["program"]],
            str(start["behaviour"]),
        )
        for name, start in members["devices"].items()
    }


def _write_program(program: ThymioProgram) -> dict[str, Any]:
    """Return the file of a program, and which of its nodes it is; or its words, if it has no file."""
    members: dict[str, Any] = {"layout": program.layout}
    if program.is_foreign:
        return members | {"words": program.program.words, "events": program.events}
    return members | {
        "name": program.name,
        "text": program.text,
        "node": place_of(program),
        "constants": dict(program.constants),
    }


def _read_program(members: Mapping[str, Any]) -> ThymioProgram:
    layout = str(members["layout"])
    if "words" in members:
        events = [(str(name), int(size)) for name, size in members["events"]]
        return foreign_program([int(word) for word in members["words"]], layout, events)
    constants = {str(name): int(value) for name, value in members["constants"].items()}
    text, name = str(members["text"]), str(members["name"])
    return load_node(text, name, int(members["node"]), layout, constants=constants)
