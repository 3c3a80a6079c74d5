"""Conversion of frozen dataclasses and JSON objects, derived from the annotations of the fields.

`reader(cls)` and `writer(cls)` are built once per class from its fields, so that a message is described in one place
only. Keys are camelCase, unknown keys are ignored (newer peers may send more), None is left out.
"""

from __future__ import annotations

import dataclasses
import functools
import types
import typing
from collections.abc import Callable, Mapping
from enum import IntEnum
from typing import Any, get_args, get_origin, get_type_hints

from thymio_sim_ros.bridge.protocol.constants import MAX_ID
from thymio_sim_ros.bridge.protocol.errors import FrameError
from thymio_sim_ros.bridge.protocol.messages import ParameterValue

Reader = Callable[[Any, str], Any]
Writer = Callable[[Any], Any]

_LONGEST_EXCERPT = 40


def describe(value: object) -> str:
    """Text of a value for an error message, at most `_LONGEST_EXCERPT` characters and an ellipsis."""
    if isinstance(value, (str, bytes)):
        value = value[: _LONGEST_EXCERPT + 1]
    try:
        text = repr(value)
    except RecursionError:
        text = "a deeply nested value"
    return text if len(text) <= _LONGEST_EXCERPT else f"{text[:_LONGEST_EXCERPT]}…"


def camel_case(name: str) -> str:
    """The JSON key of a field."""
    first, *rest = name.split("_")
    return first + "".join(word.capitalize() for word in rest)


def reader(shape: Any) -> Reader:
    """A function that converts a JSON value to the annotation `shape`.

    Its arguments are the value and its place for error messages. It raises FrameError for a value that does not fit.
    """
    return _reader(shape)


def writer(shape: Any) -> Writer:
    """A function that converts a value of the annotation `shape` to a JSON value."""
    return _writer(shape)


@functools.cache
def _reader(shape: Any) -> Reader:
    if shape == ParameterValue:
        return _read_parameter_value
    if shape is str:
        return _read_text
    if shape is int:
        return _read_id
    if isinstance(shape, type) and issubclass(shape, IntEnum):
        return functools.partial(_read_enum, shape)
    if get_origin(shape) is tuple:
        return functools.partial(_read_list, reader(get_args(shape)[0]))
    if get_origin(shape) in (types.UnionType, typing.Union):
        return reader(next(option for option in get_args(shape) if option is not types.NoneType))
    if get_origin(shape) is Mapping:
        return _read_texts
    assert dataclasses.is_dataclass(shape), shape
    return _record_reader(shape)


@functools.cache
def _writer(shape: Any) -> Writer:
    if get_origin(shape) is tuple and dataclasses.is_dataclass(get_args(shape)[0]):
        write_item = writer(get_args(shape)[0])
        return lambda items: [write_item(item) for item in items]
    if get_origin(shape) is None and dataclasses.is_dataclass(shape):
        return _record_writer(shape)
    return dict if get_origin(shape) is Mapping else lambda value: value


def _fields(shape: Any) -> list[tuple[str, str, Any, bool]]:
    """(field, key, annotation, required) of a message class."""
    hints = get_type_hints(shape)
    return [
        (
            item.name,
            camel_case(item.name),
            hints[item.name],
            item.default is dataclasses.MISSING and item.default_factory is dataclasses.MISSING,
        )
        for item in dataclasses.fields(shape)
    ]


def _record_reader(shape: Any) -> Reader:
    fields = [(name, key, reader(hint), required) for name, key, hint, required in _fields(shape)]

    def read(value: Any, where: str) -> Any:
        if not isinstance(value, dict):
            raise FrameError(where, "an object", describe(value))
        values = {}
        for name, key, read_field, required in fields:
            item = value.get(key)
            if item is not None:
                values[name] = read_field(item, f"{where}.{key}")
            elif required:
                raise FrameError(where, f"a key {key}", "none" if key not in value else "null")
        return shape(**values)

    return read


def _record_writer(shape: Any) -> Writer:
    fields = [(name, key, writer(hint)) for name, key, hint, _ in _fields(shape)]

    def write(record: Any) -> dict[str, Any]:
        values = ((key, write_field, getattr(record, name)) for name, key, write_field in fields)
        return {key: write_field(value) for key, write_field, value in values if value is not None}

    return write


def _read_text(value: Any, where: str) -> str:
    if not isinstance(value, str):
        raise FrameError(where, "a string", describe(value))
    return value


def _read_id(value: Any, where: str) -> int:
    if not isinstance(value, int) or isinstance(value, bool) or not 0 <= value <= MAX_ID:
        raise FrameError(where, f"an integer 0…{MAX_ID}", describe(value))
    return value


def _read_enum(kind: type[IntEnum], value: Any, where: str) -> IntEnum:
    if not isinstance(value, int) or isinstance(value, bool) or value not in tuple(kind):
        raise FrameError(where, f"one of {', '.join(str(int(item)) for item in kind)}", describe(value))
    return kind(value)


def _read_list(read_item: Reader, value: Any, where: str) -> tuple[Any, ...]:
    if not isinstance(value, list):
        raise FrameError(where, "a list", describe(value))
    return _each(read_item, value, where)


def _each(read_item: Reader, items: list[Any], where: str) -> tuple[Any, ...]:
    try:
        return tuple(read_item(item, where) for item in items)
    except FrameError:  # read again to name the item: building all names would take longer than reading
        return tuple(read_item(item, f"{where}[{index}]") for index, item in enumerate(items))


def _read_texts(value: Any, where: str) -> dict[str, str]:
    if not isinstance(value, dict):
        raise FrameError(where, "an object", describe(value))
    return {key: _read_text(item, f"{where}.{key}") for key, item in value.items()}


def _read_parameter_value(value: Any, where: str) -> ParameterValue:
    if isinstance(value, list):
        return _each(_read_scalar, value, where)
    return _read_scalar(value, where)


def _read_scalar(value: Any, where: str) -> bool | int | float | str:
    if not isinstance(value, (bool, int, float, str)):
        raise FrameError(where, "a number, a string, true or false", describe(value))
    return value
