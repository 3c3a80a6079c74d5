"""Samples of the messages of test_msgs."""

from __future__ import annotations

from typing import Any

from thymio_sim_ros.portable_ros.messages.definitions import FieldType, Shape, definition
from thymio_sim_ros.portable_ros.messages.interface_files import interfaces
from thymio_sim_ros.portable_ros.messages.message_class import message_type
from thymio_sim_ros.portable_ros.messages.primitives import PRIMITIVES

__all__ = ["get_test_msg"]

_PACKAGE = "test_msgs"
_TEXT = "Hellö wörld! ハロー"
_FLOATS = (-2.125, 1.125)
"""Numbers that 32 bits hold exactly."""
_LONG = 3
"""Values of a sequence of any length."""


def get_test_msg(message_name: str) -> list[Any]:
    """A new message with its defaults, one with the smallest values and one with the largest.

    Raises NotImplementedError for a name that is not one of the package's messages.
    """
    if f"msg/{message_name}" not in interfaces(_PACKAGE):
        raise NotImplementedError
    name = f"{_PACKAGE}/msg/{message_name}"
    return [message_type(name)(), _sample(name, is_large=False), _sample(name, is_large=True)]


def _sample(name: str, *, is_large: bool) -> Any:
    values = {field.name: _values(field.type, is_large=is_large) for field in definition(name).fields}
    return message_type(name)(**values)


def _values(of: FieldType, *, is_large: bool) -> Any:
    if of.shape is Shape.SCALAR:
        return _value(of, is_large=is_large)
    count = of.size if of.shape is Shape.ARRAY else (of.size or _LONG) * is_large
    return [_value(of, is_large=is_large) for _ in range(count)]


def _value(of: FieldType, *, is_large: bool) -> Any:
    if not of.is_primitive:
        return _sample(of.base, is_large=is_large)
    primitive = PRIMITIVES[of.base]
    if primitive.limits is not None:
        return primitive.limits[is_large]
    if primitive.python is float:
        return _FLOATS[is_large]
    if primitive.python is bytes:
        return b"\xff" if is_large else b"\0"
    if primitive.python is bool:
        return is_large
    return _TEXT[: of.text_bound or None] if is_large else ""
