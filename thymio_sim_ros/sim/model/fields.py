"""Types and limits of fields in playground files, and the reading of frozen dataclasses from such data.

A field is a dataclass field whose type is annotated with a rule (`Annotated[float, Number("m", …)]`).
Loader, published JSON schema and the forms of the page's creator (`field_declarations.py`) are derived from these
declarations. The unit is part of a key's name (`size_x_m`). Unknown keys, missing keys and values out of range are
refused.
"""

from __future__ import annotations

import dataclasses
import difflib
import functools
import itertools
import math
import re
import reprlib
import types
import typing
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, TypeVar, cast

from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.sim.model.primitives import Color

__all__ = [
    "OBJECT_FRICTION",
    "OBJECT_RESTITUTION",
    "Angle",
    "Area",
    "Coordinate",
    "Duration",
    "Extent",
    "FieldError",
    "Friction",
    "Image",
    "Mass",
    "Name",
    "PenWidth",
    "Points",
    "Restitution",
    "Shade",
    "Text",
    "as_color",
    "hinted_rule",
    "image_keys",
    "json_schema",
    "nearest",
    "read",
    "write",
]

T = TypeVar("T")

FAR_M = 100.0
"""No coordinate lies farther from the origin."""
OBJECT_FRICTION = 0.25
"""Between a movable thing and the floor (docs/spec/thymio-robot.md section 11)."""
OBJECT_RESTITUTION = 0.1
"""Between a movable thing and a robot: the middle of 0…0.2 (docs/spec/thymio-robot.md section 11)."""


_LONGEST_PART = 2000
"""Characters of each part of an error, which may repeat a key or a tag of any length."""


def _clipped(text: str) -> str:
    return text if len(text) <= _LONGEST_PART else f"{text[: _LONGEST_PART - 3]}..."


class FieldError(ThymioSimError):
    """A value that a field refuses: the key's path, what was found, what was expected.

    `word` names the rule in the texts of the page (`fault.<word>`), if it is one between fields of a shape.
    """

    def __init__(self, key: str, found: str, expected: str, word: str = "") -> None:
        key, found, expected = (_clipped(part) for part in (key, found, expected))
        super().__init__(f"{key}: found {found}, expected {expected}")
        self.key = key
        self.found = found
        self.expected = expected
        self.word = word


@dataclass(frozen=True, slots=True)
class Number:
    """A finite number of a unit, `low` to `high` inclusive."""

    unit: str
    low: float
    high: float


@dataclass(frozen=True, slots=True)
class Pattern:
    """Text that matches a regular expression; `meaning` says so in words."""

    expression: str
    meaning: str
    longest: int


@dataclass(frozen=True, slots=True)
class File:
    """A file beside the playground, or its content as a data URI; the loader turns the one into the other."""

    meaning: str
    longest: int


@dataclass(frozen=True, slots=True)
class Path:
    """A list of [x, y] in meters."""

    fewest: int
    most: int


Coordinate = Annotated[float, Number("m", -FAR_M, FAR_M)]
Extent = Annotated[float, Number("m", 0.001, FAR_M)]
PenWidth = Annotated[float, Number("m", 0.001, 0.1)]
LANGUAGE = "[a-z]{2,3}(-[A-Za-z0-9]{2,8})*"
"""The form of a language code: `de`, `pt-BR`."""

Angle = Annotated[float, Number("rad", -2 * math.pi, 2 * math.pi)]
Radius = Annotated[float, Number("m", 0.0, FAR_M)]
Mass = Annotated[float, Number("kg", 0.001, 1000.0)]
Friction = Annotated[float, Number("parts of the weight", 0.0, 2.0)]
Restitution = Annotated[float, Number("parts of the speed", 0.0, 1.0)]
Duration = Annotated[float, Number("s", 0.01, 3600.0)]
Text = Annotated[str, Pattern(r"[^\x00-\x1f\x7f\ud800-\udfff]*", "one line of text", 2000)]
Name = Annotated[
    str, Pattern(r"[A-Za-z](_?[A-Za-z0-9])*", "a ROS name: letters, digits, single underscores, a letter first", 60)
]
Shade = Annotated[str, Pattern(r"#[0-9A-Fa-f]{6}", "a color such as #1a2b3c", 7)]
Points = Annotated[tuple[tuple[float, float], ...], Path(2, 1000)]
Area = Annotated[tuple[tuple[float, float], ...], Path(3, 1000)]
Image = Annotated[str, File("a PNG, JPEG or SVG beside this file, or a data URI of one", 6_000_000)]

_COORDINATE = Number("m", -FAR_M, FAR_M)


def as_color(shade: str) -> Color:
    """'#rrggbb' as red, green, blue from 0 to 1."""
    return (int(shade[1:3], 16) / 255, int(shade[3:5], 16) / 255, int(shade[5:7], 16) / 255)


def read(kind: type[T], data: object, key: str) -> T:
    """A `kind` from the members of a JSON object; FieldError with the path of the key that is wrong."""
    if not isinstance(data, Mapping):
        raise FieldError(key, describe(data), "an object")
    rules = _rules(cast("Any", kind))
    for name in data:
        if name not in rules:
            raise FieldError(join(key, str(name)), "an unknown key", nearest(str(name), tuple(rules)))
    values = {}
    for name, rule in rules.items():
        if name in data:
            values[name] = _value(rule, data[name], join(key, name))
        elif rule.required:
            raise FieldError(join(key, name), "nothing", rule.expected)
    return kind(**values)


def write(value: Any) -> dict[str, Any]:
    """The members of a dataclass as JSON has them, without those at their default; `read` gives the same again."""
    found = {}
    for member in dataclasses.fields(value):
        content = getattr(value, member.name)
        if content != member.default:
            found[member.name] = write(content) if dataclasses.is_dataclass(content) else _plain(content)
    return found


def json_schema(kind: type[Any], *, extra: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """The JSON schema of `read(kind, …)`; `extra` members are added and required."""
    rules = _rules(cast("Any", kind))
    properties = dict(extra or {}) | {name: rule.schema for name, rule in rules.items()}
    required = [*(extra or {}), *(name for name, rule in rules.items() if rule.required)]
    schema: dict[str, Any] = {"type": "object", "properties": properties, "additionalProperties": False}
    return schema | ({"required": required} if required else {})


def image_keys(kind: type[Any]) -> tuple[str, ...]:
    """The fields that hold an `Image`."""
    return tuple(name for name, rule in _rules(cast("Any", kind)).items() if isinstance(rule.kind[0], File))


def nearest(word: str, words: Sequence[str]) -> str:
    """The expected words in place of an unknown one: the nearest first, then all of them."""
    near = difflib.get_close_matches(word[:_DESCRIBED], words, 1)
    listed = "one of " + ", ".join(words)
    return f"'{near[0]}' ({listed})" if near else listed


def join(key: str, name: str) -> str:
    """The path of a member below a key."""
    return f"{key}.{name}" if key else name


_DESCRIBED = 60


class _Repr(reprlib.Repr):
    """Like `reprlib.Repr`, but members stay in the file's order."""

    def repr_dict(self, value: dict[Any, Any], level: int) -> str:
        if level <= 0 and value:
            return "{...}"
        shown = [
            f"{self.repr1(key, level - 1)}: {self.repr1(item, level - 1)}"
            for key, item in itertools.islice(value.items(), self.maxdict)
        ]
        return "{" + ", ".join([*shown, *["..."] * (len(value) > self.maxdict)]) + "}"


_REPR = _Repr()
_REPR.maxlevel, _REPR.maxlong, _REPR.maxstring, _REPR.maxother = 8, _DESCRIBED, 2 * _DESCRIBED, 2 * _DESCRIBED
_REPR.maxlist = _REPR.maxdict = _DESCRIBED
"""Neither the size nor the depth of a value matters to how long it takes to describe."""


def describe(value: object) -> str:
    """A value of a file in a few words."""
    text = repr(value[:_DESCRIBED]) if isinstance(value, str) else _REPR.repr(value)
    return text if len(text) <= _DESCRIBED else f"{text[: _DESCRIBED - 3]}..."


@dataclass(frozen=True, slots=True)
class _Rule:
    kind: tuple[Any, bool]
    required: bool
    expected: str
    schema: dict[str, Any]


@functools.cache
def _rules(kind: Any) -> dict[str, _Rule]:
    hints = typing.get_type_hints(kind, include_extras=True)
    found = {}
    for field in dataclasses.fields(kind):
        hint = hints[field.name]
        default = field.default
        required = default is dataclasses.MISSING
        rule, optional = hinted_rule(hint)
        schema = _schema(rule)
        if not required and isinstance(default, str | int | float):
            schema = schema | {"default": default}
        if optional:
            schema = {"anyOf": [schema, {"type": "null"}]}
        found[field.name] = _Rule((rule, optional), required, _expected(rule), schema)
    return found


def hinted_rule(hint: Any) -> tuple[Any, bool]:
    """(the rule, bool or dataclass of a type hint, whether null is allowed)."""
    if isinstance(hint, types.UnionType) or typing.get_origin(hint) is typing.Union:
        members = [member for member in typing.get_args(hint) if member is not type(None)]
        return hinted_rule(members[0])[0], True
    if typing.get_origin(hint) is Annotated:
        return typing.get_args(hint)[1], False
    return hint, False


def _value(rule: _Rule, value: object, key: str) -> object:
    kind, optional = rule.kind
    if value is None and optional:
        return None
    match kind:
        case Number():
            return _number(kind, value, key)
        case Pattern():
            if not isinstance(value, str) or len(value) > kind.longest or not re.fullmatch(kind.expression, value):
                raise FieldError(key, describe(value), rule.expected)
            return value
        case File(_, longest):
            if not isinstance(value, str) or len(value) > longest or not value.startswith("data:"):
                raise FieldError(key, describe(value), rule.expected)
            return value
        case Path():
            if not isinstance(value, Sequence) or isinstance(value, str) or not kind.fewest <= len(value) <= kind.most:
                raise FieldError(key, describe(value), rule.expected)
            return tuple(_point(point, f"{key}[{index}]") for index, point in enumerate(value))
    if kind is bool:
        if not isinstance(value, bool):
            raise FieldError(key, describe(value), rule.expected)
        return value
    return read(kind, value, key)


def _plain(value: object) -> object:
    return [_plain(part) for part in value] if isinstance(value, tuple) else value


def _number(rule: Number, value: object, key: str) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not rule.low <= value <= rule.high:
        raise FieldError(key, describe(value), _expected(rule))
    return float(value)


def _point(value: object, key: str) -> tuple[float, float]:
    if not isinstance(value, Sequence) or isinstance(value, str) or len(value) != 2:
        raise FieldError(key, describe(value), "[x, y] in m")
    return (_number(_COORDINATE, value[0], f"{key}[0]"), _number(_COORDINATE, value[1], f"{key}[1]"))


def _expected(rule: Any) -> str:
    match rule:
        case Number(unit, low, high):
            return f"a number of {unit} from {low:.6g} to {high:.6g}"
        case Pattern(_, meaning, longest):
            return f"{meaning}, at most {longest} characters"
        case File(meaning, _):
            return meaning
        case Path(fewest, most):
            return f"{fewest} to {most} points [x, y] in m"
    return "true or false" if rule is bool else "an object"


def _schema(rule: Any) -> dict[str, Any]:
    match rule:
        case Number(unit, low, high):
            return {"type": "number", "minimum": low, "maximum": high, "description": unit}
        case Pattern(expression, meaning, longest):
            return {"type": "string", "pattern": f"^({expression})$", "maxLength": longest, "description": meaning}
        case File(meaning, longest):
            return {"type": "string", "minLength": 5, "maxLength": longest, "description": meaning}
        case Path(fewest, most):
            item = {"type": "array", "items": _schema(_COORDINATE), "minItems": 2, "maxItems": 2}
            return {"type": "array", "items": item, "minItems": fewest, "maxItems": most, "description": "x, y in m"}
    if rule is bool:
        return {"type": "boolean"}
    if not dataclasses.is_dataclass(rule):
        raise TypeError(
            f"a field of type {rule!r} found, expected bool or a rule of sim/model/fields.py such as Coordinate"
        )
    return json_schema(cast("Any", rule))
