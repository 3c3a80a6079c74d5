"""Conversion of parameter values between the bridge and ROS (docs/spec/foxglove.md section 2)."""

from __future__ import annotations

import base64
import math
from typing import Any

from rcl_interfaces.msg import ParameterType, ParameterValue
from rclpy.parameter import Parameter as RosParameter
from rclpy.parameter import parameter_value_to_python

from thymio_sim_ros.bridge.protocol.messages import Parameter
from thymio_sim_ros.errors import ThymioSimError

__all__ = ["UnfitValueError", "from_ros", "to_ros"]

_SCALARS = {
    bool: ParameterType.PARAMETER_BOOL,
    int: ParameterType.PARAMETER_INTEGER,
    float: ParameterType.PARAMETER_DOUBLE,
    str: ParameterType.PARAMETER_STRING,
}
_ARRAYS = {
    bool: ParameterType.PARAMETER_BOOL_ARRAY,
    int: ParameterType.PARAMETER_INTEGER_ARRAY,
    float: ParameterType.PARAMETER_DOUBLE_ARRAY,
    str: ParameterType.PARAMETER_STRING_ARRAY,
}
_HINTS = {
    "float64": ParameterType.PARAMETER_DOUBLE,
    "float64_array": ParameterType.PARAMETER_DOUBLE_ARRAY,
    "byte_array": ParameterType.PARAMETER_BYTE_ARRAY,
}
_TYPES = {code: hint for hint, code in _HINTS.items()}


class UnfitValueError(ThymioSimError, ValueError):
    """A value does not fit a ROS parameter; the text says why."""


def from_ros(name: str, value: ParameterValue) -> Parameter:
    """Convert a ROS value; NaN and infinity, which JSON does not have, become text. An unknown type is no value."""
    try:
        found = parameter_value_to_python(value)
    except RuntimeError:
        found = None
    if found is None:
        return Parameter(name)
    if value.type == ParameterType.PARAMETER_BYTE_ARRAY:
        return Parameter(name, base64.b64encode(b"".join(found)).decode(), "byte_array")
    if value.type == ParameterType.PARAMETER_DOUBLE:
        return Parameter(name, found, "float64") if math.isfinite(found) else Parameter(name, str(found))
    if isinstance(found, (bool, int, str)):
        return Parameter(name, found)
    items = tuple(found)
    if value.type == ParameterType.PARAMETER_DOUBLE_ARRAY and not all(map(math.isfinite, items)):
        return Parameter(name, tuple(str(item) for item in items))
    return Parameter(name, items, _TYPES.get(value.type))


def to_ros(parameter: Parameter, current: int = ParameterType.PARAMETER_NOT_SET) -> ParameterValue:
    """Convert a value to ROS. Raises UnfitValueError.

    `current` is the current type code: an integer then sets a parameter that is a double.
    """
    value = parameter.value
    if value is None:
        return ParameterValue()
    code = _HINTS.get(parameter.type or "") or _kind(value, current)
    if code == ParameterType.PARAMETER_BYTE_ARRAY:
        return _message(code, _bytes(value))
    if code == ParameterType.PARAMETER_DOUBLE:
        value = _float(value)
    elif code == ParameterType.PARAMETER_DOUBLE_ARRAY:
        value = tuple(_float(item) for item in (value if isinstance(value, tuple) else (value,)))
    for item in value if isinstance(value, tuple) else (value,):
        _check(item)
    return _message(code, value)


def _message(code: int, value: Any) -> ParameterValue:
    fitting = list(value) if isinstance(value, tuple) else value
    return RosParameter("", RosParameter.Type(code), fitting).get_parameter_value()


def _kind(value: Any, current: int) -> int:
    if not isinstance(value, tuple):
        code = _SCALARS[type(value)]
        is_double = current == ParameterType.PARAMETER_DOUBLE and type(value) is int
        return ParameterType.PARAMETER_DOUBLE if is_double else code
    kinds = {type(item) for item in value}
    if not kinds:
        return current if current in _ARRAYS.values() else ParameterType.PARAMETER_STRING_ARRAY
    if kinds == {int, float} or (kinds == {int} and current == ParameterType.PARAMETER_DOUBLE_ARRAY):
        return ParameterType.PARAMETER_DOUBLE_ARRAY
    if len(kinds) > 1:
        raise UnfitValueError("expected a list with elements of one type, found several types")
    return _ARRAYS[kinds.pop()]


def _check(value: Any) -> None:
    """Raise UnfitValueError for values that the setters of rosidl accept but the middleware cannot serialize."""
    if isinstance(value, int) and not -(1 << 63) <= value < 1 << 63:
        raise UnfitValueError(f"expected an integer of 64 bits, found {value!r:.40}")
    if isinstance(value, str) and not value.isascii():
        try:
            value.encode()
        except UnicodeEncodeError as error:
            raise UnfitValueError(f"expected Unicode text, found {value!r:.40}") from error


def _float(value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise UnfitValueError(f"expected a number, found {value!r:.40}")
    try:
        return float(value)
    except OverflowError as error:
        raise UnfitValueError(f"expected a number, found {value!r:.40}") from error


def _bytes(value: Any) -> list[bytes]:
    try:
        data = base64.b64decode(value, validate=True)
    except (TypeError, ValueError) as error:
        raise UnfitValueError(f"expected base64 text, found {value!r:.40}") from error
    return [data[index : index + 1] for index in range(len(data))]
