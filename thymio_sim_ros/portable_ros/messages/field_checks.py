"""The checks of values that are assigned to a field, with the sentences of the classes that rosidl generates.

They run for messages made with `check_fields=True`, and for all where ROS_PYTHON_CHECK_FIELDS is 1.
"""

from __future__ import annotations

import array
import math
from collections import UserList, UserString
from collections.abc import Callable, Sequence, Set
from typing import Any

import numpy as np

from thymio_sim_ros.portable_ros.messages.definitions import Field, FieldType, Shape
from thymio_sim_ros.portable_ros.messages.primitives import FLOATS, PRIMITIVES, Primitive

__all__ = ["Check", "check_of"]

Check = Callable[[Any], bool]
"""Raises AssertionError for a value that a field cannot have; returns whether the class keeps it without a copy."""


def check_of(field: Field, class_of: Callable[[str], type]) -> Check:
    """The check of a field; `class_of` returns the class of a message by its full name."""
    if field.type.shape is not Shape.SCALAR:
        return _check_of_many(field, class_of)
    if not field.type.is_primitive:
        return _check_of_message(field, class_of)
    primitive = PRIMITIVES[field.type.base]
    if primitive.python is bytes:
        return _check_of_octet(field.name)
    if field.type.text_bound:
        return _check_of_bounded_text(field.name, field.type.text_bound)
    return _check_of_primitive(field.name, primitive)


def _require(is_valid: bool, sentence: str) -> bool:
    if not is_valid:
        raise AssertionError(sentence)
    return True


def _check_of_message(field: Field, class_of: Callable[[str], type]) -> Check:
    sentence = f"The '{field.name}' field must be a sub message of type '{_short(field.type)}'"
    return lambda value: _require(isinstance(value, class_of(field.type.base)), sentence)


def _check_of_octet(name: str) -> Check:
    sentence = f"The '{name}' field must be of type 'bytes' or 'ByteString' with length 1"
    return lambda value: _require(isinstance(value, bytes | bytearray) and len(value) == 1, sentence)


def _check_of_bounded_text(name: str, bound: int) -> Check:
    sentence = f"The '{name}' field must be string value not longer than {bound}"
    return lambda value: _require(isinstance(value, str | UserString) and len(value) <= bound, sentence)


def _check_of_primitive(name: str, primitive: Primitive) -> Check:
    wrong_type = f"The '{name}' field must be of type '{primitive.python.__name__}'"
    wrong_value = f"The '{name}' field must be {_range(primitive)}"

    def check(value: Any) -> bool:
        _require(isinstance(value, primitive.python), wrong_type)
        return _require(_is_in_range(value, primitive), wrong_value)

    return check


def _is_in_range(value: Any, primitive: Primitive) -> bool:
    if primitive.limits is not None:
        return bool(primitive.limits[0] <= value <= primitive.limits[1])
    if primitive.idl in FLOATS:
        bound = FLOATS[primitive.idl]
        return not (value < -bound or value > bound) or math.isinf(value)
    return True


def _range(primitive: Primitive) -> str:
    if primitive.limits is not None:
        low, high = primitive.limits
        return f"an {'unsigned ' if low == 0 else ''}integer in [{low}, {high}]"
    bound = FLOATS.get(primitive.idl, 0.0)
    return f"a {primitive.idl} in [{-bound}, {bound}]"


def _check_of_many(field: Field, class_of: Callable[[str], type]) -> Check:
    """The check of an array or a sequence."""
    of, sentence = field.type, f"The '{field.name}' field must be {_expected(field.type)}"

    primitive = PRIMITIVES.get(of.base)
    is_array = primitive is not None and bool(primitive.code)

    def check(value: Any) -> bool:
        if _is_checked_array(field, value):
            return True
        is_listed = isinstance(value, Sequence | Set | UserList) and not isinstance(value, str | UserString)
        _require(is_listed and _fits(of, value, class_of), sentence)
        return not is_array

    return check


def _is_checked_array(field: Field, value: Any) -> bool:
    """Whether the value is an array of the kind that the field has; raises AssertionError for one of another type."""
    of = field.type
    primitive = PRIMITIVES.get(of.base)
    if primitive is None or not primitive.code:
        return False
    if of.shape is Shape.ARRAY and isinstance(value, np.ndarray):
        place = f"The '{field.name}' numpy.ndarray() must have"
        _require(value.dtype == np.dtype(primitive.dtype), f"{place} the dtype of 'numpy.{primitive.dtype}'")
        _require(value.size == of.size, f"{place} a size of {of.size}")
        return True
    if of.shape is Shape.SEQUENCE and isinstance(value, array.array):
        place = f"The '{field.name}' array.array() must have"
        _require(value.typecode == primitive.code, f"{place} the type code of '{primitive.code}'")
        _require(not of.size or len(value) <= of.size, f"{place} a size <= {of.size}")
        return True
    return False


def _fits(of: FieldType, values: Any, class_of: Callable[[str], type]) -> bool:
    if of.shape is Shape.ARRAY and len(values) != of.size:
        return False
    if of.shape is Shape.SEQUENCE and of.size and len(values) > of.size:
        return False
    if not of.is_primitive:
        kind = class_of(of.base)
        return all(isinstance(value, kind) for value in values)
    primitive = PRIMITIVES[of.base]
    return all(isinstance(value, primitive.python) and _is_in_range(value, primitive) for value in values) and not (
        of.text_bound and any(len(value) > of.text_bound for value in values)
    )


def _expected(of: FieldType) -> str:
    """What a field with several values expects."""
    words = ["a set or sequence"]
    if of.shape is Shape.ARRAY:
        words.append(f"with length {of.size}")
    elif of.size:
        words.append(f"with length <= {of.size}")
    if of.text_bound:
        words.append(f"and each string value not longer than {of.text_bound}")
    primitive = PRIMITIVES.get(of.base)
    words.append(f"and each value of type '{_short(of) if primitive is None else primitive.python.__name__}'")
    if primitive is not None and primitive.limits is not None:
        low, high = primitive.limits
        words.append(f"and each {'unsigned ' if low == 0 else ''}integer in [{low}, {high}]")
    elif primitive is not None and primitive.idl in FLOATS:
        bound = FLOATS[primitive.idl]
        words.append(f"and each {primitive.idl} in [{-bound:f}, {bound:f}]")
    return " ".join(words)


def _short(of: FieldType) -> str:
    return of.base.rpartition("/")[2]
