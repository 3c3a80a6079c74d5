"""Topics of the actuators and stimuli of plug-ins: one per type of command, its numbers in one labeled array.

A command that is not declared in `sim/commands/` is a std_msgs/Float64MultiArray on `actuator/<actuator>`, or on
`actuator/<actuator>/<command>` if the actuator accepts several; for stimuli the topic begins with `stimulus/`. Aseba
programs publish on it, and any node can.
"""

from __future__ import annotations

import dataclasses
import re
import typing
from collections.abc import Callable
from typing import Any

from std_msgs.msg import Float64MultiArray

from thymio_sim_ros.ros.interface import command_checks, convert_readings
from thymio_sim_ros.ros.interface.command_checks import CommandError
from thymio_sim_ros.ros.interface.command_row import CommandRow
from thymio_sim_ros.sim import commands
from thymio_sim_ros.sim.actuators import all_actuators
from thymio_sim_ros.sim.plugin_api.command_plugin import CommandPlugin
from thymio_sim_ros.sim.stimuli import Stimulus, all_stimuli

__all__ = ["rows", "topic_of"]

_NUMBERS: dict[object, Callable[[float], object]] = {
    int: round,
    float: float,
    bool: bool,
}


def rows() -> tuple[CommandRow, ...]:
    """Return one row for each command of a plug-in; commands with fields that are not numbers have no topic."""
    return tuple(
        CommandRow(topic, Float64MultiArray, _decoder(kind), _encode, about=_about(kind))
        for plugin in (*all_actuators(), *all_stimuli())
        for kind, topic in _topics(plugin).items()
    )


def topic_of(command: object) -> str | None:
    """Return the topic of a command of a plug-in; None for any other command."""
    found = (_topics(plugin).get(type(command)) for plugin in (*all_actuators(), *all_stimuli()))
    return next((topic for topic in found if topic is not None), None)


def _topics(plugin: CommandPlugin) -> dict[type[Any], str]:
    prefix = "stimulus" if isinstance(plugin, Stimulus) else "actuator"
    own = [kind for kind in plugin.accepts if issubclass(kind, commands.PluginCommand) and _has_only_numbers(kind)]
    if len(own) == 1:
        return {own[0]: f"{prefix}/{plugin.name}"}
    return {kind: f"{prefix}/{plugin.name}/{_word(kind.__name__)}" for kind in own}


def _has_only_numbers(kind: type[Any]) -> bool:
    if not dataclasses.is_dataclass(kind):
        return False
    hints = typing.get_type_hints(kind)
    return all(hints[field.name] in _NUMBERS for field in dataclasses.fields(kind))


def _about(kind: type[Any]) -> str:
    return ", ".join(field.name for field in dataclasses.fields(kind)) or "no values"


def _word(name: str) -> str:
    """Return a class name as a topic word: BigJump becomes big_jump."""
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower()


def _encode(command: Any) -> Float64MultiArray:
    names = [field.name for field in dataclasses.fields(command)]
    data = [float(getattr(command, name)) for name in names]
    return Float64MultiArray(layout=convert_readings.layout([(name, 1) for name in names]), data=data)


def _decoder(kind: type[Any]) -> Callable[[Float64MultiArray], commands.PluginCommand]:
    hints = typing.get_type_hints(kind)
    names = [field.name for field in dataclasses.fields(kind)]

    def decode(message: Float64MultiArray) -> commands.PluginCommand:
        values = command_checks.sized(message.data, len(names), f"[{', '.join(names)}]")
        for name, value in zip(names, values, strict=True):
            command_checks.finite(value, name)
        try:
            command: commands.PluginCommand = kind(
                *(_NUMBERS[hints[name]](value) for name, value in zip(names, values, strict=True))
            )
        except ValueError as error:
            raise CommandError(str(error)) from error
        return command

    return decode
