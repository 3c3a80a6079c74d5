"""Parameters: names with typed values, and their messages."""

from __future__ import annotations

import array
from collections.abc import Sequence
from enum import Enum
from pathlib import Path
from typing import Any, TypeAlias

import yaml

from thymio_sim_ros.portable_ros import ros_types
from thymio_sim_ros.portable_ros.ros_types import ParameterMessage, ParameterType, ParameterValue

__all__ = ["Parameter", "get_parameter_value", "parameter_dict_from_yaml_file", "parameter_value_to_python"]

PARAMETER_SEPARATOR_STRING = "."

_FIELDS = {
    ParameterType.PARAMETER_BOOL: "bool_value",
    ParameterType.PARAMETER_INTEGER: "integer_value",
    ParameterType.PARAMETER_DOUBLE: "double_value",
    ParameterType.PARAMETER_STRING: "string_value",
    ParameterType.PARAMETER_BYTE_ARRAY: "byte_array_value",
    ParameterType.PARAMETER_BOOL_ARRAY: "bool_array_value",
    ParameterType.PARAMETER_INTEGER_ARRAY: "integer_array_value",
    ParameterType.PARAMETER_DOUBLE_ARRAY: "double_array_value",
    ParameterType.PARAMETER_STRING_ARRAY: "string_array_value",
}
"""The field of a message that has the value of a type."""

_FIRST_ARRAY = ParameterType.PARAMETER_BYTE_ARRAY


class Type(Enum):
    """Types of parameters."""

    NOT_SET = ParameterType.PARAMETER_NOT_SET
    BOOL = ParameterType.PARAMETER_BOOL
    INTEGER = ParameterType.PARAMETER_INTEGER
    DOUBLE = ParameterType.PARAMETER_DOUBLE
    STRING = ParameterType.PARAMETER_STRING
    BYTE_ARRAY = ParameterType.PARAMETER_BYTE_ARRAY
    BOOL_ARRAY = ParameterType.PARAMETER_BOOL_ARRAY
    INTEGER_ARRAY = ParameterType.PARAMETER_INTEGER_ARRAY
    DOUBLE_ARRAY = ParameterType.PARAMETER_DOUBLE_ARRAY
    STRING_ARRAY = ParameterType.PARAMETER_STRING_ARRAY

    @classmethod
    def from_parameter_value(cls, parameter_value: Any) -> Type:
        """The type of a value. Raises TypeError if it has none of them."""
        if parameter_value is None:
            return Type.NOT_SET
        for kind, python in _SCALARS.items():
            if isinstance(parameter_value, python):
                return kind
        if not isinstance(parameter_value, list | tuple | array.array):
            raise TypeError(f"The given value is not one of the allowed types '{parameter_value}'.")
        for kind, python in _ARRAYS.items():
            if all(isinstance(one, python) for one in parameter_value):
                return kind
        raise TypeError(f"The given value is not a list of one of the allowed types '{parameter_value}'.")

    def check(self, parameter_value: Any) -> bool:
        """Whether a value has the type."""
        if self is Type.NOT_SET:
            return parameter_value is None
        if self in _SCALARS:
            return isinstance(parameter_value, _SCALARS[self])
        sequences = (list, tuple, array.array) if self in (Type.INTEGER_ARRAY, Type.DOUBLE_ARRAY) else (list, tuple)
        if not isinstance(parameter_value, sequences):
            return False
        is_byte = self is Type.BYTE_ARRAY
        kind = _ARRAYS[self]
        return all(isinstance(one, kind) for one in parameter_value) and not (
            is_byte and any(len(one) != 1 for one in parameter_value)
        )


_SCALARS: dict[Type, type] = {Type.BOOL: bool, Type.INTEGER: int, Type.DOUBLE: float, Type.STRING: str}
_ARRAYS: dict[Type, type] = {
    Type.BYTE_ARRAY: bytes,
    Type.BOOL_ARRAY: bool,
    Type.INTEGER_ARRAY: int,
    Type.DOUBLE_ARRAY: float,
    Type.STRING_ARRAY: str,
}


ParameterKind: TypeAlias = Type
"""The type `Parameter.Type` where that name is taken."""


class Parameter:
    """A parameter. Raises TypeError or ValueError for a value that has no type, or another one than `type_`."""

    Type: TypeAlias = Type

    def __init__(self, name: str, type_: ParameterKind | None = None, value: Any = None) -> None:
        if type_ is None:
            type_ = Type.from_parameter_value(value)
        if not isinstance(type_, Type):
            raise TypeError(f"type must be an instance of '{Type!r}'")
        if not type_.check(value):
            raise ValueError(f"Type '{type_}' and value '{value}' do not agree")
        self._name, self._type_, self._value = name, type_, value

    @classmethod
    def from_parameter_msg(cls, param_msg: ParameterMessage) -> Parameter:
        """The parameter of a message."""
        kind = Type(param_msg.value.type)
        value = None if kind is Type.NOT_SET else getattr(param_msg.value, _FIELDS[kind.value])
        return cls(param_msg.name, kind, value)

    @property
    def name(self) -> str:
        """The name."""
        return self._name

    @property
    def type_(self) -> ParameterKind:
        """The type."""
        return self._type_

    @property
    def value(self) -> Any:
        """The value, None without one."""
        return self._value

    def get_parameter_value(self) -> ParameterValue:
        """The message of the value."""
        message = ParameterValue(type=self._type_.value)
        if self._type_ is not Type.NOT_SET:
            setattr(message, _FIELDS[self._type_.value], self._value)
        return message

    def to_parameter_msg(self) -> ParameterMessage:
        """The message of the parameter."""
        return ParameterMessage(name=self._name, value=self.get_parameter_value())


def get_parameter_value(string_value: str) -> ParameterValue:
    """The message of a value that is written as YAML."""
    try:
        value = yaml.safe_load(string_value)
    except yaml.parser.ParserError:
        value = string_value
    kind = _yaml_type(value)
    found = string_value if value is None or (kind is Type.STRING and isinstance(value, list)) else value
    message = ParameterValue(type=kind.value)
    setattr(message, _FIELDS[kind.value], found)
    return message


def _yaml_type(value: Any) -> Type:
    """The type of the parameter for a value of YAML, STRING for all that is none of the others."""
    if not isinstance(value, list):
        return next((kind for kind, python in _SCALARS.items() if isinstance(value, python)), Type.STRING)
    kinds = (kind for kind in _ARRAYS if kind is not Type.BYTE_ARRAY)
    return next((kind for kind in kinds if all(isinstance(one, _ARRAYS[kind]) for one in value)), Type.STRING)


def parameter_value_to_python(parameter_value: ParameterValue) -> Any:
    """The value of a message, None without one. Raises RuntimeError for an unknown type."""
    kind = parameter_value.type
    if kind == ParameterType.PARAMETER_NOT_SET:
        return None
    if kind not in _FIELDS:
        raise RuntimeError(f"unexpected parameter type {kind}")
    value = getattr(parameter_value, _FIELDS[kind])
    return list(value) if kind >= _FIRST_ARRAY else value


def parameter_dict_from_yaml_file(
    parameter_file: str,
    use_wildcard: bool = False,
    target_nodes: Sequence[str] | None = None,
    namespace: str = "",
) -> dict[str, Any]:
    """The messages of all parameters of a file by their names, those of `target_nodes` only if there are any.

    Raises RuntimeError if the file has no such parameters.
    """
    content = yaml.safe_load(Path(parameter_file).read_text(encoding="utf-8"))
    keys = ["/**"] if use_wildcard and "/**" in content else []
    for name in target_nodes or ():
        if name not in content:
            raise RuntimeError(
                f"Param file does not contain parameters for {name},only for nodes: {list(content.keys())} "
            )
    keys += list(target_nodes) if target_nodes else [name for name in content if name != "/**"]
    if not keys:
        raise RuntimeError("Param file does not contain selected parameters")
    merged: dict[str, Any] = {}
    for name in keys:
        if not isinstance(content[name], dict) or "ros__parameters" not in content[name]:
            raise RuntimeError(f"YAML file is not a valid ROS parameter file for node {name}")
        merged.update(content[name]["ros__parameters"])
    return _flat(namespace, merged)


def _flat(prefix: str, values: dict[str, Any]) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for name, value in values.items():
        if isinstance(value, dict):
            found.update(_flat(f"{prefix}{name}{PARAMETER_SEPARATOR_STRING}", value))
        else:
            message = ros_types.ParameterMessage(name=f"{prefix}{name}", value=get_parameter_value(str(value)))
            found[message.name] = message
    return found
