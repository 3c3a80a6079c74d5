"""Commands as JSON: every kind there and back, and precise refusals."""

from __future__ import annotations

import json
import types
import typing
from dataclasses import fields
from typing import Any

import pytest

from thymio_sim_ros.engine import command_codec
from thymio_sim_ros.engine.command_codec import CommandJsonError
from thymio_sim_ros.sim.commands import (
    BodyTwist,
    Command,
    MotorTargets,
    PlaySamples,
    PluginCommand,
    RemoteKey,
    SetLeds,
    SetMotorModel,
    SetPen,
)

EXAMPLES: tuple[Command, ...] = (
    MotorTargets(-500, 32767),
    BodyTwist(0.1 + 0.2, -1e-300, 500_000_000),
    SetLeds("circle", (0, 32, 1)),
    PlaySamples(bytes(range(256))),
    SetPen(down=True, color=(0.1, 0.2, 1 / 3)),
    SetPen(),
    RemoteKey(3, 4, toggle=False),
    SetMotorModel("firmware"),
)


@pytest.mark.parametrize("command", EXAMPLES, ids=lambda command: type(command).__name__)
def test_a_command_comes_back_as_it_was(command: Command) -> None:
    name, values = json.loads(json.dumps(command_codec.encode(command)))
    assert command_codec.decode(name, values) == command


def test_every_command_of_the_world_can_be_written() -> None:
    kinds = {kind.__name__ for kind in typing.get_args(Command)} - {PluginCommand.__name__}
    assert set(command_codec.kinds()) == kinds


@pytest.mark.parametrize("name", command_codec.kinds())
def test_every_field_of_every_command_has_a_type_that_can_be_read(name: str) -> None:
    hints = typing.get_type_hints(command_codec.kinds()[name])
    for member in fields(command_codec.kinds()[name]):
        hint = hints[member.name]
        parts = set(typing.get_args(hint)) if isinstance(hint, types.UnionType) else {hint}
        assert all(
            typing.get_origin(part) is tuple or part in (int, float, bool, str, bytes, type(None)) for part in parts
        )


@pytest.mark.parametrize(
    ("name", "values", "text"),
    [
        ("Fly", {}, "found the command 'Fly', expected one of BodyTwist, Clap"),
        (None, {}, "found the command None"),
        ("MotorTargets", [1, 2], r"MotorTargets: found \[1, 2\], expected an object"),
        ("MotorTargets", {"left": 1}, "MotorTargets: found left, expected left, right"),
        ("MotorTargets", {"left": 1, "right": 2, "up": 3}, "found left, right, up, expected left, right"),
        ("MotorTargets", {"left": 1, "right": 2.5}, "MotorTargets: found 2.5, expected int"),
        ("MotorTargets", {"left": 1, "right": True}, "MotorTargets: found True, expected int"),
        ("PressButton", {"button": "center", "pressed": 1}, "PressButton: found 1, expected bool"),
        ("SetLeds", {"group": "top", "levels": [1, "2"]}, "SetLeds: found '2', expected int"),
        ("PlaySamples", {"samples": "?"}, r"PlaySamples: found '\?', expected bytes"),
        ("SetPen", {"down": None, "color": [1, 0], "width_m": None, "erase": None}, r"SetPen: found \[1, 0\]"),
        ("SetTemperature", {"celsius": 1e9}, "SetTemperature: .*1000000000"),
    ],
)
def test_what_is_no_command_is_refused(name: Any, values: Any, text: str) -> None:
    with pytest.raises(CommandJsonError, match=text):
        command_codec.decode(name, values)
