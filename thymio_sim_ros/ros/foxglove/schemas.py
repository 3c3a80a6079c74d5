"""Definition text of message and service types (ros2msg), from installed files or from the classes themselves.

The text is the definition of the type, followed by each type that it uses, directly or indirectly, once, after a line
of 80 `=` and a line `MSG: pkg/Type`.
The ROS wheels do not set AMENT_PREFIX_PATH; therefore the interpreter's prefix is searched too (docs/spec/foxglove.md
section 5).
"""

from __future__ import annotations

import os
import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from thymio_sim_ros.portable_ros.import_hook import is_served
from thymio_sim_ros.portable_ros.messages.interface_files import text_of
from thymio_sim_ros.ros.compat.tf2_messages import TF_DEFINITION, TF_TYPE_NAME
from thymio_sim_ros.ros.foxglove.types import load_type

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.messages.message_class import Message

__all__ = ["SEPARATOR", "definitions", "message_definition", "service_definitions", "share_folders"]

SEPARATOR = "=" * 80
"""The line between a definition and those of the types that it uses."""
_PARTS = {"msg": (), "srv": ("Request", "Response"), "action": ("Goal", "Result", "Feedback")}
_BETWEEN = re.compile(r"^---[^\n]*\n?", re.MULTILINE)
_INTEGERS = frozenset(f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64))
_PRIMITIVES = _INTEGERS | {"bool", "byte", "char", "float32", "float64", "string", "wstring"}
_FIELD = re.compile(r"^([A-Za-z][\w/]*)(?:<=\d+)?(?:\[(?:<=)?\d*\])?\s+[A-Za-z]\w*")
_PYTHON_TO_ROS = {"boolean": "bool", "octet": "byte", "float": "float32", "double": "float64"}
_BOUNDED_SEQUENCE = re.compile(r"^sequence<(.+), (\d+)>$")
_SEQUENCE = re.compile(r"^sequence<(.+)>$")
_ARRAY = re.compile(r"^(.+)\[(\d+)\]$")
_BOUNDED_STRING = re.compile(r"^(w?string)<(\d+)>$")


def share_folders() -> list[Path]:
    """Folders with the shared files of packages, in the order in which they are searched."""
    prefixes = [prefix for prefix in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if prefix]
    return [Path(prefix) / "share" for prefix in (*prefixes, sys.prefix)]


def message_definition(type_name: str) -> str:
    """The complete definition of `pkg/msg/Type`. Raises MissingTypeError."""
    return _complete(type_name, _message_text(type_name))


def service_definitions(type_name: str) -> tuple[str, str]:
    """The complete definitions of request and response of `pkg/srv/Type`. Raises MissingTypeError."""
    request, response = definitions(type_name)
    return request, response


def definitions(type_name: str) -> list[str]:
    """The complete definitions of a message, of request and response, or of goal, result and feedback.

    Raises MissingTypeError.
    """
    parts = _PARTS[type_name.split("/")[1]]
    if not parts:
        return [message_definition(type_name)]
    text = _file_text(type_name)
    if text is not None:
        texts = _BETWEEN.split(text, maxsplit=len(parts) - 1)
    else:
        interface = load_type(type_name)
        texts = [_class_text(getattr(interface, part)) for part in parts]
    return [_complete(type_name, part) for part in texts]


def _complete(root: str, text: str) -> str:
    parts = [text]
    seen = {root}
    waiting = _needed(root, text)
    while waiting:
        name = waiting.pop(0)
        if name in seen:
            continue
        seen.add(name)
        part = _message_text(name)
        package, _, short = name.split("/")
        parts += [SEPARATOR, f"MSG: {package}/{short}", part]
        waiting += _needed(name, part)
    return "\n".join(parts)


def _needed(owner: str, text: str) -> list[str]:
    """Full names of the message types of the fields in `text`, in order of appearance."""
    package = owner.split("/")[0]
    names = []
    for line in text.splitlines():
        match = _FIELD.match(line.strip())
        if match is None or match[1] in _PRIMITIVES:
            continue
        words = match[1].split("/")
        names.append(f"{words[0] if len(words) > 1 else package}/msg/{words[-1]}")
    return names


def _message_text(type_name: str) -> str:
    text = _file_text(type_name)
    if text is not None:
        return text
    if type_name == TF_TYPE_NAME:
        return TF_DEFINITION
    return _class_text(load_type(type_name))


def _file_text(type_name: str) -> str | None:
    package, kind, short = type_name.split("/")
    for share in share_folders():
        try:
            return (share / package / kind / f"{short}.{kind}").read_text(encoding="utf-8")
        except OSError:
            continue
    return _embedded_text(type_name) if is_served("rclpy") else None


def _embedded_text(type_name: str) -> str | None:
    """The definition that the embedded graph has."""
    try:
        return text_of(type_name)
    except KeyError:
        return None


def _class_text(message: type[Message]) -> str:
    """The definition of a message class; constants and defaults are missing, as the class does not have them."""
    return "".join(f"{_ros_type(kind)} {name}\n" for name, kind in message.get_fields_and_field_types().items())


def _ros_type(kind: str) -> str:
    if match := _BOUNDED_SEQUENCE.match(kind):
        return f"{_ros_type(match[1])}[<={match[2]}]"
    if match := _SEQUENCE.match(kind):
        return f"{_ros_type(match[1])}[]"
    if match := _ARRAY.match(kind):
        return f"{_ros_type(match[1])}[{match[2]}]"
    if match := _BOUNDED_STRING.match(kind):
        return f"{match[1]}<={match[2]}"
    return _PYTHON_TO_ROS.get(kind, kind)
