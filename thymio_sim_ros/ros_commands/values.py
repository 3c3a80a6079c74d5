"""Messages as YAML, as ros2cli prints and reads it."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import yaml
from rclpy.node import Node

from thymio_sim_ros.ros.foxglove import json_messages
from thymio_sim_ros.ros_commands.errors import CommandError

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.messages.message_class import MsgT

__all__ = ["LONGEST", "from_yaml", "part_of", "to_yaml"]

LONGEST = 128
"""Elements of lists and characters of texts that are printed."""
_REST = "..."
_SCALARS = (bool, int, float, str)


def to_yaml(value: Any, *, longest: int | None = LONGEST, lists: bool = True) -> str:
    """A message, or a value of a field, as lines of YAML."""
    plain = _plain(value, longest, lists=lists)
    if isinstance(plain, _SCALARS):
        return f"{plain}\n"
    text: str = yaml.safe_dump(plain, sort_keys=False, allow_unicode=True, width=sys.maxsize)
    return text


def part_of(message: Any, path: str) -> Any:
    """A part of a message by the names of fields. Raises CommandError."""
    value, before = message, ""
    for name in filter(None, path.split(".")):
        fields = _fields(value)
        if name not in fields:
            place, expected = before or "message", f"one of {', '.join(fields)}" if fields else "no further field"
            raise CommandError(f"--field {path}: {place}: found {name}, expected {expected}")
        value, before = getattr(value, name), f"{before}.{name}".lstrip(".")
    return value


def from_yaml(text: str, message_type: type[MsgT], node: Node) -> MsgT:
    """A message with the fields of a text; `auto` as a header and `now` as a time are that of the node.

    Raises CommandError, with the field.
    """
    try:
        value = yaml.safe_load(text)
    except yaml.YAMLError as error:
        problem, mark = getattr(error, "problem", error), getattr(error, "problem_mark", None)
        place = f" at column {mark.column + 1}" if mark is not None else ""
        raise CommandError(f"values{place}: {problem} in {text!r:.60}; expected YAML") from error
    try:
        stamped = _with_time(value if value is not None else {}, message_type(), node)
        return json_messages.from_value(stamped, message_type, "values")
    except json_messages.JsonMessageError as error:
        raise CommandError(str(error).replace("expected an object", "expected fields such as {name: value}")) from error


def _fields(value: Any) -> Mapping[str, str]:
    return value.get_fields_and_field_types() if hasattr(value, "get_fields_and_field_types") else {}


def _with_time(value: Any, message: Any, node: Node) -> Any:
    """Fields with times in place of `auto` and `now`."""
    kind = type(message).__name__
    if value == "auto" and kind == "Header":
        return {"stamp": _with_time("now", message.stamp, node)}
    if value == "now" and kind == "Time":
        now = node.get_clock().now().to_msg()
        return {"sec": now.sec, "nanosec": now.nanosec}
    if not isinstance(value, dict):
        return value
    return {
        name: _with_time(one, getattr(message, name), node) if name in _fields(message) else one
        for name, one in value.items()
    }


def _plain(value: Any, longest: int | None, *, lists: bool) -> Any:
    if fields := _fields(value):
        return {name: _plain(getattr(value, name), longest, lists=lists) for name in fields}
    if isinstance(value, str):
        return value if longest is None or len(value) <= longest else value[:longest] + _REST
    if isinstance(value, _SCALARS):
        return value
    if isinstance(value, bytes):
        return value[0] if len(value) == 1 else list(value)
    if hasattr(value, "get_fields_and_field_types"):
        return {}
    if not lists:
        return f"<array type, {len(value)} elements>"
    few = value if longest is None else value[:longest]
    items = few.tolist() if hasattr(few, "tolist") else [_plain(one, longest, lists=lists) for one in few]
    return items if longest is None or len(value) <= longest else [*items, _REST]
