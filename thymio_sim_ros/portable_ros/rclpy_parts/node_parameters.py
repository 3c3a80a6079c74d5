"""The parameters of a node: declaration, changes with their callbacks, descriptors."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from thymio_sim_ros.portable_ros import ros_types
from thymio_sim_ros.portable_ros.rclpy.exceptions import (
    InvalidParameterTypeException,
    InvalidParameterValueException,
    ParameterAlreadyDeclaredException,
    ParameterImmutableException,
    ParameterNotDeclaredException,
    ParameterUninitializedException,
)
from thymio_sim_ros.portable_ros.rclpy.parameter import PARAMETER_SEPARATOR_STRING, Parameter
from thymio_sim_ros.portable_ros.rclpy_parts.node_base import NodeBase
from thymio_sim_ros.portable_ros.rclpy_parts.parameter_declaration import declared
from thymio_sim_ros.portable_ros.rclpy_parts.parameter_listing import listed
from thymio_sim_ros.portable_ros.rclpy_parts.parameter_ranges import range_problem, type_problem

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.rclpy.publisher import Publisher

__all__ = ["NodeParameters"]

_EMPTY_LIST = (
    "parameter list cannot be empty, this might be due to pre_set_parameters_callback modifying the original parameters"
    " list."
)


class NodeParameters(NodeBase):
    """The part of a node that has the parameters."""

    _parameter_event_publisher: Publisher[Any]

    def _prepare_parameters(self, overrides: Mapping[str, Parameter], *, is_undeclared_allowed: bool) -> None:
        """Start without parameters; `overrides` are the values of the start."""
        self._parameters: dict[str, Parameter] = {}
        self._descriptors: dict[str, ros_types.ParameterDescriptor] = {}
        self._parameter_overrides = dict(overrides)
        self._allow_undeclared_parameters = is_undeclared_allowed
        self._pre_set_parameters_callbacks: list[Callable[[list[Parameter]], list[Parameter]]] = []
        self._on_set_parameters_callbacks: list[Callable[[list[Parameter]], ros_types.SetParametersResult]] = []
        self._post_set_parameters_callbacks: list[Callable[[list[Parameter]], None]] = []

    def declare_parameter(
        self,
        name: str,
        value: Any = None,
        descriptor: ros_types.ParameterDescriptor | None = None,
        ignore_override: bool = False,
    ) -> Parameter:
        """Declare a parameter with a default value or a type, and return it with the value of the start.

        Raises ParameterAlreadyDeclaredException, InvalidParameterException and, for a value that does not fit,
        InvalidParameterTypeException or InvalidParameterValueException.
        """
        if value is None and descriptor is None:
            items: list[tuple[Any, ...]] = [(name,)]
        else:
            items = [(name, value, ros_types.ParameterDescriptor() if descriptor is None else descriptor)]
        return self.declare_parameters("", items, ignore_override)[0]

    def declare_parameters(
        self, namespace: str, parameters: Sequence[tuple[Any, ...]], ignore_override: bool = False
    ) -> list[Parameter]:
        """Declare parameters: tuples of name, value or type, and descriptor. Raises as `declare_parameter`."""
        overrides = {} if ignore_override else self._parameter_overrides
        found = [declared(namespace, one, index, overrides) for index, one in enumerate(parameters)]
        known = [parameter.name for parameter, _ in found if parameter.name in self._parameters]
        if known:
            raise ParameterAlreadyDeclaredException(known)
        for parameter, descriptor in found:
            result = self._set_all([parameter], {parameter.name: descriptor})
            if not result.successful:
                if result.reason.startswith("Wrong parameter type"):
                    raise InvalidParameterTypeException(parameter, Parameter.Type(descriptor.type).name)
                raise InvalidParameterValueException(parameter.name, parameter.value, result.reason)
        return [self._parameters[parameter.name] for parameter, _ in found]

    def undeclare_parameter(self, name: str) -> None:
        """Remove a parameter. Raises ParameterNotDeclaredException, and ParameterImmutableException if read-only."""
        if not self.has_parameter(name):
            raise ParameterNotDeclaredException(name)
        if self._descriptors[name].read_only:
            raise ParameterImmutableException(name)
        del self._parameters[name], self._descriptors[name]

    def has_parameter(self, name: str) -> bool:
        """Whether a parameter is declared."""
        return name in self._parameters

    def get_parameter_types(self, names: Sequence[str]) -> list[Any]:
        """The types of parameters. Raises ParameterNotDeclaredException."""
        _require_texts(names)
        return [self.get_parameter_type(name) for name in names]

    def get_parameter_type(self, name: str) -> Any:
        """The number of the type of a parameter. Raises ParameterNotDeclaredException."""
        if name in self._parameters:
            return self._parameters[name].type_.value
        if self._allow_undeclared_parameters:
            return Parameter.Type.NOT_SET
        raise ParameterNotDeclaredException(name)

    def get_parameters(self, names: Sequence[str]) -> list[Parameter]:
        """Parameters by their names. Raises as `get_parameter`."""
        _require_texts(names)
        return [self.get_parameter(name) for name in names]

    def get_parameter(self, name: str) -> Parameter:
        """A parameter. Raises ParameterNotDeclaredException, and ParameterUninitializedException without a value."""
        found = self._parameters.get(name)
        if found is not None:
            if found.type_ is not Parameter.Type.NOT_SET or self._descriptors[name].dynamic_typing:
                return found
            raise ParameterUninitializedException(name)
        if self._allow_undeclared_parameters:
            return Parameter(name, Parameter.Type.NOT_SET, None)
        raise ParameterNotDeclaredException(name)

    def get_parameter_or(self, name: str, alternative_value: Parameter | None = None) -> Parameter:
        """A parameter, or the alternative if it is not declared or has no value."""
        found = self._parameters.get(name)
        if found is None or found.type_ is Parameter.Type.NOT_SET:
            return Parameter(name, Parameter.Type.NOT_SET) if alternative_value is None else alternative_value
        return found

    def get_parameters_by_prefix(self, prefix: str) -> dict[str, Parameter]:
        """The parameters whose names begin with a prefix and a dot, by the rest of their names."""
        start = f"{prefix}{PARAMETER_SEPARATOR_STRING}" if prefix else ""
        return {name.removeprefix(start): one for name, one in self._parameters.items() if name.startswith(start)}

    def set_parameters(self, parameter_list: Sequence[Parameter]) -> list[ros_types.SetParametersResult]:
        """Set parameters one after the other; return a result for each. Raises ParameterNotDeclaredException."""
        return [self._set_atomically([one]) for one in parameter_list]

    def set_parameters_atomically(self, parameter_list: list[Parameter]) -> ros_types.SetParametersResult:
        """Set all parameters or none; return the result. Raises ParameterNotDeclaredException."""
        return self._set_atomically(parameter_list)

    def list_parameters(self, prefixes: list[str], depth: int) -> ros_types.ListParametersResult:
        """The names of all parameters, or of those with a prefix; `depth` limits the dots, 0 stands for any number."""
        return listed(self._parameters, prefixes, depth)

    def add_pre_set_parameters_callback(self, callback: Callable[[list[Parameter]], list[Parameter]]) -> None:
        """Let a callback change the list before parameters are checked."""
        self._pre_set_parameters_callbacks.insert(0, callback)

    def add_on_set_parameters_callback(
        self, callback: Callable[[list[Parameter]], ros_types.SetParametersResult]
    ) -> None:
        """Let a callback accept or reject new values. Raises TypeError for what cannot be called."""
        _require_callable(callback)
        self._on_set_parameters_callbacks.insert(0, callback)

    def add_post_set_parameters_callback(self, callback: Callable[[list[Parameter]], None]) -> None:
        """Call back after parameters were set. Raises TypeError for what cannot be called."""
        _require_callable(callback)
        self._post_set_parameters_callbacks.insert(0, callback)

    def remove_pre_set_parameters_callback(self, callback: Callable[[list[Parameter]], list[Parameter]]) -> None:
        """Undo `add_pre_set_parameters_callback`. Raises ValueError for an unknown callback."""
        self._pre_set_parameters_callbacks.remove(callback)

    def remove_on_set_parameters_callback(
        self, callback: Callable[[list[Parameter]], ros_types.SetParametersResult]
    ) -> None:
        """Undo `add_on_set_parameters_callback`. Raises ValueError for an unknown callback."""
        self._on_set_parameters_callbacks.remove(callback)

    def remove_post_set_parameters_callback(self, callback: Callable[[list[Parameter]], None]) -> None:
        """Undo `add_post_set_parameters_callback`. Raises ValueError for an unknown callback."""
        self._post_set_parameters_callbacks.remove(callback)

    def describe_parameter(self, name: str) -> ros_types.ParameterDescriptor:
        """The descriptor of a parameter. Raises ParameterNotDeclaredException."""
        if name in self._descriptors:
            return self._descriptors[name]
        if self._allow_undeclared_parameters:
            return ros_types.ParameterDescriptor()
        raise ParameterNotDeclaredException(name)

    def describe_parameters(self, names: Sequence[str]) -> list[ros_types.ParameterDescriptor]:
        """The descriptors of parameters. Raises ParameterNotDeclaredException."""
        return [self.describe_parameter(name) for name in names]

    def set_descriptor(
        self, name: str, descriptor: ros_types.ParameterDescriptor, alternative_value: Any = None
    ) -> Any:
        """Replace a descriptor; return the value: the present one if it fits, else the alternative.

        Raises ParameterNotDeclaredException, ParameterImmutableException and InvalidParameterValueException.
        """
        if not self.has_parameter(name):
            if not self._allow_undeclared_parameters:
                raise ParameterNotDeclaredException(name)
            return self.get_parameter(name).get_parameter_value()
        if self.describe_parameter(name).read_only:
            raise ParameterImmutableException(name)
        parameter = self.get_parameter(name)
        if self._problem(parameter, descriptor) and alternative_value is not None:
            message = ros_types.ParameterMessage(name=name, value=alternative_value)
            parameter = Parameter.from_parameter_msg(message)
        if reason := self._problem(parameter, descriptor):
            raise InvalidParameterValueException(name, parameter.value, reason)
        self._parameters[name], self._descriptors[name] = parameter, descriptor
        return parameter.get_parameter_value()

    def _set_atomically(self, parameters: list[Parameter]) -> ros_types.SetParametersResult:
        if self._pre_set_parameters_callbacks:
            parameters = [one for callback in self._pre_set_parameters_callbacks for one in callback(parameters)]
            if not parameters:
                return ros_types.SetParametersResult(successful=False, reason=_EMPTY_LIST)
        if not all(isinstance(one, Parameter) for one in parameters):
            raise TypeError(f"parameter must be instance of type '{Parameter!r}'")
        unknown = [one.name for one in parameters if one.name not in self._parameters]
        if unknown and not self._allow_undeclared_parameters:
            # rclpy's exception lacks the first name, because the check has used it up.
            raise ParameterNotDeclaredException(unknown[1:])
        return self._set_all(parameters, None)

    def _problem(self, parameter: Parameter, descriptor: ros_types.ParameterDescriptor) -> str:
        """Why a value does not fit a descriptor, which gets its name and, with a dynamic type, its type."""
        descriptor.name = parameter.name
        if descriptor.dynamic_typing:
            descriptor.type = parameter.type_.value
        elif reason := type_problem(parameter, descriptor, is_declared=self.has_parameter(parameter.name)):
            return reason
        return range_problem(parameter, descriptor)

    def _rejection(
        self, parameters: list[Parameter], descriptors: Mapping[str, ros_types.ParameterDescriptor] | None
    ) -> ros_types.SetParametersResult | None:
        """The result for values that are rejected, None if they are not."""
        for parameter in parameters:
            descriptor = (self._descriptors if descriptors is None else descriptors).get(parameter.name)
            if descriptor is None:
                continue
            if descriptors is None and descriptor.read_only:
                reason = f"Trying to set a read-only parameter: {parameter.name}."
            else:
                reason = self._problem(parameter, descriptor)
            if reason:
                return ros_types.SetParametersResult(successful=False, reason=reason)
        for callback in list(self._on_set_parameters_callbacks):
            result = callback(parameters)
            if not isinstance(result, ros_types.SetParametersResult):
                warnings.warn("Callback returned an invalid type, it should return SetParameterResult.", stacklevel=2)
                return ros_types.SetParametersResult(successful=False, reason="Callback returned an invalid type")
            if not result.successful:
                return result
        return None

    def _set_all(
        self, parameters: list[Parameter], descriptors: Mapping[str, ros_types.ParameterDescriptor] | None
    ) -> ros_types.SetParametersResult:
        """Set all parameters or none; with descriptors they are declared."""
        rejection = self._rejection(parameters, descriptors)
        if rejection is not None:
            return rejection
        event = ros_types.ParameterEvent(node=self.get_fully_qualified_name())
        for parameter in parameters:
            if descriptors is None and parameter.type_ is Parameter.Type.NOT_SET:
                self._parameters.pop(parameter.name, None)
                self._descriptors.pop(parameter.name, None)
                event.deleted_parameters.append(parameter.to_parameter_msg())
                continue
            is_new = self.get_parameter_or(parameter.name).type_ is Parameter.Type.NOT_SET
            changes = event.new_parameters if is_new else event.changed_parameters
            changes.append(parameter.to_parameter_msg())
            if descriptors is not None:
                self._descriptors[parameter.name] = descriptors[parameter.name]
            else:
                dynamic = ros_types.ParameterDescriptor(dynamic_typing=True)
                self._descriptors.setdefault(parameter.name, dynamic)
            self._parameters[parameter.name] = parameter
        event.stamp = self.get_clock().now().to_msg()
        self._parameter_event_publisher.publish(event)
        for callback in list(self._post_set_parameters_callbacks):
            callback(parameters)
        return ros_types.SetParametersResult(successful=True)


def _require_callable(callback: object) -> None:
    if not callable(callback):
        raise TypeError("Callback must be callable, got {}", type(callback))  # as rclpy's: a tuple of both


def _require_texts(names: Sequence[str]) -> None:
    if not all(isinstance(name, str) for name in names):
        raise TypeError("All names must be instances of type str")
