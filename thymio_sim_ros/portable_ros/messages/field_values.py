"""The values of fields: defaults, what a class keeps of an assigned value, and the conversions from and to CDR."""

from __future__ import annotations

import array
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from thymio_sim_ros.portable_ros.messages.definitions import Field, Shape
from thymio_sim_ros.portable_ros.messages.primitives import PRIMITIVES, Primitive

__all__ = ["FieldValues", "WideText", "values_of"]

Convert = Callable[[Any], Any]


@dataclass(frozen=True, slots=True)
class WideText:
    """A text of UTF-16 as Fast CDR has it: each unit in four bytes, without a zero at the end."""

    units: Any

    @classmethod
    def of(cls, text: str) -> WideText:
        """The units of a text. Raises UnicodeEncodeError for a text that UTF-16 does not have."""
        return cls(np.frombuffer(text.encode("utf-16-le"), np.uint16).astype(np.uint32))

    def __str__(self) -> str:
        return str(self.units.astype(np.uint16).tobytes(), "utf-16-le")


@dataclass(frozen=True, slots=True)
class FieldValues:
    """How the values of a field are made and converted; None for a conversion that changes nothing.

    Args:
        default: Makes the value of a new message.
        kept: Copies an assigned value to what the class keeps.
        given: Converts a value that the constructor gets, before it is assigned.
        to_wire: Converts to what rosbags serializes.
        from_wire: Converts what rosbags deserialized.
    """

    default: Callable[[], Any]
    kept: Convert | None = None
    given: Convert | None = None
    to_wire: Convert | None = None
    from_wire: Convert | None = None


def values_of(field: Field, class_of: Callable[[str], type]) -> FieldValues:
    """The values of a field; `class_of` returns the class of a message by its full name."""
    of = field.type
    primitive = PRIMITIVES.get(of.base)
    if of.shape is Shape.SCALAR:
        if primitive is None:
            return FieldValues(lambda: class_of(of.base)())
        default = primitive.default if field.default is None else field.default
        if primitive.python is bytes:
            return FieldValues(lambda: default, to_wire=lambda value: value[0], from_wire=lambda value: bytes((value,)))
        if of.base == "wstring":
            return FieldValues(lambda: default, to_wire=WideText.of, from_wire=str)
        return FieldValues(lambda: default)
    count = of.size if of.shape is Shape.ARRAY else 0
    if primitive is None:
        return FieldValues(lambda: [class_of(of.base)() for _ in range(count)])
    values = (primitive.default,) * count if field.default is None else tuple(field.default)
    if primitive.code:
        return _of_numbers(primitive, values, is_array=of.shape is Shape.ARRAY)
    if primitive.python in (bool, bytes):
        return _of_flags(primitive, values)
    if of.base == "wstring":
        return FieldValues(
            lambda: list(values),
            to_wire=lambda texts: list(map(WideText.of, texts)),
            from_wire=lambda texts: list(map(str, texts)),
        )
    return FieldValues(lambda: list(values))


def _of_numbers(primitive: Primitive, default: tuple[Any, ...], *, is_array: bool) -> FieldValues:
    """The values of an array or a sequence of numbers."""
    code, dtype = primitive.code, np.dtype(primitive.dtype)
    if is_array:
        return FieldValues(
            lambda: np.array(default, dtype),
            kept=lambda value: np.array(value, dtype),
            to_wire=lambda value: np.ascontiguousarray(value, dtype),
            from_wire=lambda value: value.copy(),
        )

    def to_array(value: Any) -> array.array[Any]:
        return array.array(code, value)

    def from_wire(value: Any) -> array.array[Any]:
        return array.array(code, value.tobytes())

    return FieldValues(
        lambda: array.array(code, default),
        kept=to_array,
        given=to_array,
        to_wire=lambda value: np.asarray(value, dtype),
        from_wire=from_wire,
    )


def _of_flags(primitive: Primitive, default: tuple[Any, ...]) -> FieldValues:
    """The values of several booleans or octets, which are lists."""
    if primitive.python is bool:
        return FieldValues(
            lambda: list(default),
            to_wire=lambda value: np.asarray(value, np.bool_),
            from_wire=lambda value: value.tolist(),
        )
    return FieldValues(
        lambda: list(default),
        to_wire=lambda value: np.frombuffer(b"".join(value), np.uint8) if len(value) else np.empty(0, np.uint8),
        from_wire=lambda value: [bytes((one,)) for one in value.tolist()],
    )
