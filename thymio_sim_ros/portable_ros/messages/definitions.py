"""The definitions of messages: their fields and constants, as their texts have them or as rosidl adds them."""

from __future__ import annotations

import ast
import functools
import re
from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from typing import Any

from thymio_sim_ros.portable_ros.messages.interface_files import (
    ACTION_PARTS,
    ACTION_SERVICES,
    FEEDBACK_MESSAGE,
    SERVICE_PARTS,
    is_action,
    is_service,
    sections,
    snake_case,
    text_of,
)
from thymio_sim_ros.portable_ros.messages.primitives import PRIMITIVES

__all__ = ["Constant", "Definition", "Field", "FieldType", "Shape", "definition", "structure"]

_TYPE = re.compile(
    r"(?P<base>[A-Za-z][\w/]*)(?:<=(?P<text_bound>\d+))?(?P<array>\[(?:(?P<bounded><=)?(?P<size>\d+))?\])?"
)
_CONSTANT = re.compile(r"(?P<type>\S+)\s+(?P<name>[A-Z][A-Z0-9_]*)\s*=\s*(?P<value>.*)")


class Shape(Enum):
    """How many values a field has."""

    SCALAR = "scalar"
    ARRAY = "array"
    SEQUENCE = "sequence"


@dataclass(frozen=True, slots=True)
class FieldType:
    """The type of a field: a primitive or the full name of a message.

    `size` is the length of an array or the limit of a sequence, `text_bound` that of a text; 0 stands for no limit.
    """

    base: str
    shape: Shape = Shape.SCALAR
    size: int = 0
    text_bound: int = 0

    @property
    def is_primitive(self) -> bool:
        """Whether the values are numbers, booleans, octets or texts."""
        return self.base in PRIMITIVES


@dataclass(frozen=True, slots=True)
class Field:
    """A field; `default` is the value in the definition, None without one."""

    name: str
    type: FieldType
    default: Any = None


@dataclass(frozen=True, slots=True)
class Constant:
    """A constant of a message."""

    name: str
    base: str
    value: Any


@dataclass(frozen=True, slots=True)
class Definition:
    """A message; `name` is full, such as `std_msgs/msg/Bool`."""

    name: str
    fields: tuple[Field, ...]
    constants: tuple[Constant, ...] = ()
    text: str = ""
    """The text, empty for a message that rosidl adds to a service or an action."""


@functools.cache
def definition(name: str) -> Definition:
    """The definition of a message by its full name. Raises KeyError if there is none."""
    if name.split("/")[1:2] == ["msg"]:
        return _parsed(name, text_of(name))
    owner, _, part = name.rpartition("_")
    if part in sections(owner):
        return _parsed(name, sections(owner)[part])
    if part == "Event" and is_service(owner):
        event = (Field(one.lower(), FieldType(f"{owner}_{one}", Shape.SEQUENCE, 1)) for one in SERVICE_PARTS[:2])
        return Definition(name, (Field("info", FieldType("service_msgs/msg/ServiceEventInfo")), *event))
    for added, fields in _ADDED.items():
        action = name.removesuffix(f"_{added}")
        if action != name and is_action(action):
            return _composed(name, {field: base.format(action=action) for field, base in fields.items()})
    raise KeyError(name)


_GOAL_ID = {"goal_id": "unique_identifier_msgs/msg/UUID"}
_ADDED = {
    "SendGoal_Request": {**_GOAL_ID, "goal": "{action}_Goal"},
    "SendGoal_Response": {"accepted": "bool", "stamp": "builtin_interfaces/msg/Time"},
    "GetResult_Request": _GOAL_ID,
    "GetResult_Response": {"status": "int8", "result": "{action}_Result"},
    FEEDBACK_MESSAGE: {**_GOAL_ID, "feedback": "{action}_Feedback"},
}
"""The messages that rosidl adds to an action: the types of their fields by their names."""


def structure(name: str) -> Definition:
    """What stands for an interface in descriptions and hashes of types: a service or an action has its parts as fields.

    Raises KeyError if there is no such interface.
    """
    if is_service(name):
        return _composed(name, {f"{part.lower()}_message": f"{name}_{part}" for part in SERVICE_PARTS})
    if is_action(name):
        services = {f"{snake_case(one)}_service": f"{name}_{one}" for one in ACTION_SERVICES}
        parts = {part.lower(): f"{name}_{part}" for part in ACTION_PARTS}
        return _composed(name, {**parts, **services, snake_case(FEEDBACK_MESSAGE): f"{name}_{FEEDBACK_MESSAGE}"})
    return definition(name)


def _composed(name: str, fields: Mapping[str, str]) -> Definition:
    return Definition(name, tuple(Field(field, FieldType(base)) for field, base in fields.items()))


def _parsed(name: str, text: str) -> Definition:
    package = name.partition("/")[0]
    fields, constants = [], []
    for line in filter(None, map(str.strip, text.splitlines())):
        if found := _CONSTANT.fullmatch(line):
            base = found["type"]
            constants.append(Constant(found["name"], base, _value(base, found["value"])))
        else:
            fields.append(_field(package, line))
    return Definition(name, tuple(fields), tuple(constants), text)


def _field(package: str, line: str) -> Field:
    kind, name, *default = line.split(maxsplit=2)
    found = _TYPE.fullmatch(kind)
    if found is None:
        raise ValueError(f"{package}: found {line!r}, expected a field")
    base = found["base"]
    shape = Shape.SCALAR
    if found["array"]:
        shape = Shape.ARRAY if found["size"] and not found["bounded"] else Shape.SEQUENCE
    of = FieldType(_full(package, base), shape, int(found["size"] or 0), int(found["text_bound"] or 0))
    if not default:
        return Field(name, of)
    return Field(name, of, _value(base, default[0]) if shape is Shape.SCALAR else _values(base, default[0]))


def _full(package: str, base: str) -> str:
    """The full name of a type of a field, as it is written in a definition of the package."""
    if base in PRIMITIVES:
        return base
    owner, _, name = base.rpartition("/")
    if base == "Header":
        owner = "std_msgs"
    return f"{owner or package}/msg/{name}"


def _values(base: str, text: str) -> tuple[Any, ...]:
    """The default of an array or a sequence, such as `[1, 2]`."""
    return tuple(_value(base, one) for one in re.findall(r"\"[^\"]*\"|'[^']*'|[^\[\],\s]+", text))


def _value(base: str, text: str) -> Any:
    """A constant or a default, as the value that the Python class has."""
    if base in ("string", "wstring"):
        return ast.literal_eval(text) if text[:1] in ("'", '"') else text
    if base == "bool":
        return text.lower() in ("true", "1")
    value = ast.literal_eval(text)
    if base == "byte":
        return bytes([value])
    return float(value) if base.startswith("float") else value
