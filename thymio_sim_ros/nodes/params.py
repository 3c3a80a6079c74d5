"""A node's parameters as one frozen dataclass: declared, described and checked from the same fields.

    @dataclass(frozen=True)
    class Params:
        real_time_factor: float = param(1.0, "Simulated seconds per second", low=0.0, high=1000.0)

`declare` declares them all and returns the values in force; descriptors (text, range, read-only flag) come
from the fields, so that `ros2 param describe` and the code cannot disagree.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable
from dataclasses import Field, field
from typing import Any, TypeVar

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
from rclpy.exceptions import InvalidParameterTypeException, InvalidParameterValueException
from rclpy.node import Node
from rclpy.parameter import Parameter

from thymio_sim_ros.nodes.life import StartError

T = TypeVar("T")


def param(
    default: Any,
    text: str,
    *,
    name: str | None = None,
    low: float | None = None,
    high: float | None = None,
    fixed: bool = False,
) -> Any:
    """A field of a parameter dataclass; `name` where it has dots, `fixed`: read-only once the node runs."""
    metadata = {"text": text, "low": low, "high": high, "fixed": fixed} | ({"name": name} if name else {})
    if isinstance(default, list):
        return field(default_factory=lambda: list(default), metadata=metadata)
    return field(default=default, metadata=metadata)


def declare(node: Node, defaults: T) -> T:
    """Declare every field on the node; returns the dataclass with the values in force.

    A value from the command line that a descriptor refuses is a StartError.
    """
    values = {}
    for item in dataclasses.fields(defaults):  # type: ignore[arg-type]  # T is always a dataclass
        default = getattr(defaults, item.name)
        name = item.metadata.get("name", item.name)
        try:
            parameter = node.declare_parameter(name, default, _descriptor(item, default))
        except (InvalidParameterTypeException, InvalidParameterValueException) as error:
            reason = " ".join(str(error).split())
            raise StartError(f"parameter {name} of {node.get_name()}: {reason}") from error
        value = parameter.value
        values[item.name] = default if value is None else value
    return dataclasses.replace(defaults, **values)  # type: ignore[type-var]


def _descriptor(item: Field[Any], default: Any) -> ParameterDescriptor:
    text, low, high = item.metadata["text"], item.metadata["low"], item.metadata["high"]
    descriptor = ParameterDescriptor(description=text, read_only=item.metadata["fixed"])
    if low is None and high is None:
        return descriptor
    if isinstance(default, float):
        bounds = FloatingPointRange(
            from_value=-math.inf if low is None else float(low), to_value=math.inf if high is None else float(high)
        )
        descriptor.floating_point_range = [bounds]
    else:
        descriptor.integer_range = [IntegerRange(from_value=int(low or 0), to_value=int(high or 0))]
    return descriptor


def changes(parameters: Iterable[Parameter]) -> dict[str, Any]:
    """Parameter list of a callback as name → value."""
    return {parameter.name: parameter.value for parameter in parameters}
