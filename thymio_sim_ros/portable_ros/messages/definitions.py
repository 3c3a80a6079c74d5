"""The definitions of messages and services, read from the files of `definitions/`, one for each package.

A file has the text of each `.msg` and `.srv` file of its package below a line such as `=== msg/Bool`.
"""

from __future__ import annotations

import ast
import functools
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from enum import Enum
from importlib import resources
from typing import Any

from thymio_sim_ros.portable_ros.messages.primitives import PRIMITIVES

__all__ = [
    "PACKAGES",
    "SERVICE_PARTS",
    "Constant",
    "Definition",
    "Field",
    "FieldType",
    "Shape",
    "definition",
    "interfaces",
    "is_service",
]

_FOLDER = resources.files(__package__).joinpath("definitions")
_SUFFIX = ".txt"
PACKAGES = frozenset(file.name.removesuffix(_SUFFIX) for file in _FOLDER.iterdir() if file.name.endswith(_SUFFIX))
"""The packages that have definitions."""

SERVICE_PARTS = ("Request", "Response", "Event")
"""The messages of a service, which are named by it: `std_srvs/srv/Empty_Request`."""

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
    """The text of the .msg file, empty for a message that is made for a service."""


@functools.cache
def interfaces(package: str) -> Mapping[str, str]:
    """The texts of a package by `msg/Name` or `srv/Name`."""
    content = _FOLDER.joinpath(f"{package}{_SUFFIX}").read_text(encoding="utf-8")
    _, *parts = re.split(r"^=== (.+)$", content, flags=re.MULTILINE)
    return {name: text.lstrip("\n") for name, text in zip(parts[::2], parts[1::2], strict=True)}


def is_service(name: str) -> bool:
    """Whether there is a service of this full name."""
    package, _, rest = name.partition("/")
    return rest.startswith("srv/") and package in PACKAGES and rest in interfaces(package)


@functools.cache
def definition(name: str) -> Definition:
    """The definition of a message by its full name. Raises KeyError if there is none."""
    package, form, short = name.split("/")
    if package not in PACKAGES:
        raise KeyError(name)
    if form == "msg":
        return _parsed(name, interfaces(package)[f"msg/{short}"])
    service, _, part = short.rpartition("_")
    if not is_service(f"{package}/srv/{service}") or part not in SERVICE_PARTS:
        raise KeyError(name)
    if part == "Event":
        return _event(f"{package}/srv/{service}")
    request, _, response = re.split(r"^(---)$", interfaces(package)[f"srv/{service}"], maxsplit=1, flags=re.MULTILINE)
    return _parsed(name, request if part == "Request" else response.lstrip("\n"))


def _event(service: str) -> Definition:
    parts = tuple(
        Field(part.lower(), FieldType(f"{service}_{part}", Shape.SEQUENCE, 1)) for part in ("Request", "Response")
    )
    return Definition(f"{service}_Event", (Field("info", FieldType("service_msgs/msg/ServiceEventInfo")), *parts))


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


def names(package: str, form: str) -> Iterator[str]:
    """The names of all messages or services of a package, in the order of its file."""
    for name in interfaces(package):
        kind, _, short = name.partition("/")
        if kind == form:
            yield short
