"""A ROS node whose parameters survive `ros2 param dump` and `load`: loading unchanged values changes nothing.

`load` does not send the values that `dump` wrote: rclpy converts each value to text and guesses its type, so 1e-05
arrives as text, an empty list as a list of booleans, and the lines of a program joined into one. Two rules compensate:
a value is converted to the declared type where possible, and a value that equals the current one, directly or after
such a round trip, is accepted without being set, even if the parameter is read-only.

Reasons of rejections are written in the terms of `ros2 param`: those of rclpy have names of its classes, and lack the
name of an unknown parameter. A reason also comes with the success of a value that changes nothing although a user may
expect it to act, such as the present playground: `ros2 param set` prints it.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from typing import Any

from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.msg import SetParametersResult
from rclpy.context import Context
from rclpy.exceptions import InvalidParameterTypeException
from rclpy.node import Node
from rclpy.parameter import Parameter, get_parameter_value

from thymio_sim_ros.ros.rclpy_ext import parameters
from thymio_sim_ros.ros.rclpy_ext.callback_groups import forget_destroyed
from thymio_sim_ros.ros.rclpy_ext.node_runner import StartError

__all__ = ["ParameterNode", "parameter_node"]

_ARRAYS = {
    Parameter.Type.BYTE_ARRAY,
    Parameter.Type.BOOL_ARRAY,
    Parameter.Type.INTEGER_ARRAY,
    Parameter.Type.DOUBLE_ARRAY,
    Parameter.Type.STRING_ARRAY,
}


class ParameterNode(Node):
    """A node that sets only values that differ; parameter callbacks see only those."""

    def __init__(
        self,
        name: str,
        *,
        context: Context,
        is_set_again: Callable[[str], bool] = lambda _name: False,
        is_free: Callable[[str], bool] | None = None,
        repeat: Callable[[str], str] = lambda _name: "",
        has_acted: Callable[[], bool] = lambda: True,
        missing: Callable[[str], str] = lambda _name: "",
        **options: Any,
    ) -> None:
        """Create a node.

        Args:
            name: The name of the node.
            context: Its context.
            is_set_again: Whether a parameter is set even if unchanged, such as a file that may differ.
            is_free: Whether a parameter may be set without being declared; without it, none may.
            repeat: Says how to get the effect of a parameter again, such as a new world, that has its value already;
                empty for one without such an effect.
            has_acted: Whether the parameters that were set again have just had an effect.
            missing: Says why a parameter does not exist on purpose; empty for any other one.
            options: Options of rclpy's node.

        Raises StartError for a start value of a parameter of rclpy, such as `use_sim_time`, that has another type.
        """
        self._is_set_again, self._is_free = is_set_again, is_free
        self._repeat, self._has_acted, self._missing = repeat, has_acted, missing
        try:
            super().__init__(name, context=context, allow_undeclared_parameters=is_free is not None, **options)
        except InvalidParameterTypeException as error:
            raise StartError(parameters.start_refusal_of_rclpy(self) or str(error)) from error
        forget_destroyed(self)

    def set_parameters_atomically(self, parameter_list: list[Parameter]) -> SetParametersResult:
        """Set the values that differ, all or none; called by rclpy's parameter services."""
        wanted = [self._as_declared(parameter) for parameter in parameter_list]
        if refusal := next(filter(None, map(self._unknown, wanted)), ""):
            return SetParametersResult(successful=False, reason=refusal)
        present = {parameter.name: parameter.value for parameter in wanted if self._is_present(parameter)}
        changed = [
            parameter for parameter in wanted if parameter.name not in present or self._is_set_again(parameter.name)
        ]
        if changed:
            result = super().set_parameters_atomically(changed)
            if not result.successful:
                result.reason = next(filter(None, map(self._misfit, changed)), result.reason)
                return result
            if self._has_acted():
                return result
        notes = ((name, self._repeat(name)) for name, value in present.items() if value != "")
        sentences = (f"{name} has this value already, nothing changed: {how}" for name, how in notes if how)
        return SetParametersResult(successful=True, reason="; ".join(sentences))

    def _unknown(self, wanted: Parameter) -> str:
        """Return a sentence if the node has no such parameter."""
        if self.has_parameter(wanted.name) or (self._is_free is not None and self._is_free(wanted.name)):
            return ""
        if reason := self._missing(wanted.name):
            return f"{wanted.name}: {reason}"
        return parameters.unknown(wanted.name, self.get_fully_qualified_name(), list(self.get_parameters_by_prefix("")))

    def _misfit(self, wanted: Parameter) -> str:
        """Return why rclpy rejected a value because of the parameter's descriptor; empty if it did not."""
        if not self.has_parameter(wanted.name):
            return ""
        descriptor = self.describe_parameter(wanted.name)
        if descriptor.read_only:
            return f"{wanted.name} is read-only while the node runs: start it with --ros-args -p {wanted.name}:=…"
        reason = parameters.misfit(wanted, descriptor)
        return f"{wanted.name}: {reason}" if reason else ""

    def _as_declared(self, wanted: Parameter) -> Parameter:
        """Convert the value to the current type of the parameter where possible."""
        if not self.has_parameter(wanted.name):
            return wanted
        kind = self.get_parameter(wanted.name).type_
        if kind in _ARRAYS and wanted.type_ in _ARRAYS and not len(wanted.value):
            return Parameter(wanted.name, kind, [])
        if kind == Parameter.Type.DOUBLE and wanted.type_ == Parameter.Type.STRING:
            value: Any = _number(wanted.value)
        elif kind == Parameter.Type.DOUBLE_ARRAY and wanted.type_ in (
            Parameter.Type.STRING,
            Parameter.Type.STRING_ARRAY,
        ):
            value = _numbers(wanted.value)
        else:
            value = None
        return wanted if value is None else Parameter(wanted.name, kind, value)

    def _is_present(self, wanted: Parameter) -> bool:
        """Whether the parameter has this value already."""
        if not self.has_parameter(wanted.name):
            return False
        return _are_equal(self.get_parameter(wanted.name), wanted) or _is_loaded_from(
            self.get_parameter(wanted.name), wanted
        )


def parameter_node(name: str, *, context: Context, **options: Any) -> Node:
    """Create a ParameterNode, typed as rclpy's Node."""
    return ParameterNode(name, context=context, **options)


def _are_equal(parameter: Parameter, other: Parameter) -> bool:
    return bool(parameter.type_ == other.type_ and parameters.plain(parameter.value) == parameters.plain(other.value))


def _is_loaded_from(present: Parameter, wanted: Parameter) -> bool:
    """Whether `ros2 param load` sends `wanted` for the present value."""
    value = parameters.plain(present.value)
    if isinstance(value, str) and isinstance(wanted.value, str) and wanted.value.split() != value.split():
        return False  # a round trip changes only white space; checked first, since parsing programs as YAML is slow
    try:
        sent = get_parameter_value(str(value))
    except Exception:  # raised by YAML or the message: no such value can be sent
        return False
    return _are_equal(Parameter.from_parameter_msg(ParameterMessage(name=wanted.name, value=sent)), wanted)


def _number(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None


def _numbers(found: str | Sequence[str]) -> list[float] | None:
    """Parse a list of numbers from JSON text or from a list of texts; None if that is not possible."""
    if isinstance(found, str):
        try:
            found = json.loads(found)
        except (ValueError, RecursionError):
            return None
        if not isinstance(found, list):
            return None
    try:
        return [float(item) for item in found]
    except (TypeError, ValueError, OverflowError):
        return None
