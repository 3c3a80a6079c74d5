"""Lossless conversion of commands, including those of plug-ins, to JSON and back by the types of their fields."""

from __future__ import annotations

import base64
import binascii
import dataclasses
import types
import typing
from collections.abc import Mapping
from typing import Any

from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.sim.actuators import all_actuators
from thymio_sim_ros.sim.commands import MoveObject
from thymio_sim_ros.sim.stimuli import all_stimuli

__all__ = ["CommandJsonError", "decode", "encode", "kinds"]


class CommandJsonError(ThymioSimError, ValueError):
    """A command that cannot be decoded; the text has what was found and what was expected."""


def kinds() -> dict[str, type[Any]]:
    """Types of all commands that a world accepts, by name."""
    taken = [kind for plugin in (*all_actuators(), *all_stimuli()) for kind in plugin.accepts]
    return {kind.__name__: kind for kind in (*taken, MoveObject)}


def encode(command: Any) -> tuple[str, dict[str, Any]]:
    """Return the name of the type of a command or another dataclass, and its fields; bytes become base64."""
    members = dataclasses.fields(command)
    return type(command).__name__, {member.name: _write(getattr(command, member.name)) for member in members}


def decode(name: object, values: object, known: Mapping[str, type[Any]] | None = None) -> Any:
    """Return the command with this type and these fields, as from `encode`. Raises CommandJsonError.

    `known`: types by name in place of commands.
    """
    known = kinds() if known is None else known
    if not isinstance(name, str) or name not in known:
        raise CommandJsonError(f"found the command {name!r}, expected one of {', '.join(sorted(known))}")
    kind = known[name]
    if not isinstance(values, Mapping):
        raise CommandJsonError(f"{name}: found {values!r}, expected an object")
    hints = typing.get_type_hints(kind)
    members = [member.name for member in dataclasses.fields(kind)]
    if sorted(values) != sorted(members):
        raise CommandJsonError(f"{name}: found {', '.join(values) or 'nothing'}, expected {', '.join(members)}")
    try:
        command = kind(**{member: _read(hints[member], values[member]) for member in members})
    except (ValueError, OverflowError) as error:
        raise CommandJsonError(f"{name}: {error}") from error
    return command


def _write(value: object) -> object:
    if isinstance(value, bytes):
        return base64.b64encode(value).decode("ascii")
    return [_write(item) for item in value] if isinstance(value, tuple) else value


def _read(hint: Any, value: object) -> Any:
    """A value of a type; ValueError."""
    if isinstance(hint, types.UnionType):
        if value is None and type(None) in typing.get_args(hint):
            return None
        (hint,) = (member for member in typing.get_args(hint) if member is not type(None))
    if typing.get_origin(hint) is tuple and isinstance(value, list):
        items = typing.get_args(hint)
        wanted = [items[0]] * len(value) if items[-1] is Ellipsis else list(items)
        if len(wanted) == len(value):
            return tuple(_read(item, part) for item, part in zip(wanted, value, strict=True))
    elif hint is bytes and isinstance(value, str):
        try:
            return base64.b64decode(value, validate=True)
        except binascii.Error:
            pass
    elif hint is float and isinstance(value, int | float) and not isinstance(value, bool):
        return float(value)
    elif hint in (int, bool, str) and type(value) is hint:
        return value
    raise ValueError(f"found {value!r}, expected {getattr(hint, '__name__', hint)}")
