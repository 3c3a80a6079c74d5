"""Lossless conversion of inputs and of the start of a run to members of a JSON object, and back."""

from __future__ import annotations

import base64
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from aseba_vm.protocol import FrameReader, decode, encode
from thymio_sim_ros.device.options import DeviceOptions
from thymio_sim_ros.device.programs.foreign import foreign_program
from thymio_sim_ros.device.programs.program import ThymioProgram, load_node, place_of
from thymio_sim_ros.engine import command_codec
from thymio_sim_ros.engine.inputs import (
    BreakpointsSet,
    ClientConnected,
    ClientDisconnected,
    Controlled,
    DevicesAdded,
    DeviceStart,
    DrawingsErased,
    EventSent,
    GroundPainted,
    Input,
    Loaded,
    MessagesReceived,
    Posted,
    Remembered,
    Removed,
    Reset,
    RunStart,
    Spawned,
    VariableSet,
)
from thymio_sim_ros.sim.model import fields
from thymio_sim_ros.sim.model.lidar import Lidar
from thymio_sim_ros.sim.playground import reader as playgrounds
from thymio_sim_ros.sim.playground.reader import RobotStart
from thymio_sim_ros.sim.playground.writer import dumps
from thymio_sim_ros.sim.world import WorldOptions

__all__ = ["pop_devices", "read_input", "read_start", "write_devices", "write_input", "write_start"]

_PLAIN = {
    kind.__name__: kind
    for kind in (
        BreakpointsSet,
        ClientConnected,
        ClientDisconnected,
        Controlled,
        DrawingsErased,
        EventSent,
        GroundPainted,
        VariableSet,
    )
}
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
        case Loaded(robot, program, behaviour):
            return {"load": robot, "program": program and _write_program(program), "behaviour": behaviour}
        case Remembered(robot, program):
            return {"remember": robot, "program": _write_program(program)}
        case DevicesAdded():
            return {"add": write_devices(happened)}
        case MessagesReceived(robot, client, messages):
            frames = b"".join(map(encode, messages))
            return {"receive": robot, "client": client, "messages": base64.b64encode(frames).decode("ascii")}
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
        case {"load": str(robot), "program": program, "behaviour": str(behaviour)}:
            return Loaded(robot, None if program is None else _read_program(program), behaviour)
        case {"remember": str(robot), "program": dict(program)}:
            return Remembered(robot, _read_program(program))
        case {"add": dict(members)}:
            return pop_devices(dict(members))
        case {"receive": str(robot), "client": int(client), "messages": str(text)}:
            frames = FrameReader().feed(base64.b64decode(text, validate=True))
            return MessagesReceived(robot, client, tuple(map(decode, frames)))
        case {"input": kind, "with": values}:
            read: Input = command_codec.decode(kind, values, _PLAIN)
            return read
    return None


def write_start(name: str, start: RunStart) -> dict[str, Any]:
    """Return the members of the start of a run; `name` is that of the playground."""
    return {
        "name": name,
        "playground": dumps(start.playground),
        **asdict(start.world),
        **write_devices(DevicesAdded(start.devices, start.options, start.shares_numbers)),
    }


def read_start(head: dict[str, Any]) -> tuple[str, RunStart]:
    """Return name and start of a run. Raises ValueError, KeyError, TypeError or what playgrounds and programs raise."""
    name, text, periods = head.pop("name"), head.pop("playground"), head.pop("periods_ns")
    if not isinstance(name, str) or not isinstance(text, str):
        raise ValueError("found a world whose name or playground is no text, expected both")
    pairs = None if periods is None else tuple((str(sensor), int(period_ns)) for sensor, period_ns in periods)
    added = pop_devices(head)
    lidar = head.pop("lidar", None)  # logs of earlier versions have none
    world = WorldOptions(**head, periods_ns=pairs, lidar=None if lidar is None else Lidar(**lidar))
    start = RunStart(playgrounds.loads(text, name), world, added.devices, added.options, added.shares_numbers)
    return name, start


def write_devices(added: DevicesAdded) -> dict[str, Any]:
    """Return the members of the starts of devices: each program once, and its place for each device; their options."""
    devices, options = added.devices, added.options
    programs = list(dict.fromkeys(start.program for start in devices.values() if start.program is not None))
    folders = {"card": options.card, "settings": options.settings}
    return {
        "programs": [_write_program(program) for program in programs],
        "devices": {
            name: {
                "number": start.number,
                "program": None if start.program is None else programs.index(start.program),
                "behaviour": start.behaviour,
                "breakpoints": list(start.breakpoints),
            }
            for name, start in devices.items()
        },
        "layout": options.layout,
        "events": options.events,
        "shares_numbers": added.shares_numbers,
        **{key: str(folder) for key, folder in folders.items() if folder is not None},
    }


def pop_devices(members: dict[str, Any]) -> DevicesAdded:
    """Remove the members of the starts of devices, and return these. Raises as `read_start` does."""
    programs = [_read_program(program) for program in members.pop("programs", ())]
    options: dict[str, Any] = {key: members.pop(key) for key in ("layout", "events") if key in members}
    options |= {key: Path(members.pop(key)) for key in ("card", "settings") if key in members}
    starts = {
        str(name): DeviceStart(
            int(start["number"]),
            None if start["program"] is None else programs[start["program"]],
            str(start["behaviour"]),
            tuple(int(line) for line in start.get("breakpoints", ())),
        )
        for name, start in members.pop("devices", {}).items()
    }
    return DevicesAdded(starts, DeviceOptions(**options), bool(members.pop("shares_numbers", False)))


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
