"""Reads the tuples that declare parameters."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import Any

from thymio_sim_ros.portable_ros import ros_types
from thymio_sim_ros.portable_ros.rclpy.parameter import PARAMETER_SEPARATOR_STRING, Parameter
from thymio_sim_ros.portable_ros.rclpy.validate_parameter_name import validate_parameter_name

__all__ = ["declared"]


def declared(
    namespace: str, item: tuple[Any, ...], index: int, overrides: Mapping[str, Parameter]
) -> tuple[Parameter, ros_types.ParameterDescriptor]:
    """The parameter and the descriptor that a tuple declares.

    Args:
        namespace: What the name begins with, may be empty.
        item: Name, value or type, and descriptor; all but the name may be missing.
        index: The index of the tuple, for errors.
        overrides: The values of the start.

    Raises TypeError and ValueError for a wrong tuple.
    """
    if not 1 <= len(item) <= 3:
        raise TypeError(
            f"Invalid parameter tuple length at index {index} in parameters list: {item}; expecting length between 1"
            " and 3"
        )
    name, second, descriptor = (*item, None, None)[:3]
    if not isinstance(name, str):
        raise TypeError(f"First element {name} at index {index} in parameters list is not a str.")
    if namespace:
        name = f"{namespace}{PARAMETER_SEPARATOR_STRING}{name}"
    validate_parameter_name(name)
    if len(item) < 3:
        descriptor = ros_types.ParameterDescriptor()
    if not isinstance(descriptor, ros_types.ParameterDescriptor):
        raise TypeError(f"Third element {descriptor} at index {index} in parameters list is not a ParameterDescriptor.")
    if len(item) == 1:
        warnings.warn(
            f"when declaring parameter named '{name}', declaring a parameter only providing its name is deprecated. You"
            ' have to either:\n\t- Pass a name and a default value different to "PARAMETER NOT SET" (and optionally a'
            " descriptor).\n\t- Pass a name and a parameter type.\n\t- Pass a name and a descriptor with"
            " `dynamic_typing=True",
            stacklevel=4,
        )
        descriptor.dynamic_typing = True
    value = _default(name, second, descriptor)
    if name in overrides:
        value = overrides[name].value
    return Parameter(name, value=value), descriptor


def _default(name: str, second: Any, descriptor: ros_types.ParameterDescriptor) -> Any:
    """The default value of a declaration, whose descriptor gets the type."""
    if isinstance(second, Parameter.Type):
        if second is Parameter.Type.NOT_SET:
            raise ValueError(f"Cannot declare parameter {{{name}}} as statically typed of type NOT_SET")
        if descriptor.dynamic_typing:
            raise ValueError(
                f"When declaring parameter {{{name}}} passing a descriptor with`dynamic_typing=True` is not allowed"
                " when the parameter type is provided"
            )
        descriptor.type = second.value
        return None
    if not descriptor.dynamic_typing:
        is_message = isinstance(second, ros_types.ParameterValue)
        descriptor.type = second.type if is_message else Parameter.Type.from_parameter_value(second).value
        if descriptor.type == ros_types.ParameterType.PARAMETER_NOT_SET:
            raise ValueError("Cannot declare a statically typed parameter with default value of type PARAMETER_NOT_SET")
    return second
