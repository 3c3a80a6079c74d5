"""Declares the parameters of a node from one frozen dataclass, with descriptors and checks from the same fields.

    @dataclass(frozen=True)
    class Params:
        real_time_factor: float = param(1.0, "Simulated seconds per second", low=0.0, high=1000.0)

`declare` declares all fields and returns the current values. Descriptors (text, range, choices, read-only flag) come
from the fields, so that `ros2 param describe`, docs/ros.md and the code agree. `updated` returns the values after a
change; `refusal` checks constraints that a descriptor cannot express.
"""

from __future__ import annotations

import dataclasses
import difflib
import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeVar, cast

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
from rclpy.exceptions import InvalidParameterTypeException, InvalidParameterValueException
from rclpy.node import Node
from rclpy.parameter import Parameter

from thymio_sim_ros.ros.rclpy_ext.node_runner import StartError

T = TypeVar("T")
V = TypeVar("V")

_LIKE = 0.7
"""Similarity 0…1 from which an unknown name is treated as a typing error for a known one."""

_EXPECTED: Mapping[Parameter.Type, str] = {
    Parameter.Type.BOOL: "true or false",
    Parameter.Type.INTEGER: "an integer",
    Parameter.Type.DOUBLE: "a number with a decimal point, such as 2.0",
    Parameter.Type.STRING: "text",
    Parameter.Type.BYTE_ARRAY: "a list of bytes",
    Parameter.Type.BOOL_ARRAY: "a list of true and false",
    Parameter.Type.INTEGER_ARRAY: "a list of integers",
    Parameter.Type.DOUBLE_ARRAY: "a list of numbers with a decimal point, such as [2.0, 0.5]",
    Parameter.Type.STRING_ARRAY: "a list of texts",
}
"""Expected value of a parameter by type, as it is typed in a terminal."""

_SHOWN = 60
"""Characters of a wrong value that a message has at most; a program or a playground is longer."""

_OPTIONS, _GROUP = "options", "group"
"""Keys of the metadata of fields."""

_BOOLS_OF_RCL = ("use_sim_time", "start_type_description_service")
_OF_RCL = ("use_sim_time", "qos_overrides.", "start_type_description_service")


@dataclass(frozen=True, slots=True)
class FieldOptions:
    """What a field of a parameter dataclass declares besides its default; see `param`."""

    text: str
    name: str | None
    low: float | None
    high: float | None
    fixed: bool
    choices: tuple[str, ...]
    size: int | None
    array: Parameter.Type | None


def param(
    default: V,
    text: str,
    *,
    name: str | None = None,
    low: float | None = None,
    high: float | None = None,
    fixed: bool = False,
    choices: Sequence[str] = (),
    size: int | None = None,
    array: Parameter.Type | None = None,
) -> V:
    """Return a field of a parameter dataclass.

    Args:
        default: The default value; its type is the type of the parameter.
        text: The description.
        name: The name of the parameter if it differs from the field, such as a name with dots.
        low, high: Limits of a number, or of each number of an array.
        fixed: Read-only once the node runs.
        choices: All allowed texts.
        size: Length of an array.
        array: The type of an array that may be empty.
    """
    about = FieldOptions(text, name, low, high, fixed, tuple(choices), size, array)
    if isinstance(default, list):
        made = field(default_factory=lambda: list(default), metadata={_OPTIONS: about})
        return cast(V, made)  # a copy of a list has the type of the list
    return field(default=default, metadata={_OPTIONS: about})


def group(default: V, name: str) -> V:
    """Return a field with a nested parameter dataclass; the names of its parameters begin with `name` and a dot."""
    return field(default=default, metadata={_GROUP: name})


@dataclass(frozen=True)
class Declared:
    """One parameter: full name, path of its field in the dataclass, default and options of the field."""

    name: str
    path: tuple[str, ...]
    default: Any
    options: FieldOptions

    @property
    def descriptor(self) -> ParameterDescriptor:
        """The descriptor shown by `ros2 param describe`."""
        options, low, high = self.options, self.options.low, self.options.high
        expected = [f"one of: {', '.join(options.choices)}"] if options.choices else []
        expected += [f"{options.size} values"] if options.size is not None else []
        expected += [f"each {_limits(low, high)}"] if isinstance(self.default, list) and _limits(low, high) else []
        descriptor = ParameterDescriptor(
            description=options.text, read_only=options.fixed, additional_constraints="; ".join(expected)
        )
        if (low is None and high is None) or isinstance(self.default, list):
            return descriptor
        if isinstance(self.default, float):
            bounds = FloatingPointRange(
                from_value=-math.inf if low is None else float(low), to_value=math.inf if high is None else float(high)
            )
            descriptor.floating_point_range = [bounds]
        else:
            descriptor.integer_range = [IntegerRange(from_value=int(low or 0), to_value=int(high or 0))]
        return descriptor

    def refusal(self, value: Any) -> str:
        """Return the reason why a value is invalid, or an empty text; constraints of the descriptor are not checked."""
        options = self.options
        if value is None:
            return f"{self.name}: found nothing, expected a value"
        if options.choices and value not in options.choices:
            return f"{self.name} is '{value}', expected {' or '.join(options.choices)}"
        if isinstance(value, float) and not math.isfinite(value):
            return f"{self.name} is {value}, expected a finite number"
        if not isinstance(self.default, list):
            return ""
        if options.size is not None and len(value) != options.size:
            return f"{self.name}: found {len(value)} values, expected {options.size}"
        for number, item in enumerate(value):
            if isinstance(item, float) and not _is_within(item, options.low, options.high):
                expected = _limits(options.low, options.high) or "a finite number"
                return f"{self.name}[{number}] is {item}, expected {expected}"
        return ""


def _limits(low: float | None, high: float | None) -> str:
    least, most = (None if bound is None or math.isinf(bound) else _short(bound) for bound in (low, high))
    if least is None and most is None:
        return ""
    if most is None:
        return f"at least {least}"
    return f"at most {most}" if least is None else f"{least} to {most}"


def _short(number: float) -> str:
    """A number without unnecessary decimals; integers have all their digits."""
    return str(number) if isinstance(number, int) else f"{number:g}"


def _is_within(value: float, low: float | None, high: float | None) -> bool:
    return math.isfinite(value) and (low is None or low <= value) and (high is None or value <= high)


def declared(values: Any) -> Iterator[Declared]:
    """Yield every parameter of a dataclass and its groups, in order, with the values of this object as defaults."""
    return _declared(values, "", ())


def _declared(values: Any, prefix: str, path: tuple[str, ...]) -> Iterator[Declared]:
    for item in dataclasses.fields(values):
        here, value = (*path, item.name), getattr(values, item.name)
        if _GROUP in item.metadata:
            yield from _declared(value, f"{prefix}{item.metadata[_GROUP]}.", here)
        else:
            options: FieldOptions = item.metadata[_OPTIONS]
            yield Declared(f"{prefix}{options.name or item.name}", here, value, options)


def declare(node: Node, defaults: T) -> T:
    """Declare every field on the node and return the dataclass with the current values.

    Raises StartError for a value from the command line that violates a descriptor or a field.
    """
    values = defaults
    for item in declared(defaults):
        if item.options.array is not None:
            found = declare_array(node, item.name, item.options.array, item.options.text, item.default)
            values = _with(values, item.path, found)
            continue
        try:
            parameter = node.declare_parameter(item.name, item.default, item.descriptor)
        except (InvalidParameterTypeException, InvalidParameterValueException) as error:
            reason = _start_refusal(node, item) or " ".join(str(error).split())
            raise StartError(f"parameter {item.name} of {node.get_name()}: {reason}") from error
        value = item.default if parameter.value is None else plain(parameter.value)
        reason = item.refusal(value)
        if reason:
            raise StartError(reason)
        values = _with(values, item.path, value)
    return values


def _start_refusal(node: Node, item: Declared) -> str:
    """Return why the start value of a parameter does not fit its descriptor, or an empty text."""
    descriptor = item.descriptor
    descriptor.type = Parameter.Type.from_parameter_value(item.default).value
    given = node._parameter_overrides.get(item.name)  # rclpy has no public accessor
    return "" if given is None else misfit(given, descriptor)


def start_refusal_of_rclpy(node: Node) -> str:
    """Return which parameter that rclpy declares itself has a start value of another type, or an empty text."""
    expected = ParameterDescriptor(type=Parameter.Type.BOOL.value)
    given = {name: parameter for name, parameter in node._parameter_overrides.items() if name in _BOOLS_OF_RCL}
    reasons = ((name, misfit(parameter, expected)) for name, parameter in given.items())
    return next((f"parameter {name} of {node.get_name()}: {reason}" for name, reason in reasons if reason), "")


def misfit(wanted: Parameter, descriptor: ParameterDescriptor) -> str:
    """Return why a value does not fit the type or the range of its parameter, or an empty text.

    rclpy decides; its own sentence has names of Python's classes, this one the terms of `ros2 param`.
    """
    value, kind = plain(wanted.value), Parameter.Type(descriptor.type)
    if kind in _EXPECTED and not descriptor.dynamic_typing and wanted.type_ != kind:
        return f"found {'nothing' if value is None else shown(value)}, expected {_EXPECTED[kind]}"
    ranges: list[IntegerRange | FloatingPointRange] = [*descriptor.integer_range, *descriptor.floating_point_range]
    for bounds in ranges:
        low, high = bounds.from_value, bounds.to_value
        if isinstance(value, int | float) and not _is_within(value, low, high):
            return f"found {value}, expected {_limits(low, high)}"
    return ""


def shown(value: object) -> str:
    """Return a value as a message shows it, shortened if it is long."""
    return _cut(repr(value))


def _cut(text: str) -> str:
    return text if len(text) <= _SHOWN else f"{text[: _SHOWN - 1]}…"


def unknown(name: str, owner: str, names: Sequence[str]) -> str:
    """Return the sentence about a parameter that a node does not have, with the most similar of its `names`.

    `owner` is the full name of the node.
    """
    near = meant(name, names) or f"; `ros2 param list {owner}` lists them"
    return f"found unknown parameter {_cut(name)} of {owner}{near}"


def undeclared(node: Node, name: str) -> str:
    """Return the start value of a parameter that is never declared, so that other nodes cannot read it; or ""."""
    given = node._parameter_overrides.get(name)  # rclpy has no public accessor
    return "" if given is None or given.value is None else str(given.value)


def warn_of_unknown(
    node: Node, page: str, is_known: Callable[[str], bool] | None = None, names: Iterable[str] = ()
) -> None:
    """Warn about start parameters that the node does not have; ROS ignores them silently.

    Args:
        node: The node, with all its parameters declared unless `is_known` is given.
        page: The page of docs/ that lists the parameters.
        is_known: Whether the node has a parameter.
        names: Further names to suggest as corrections.
    """
    known = is_known or node.has_parameter
    for name in sorted(overrides(node)):
        if not known(name) and not name.startswith(_OF_RCL):
            near = meant(
                name, [candidate for candidate in (*node.get_parameters_by_prefix(""), *names) if known(candidate)]
            )
            node.get_logger().warning(
                f"parameter {name} is not a parameter of {node.get_name()} and has no effect{near}; see docs/{page}"
            )


def meant(name: str, names: Sequence[str]) -> str:
    """Return " (did you mean …?)" with the most similar name, or with one that has the whole word; or an empty text."""
    if len(name) > _SHOWN:  # of no human; comparing it would take long
        return ""
    near = difflib.get_close_matches(name, names, 1, _LIKE) or _with_word(name, names)
    return f" (did you mean {near[0]}?)" if near else ""


def _with_word(name: str, names: Sequence[str]) -> list[str]:
    """Return the names that have this one as a word, as `cmd_vel_timeout` has `timeout`."""
    return [candidate for candidate in names if name in re.split(r"[._]", candidate)]


def overrides(node: Node) -> dict[str, Any]:
    """Return the parameter overrides of a node, name → value; None for an empty list."""
    given = node._parameter_overrides  # rclpy has no public accessor
    return {name: parameter.value for name, parameter in given.items()}


def refusal(values: Any, parameters: Iterable[Parameter]) -> str:
    """Return the reason why a change violates a field, or an empty text."""
    known = {item.name: item for item in declared(values)}
    reasons = (
        known[parameter.name].refusal(plain(parameter.value)) for parameter in parameters if parameter.name in known
    )
    return next((reason for reason in reasons if reason), "")


def updated(values: T, parameters: Iterable[Parameter]) -> T:
    """Return the values after a change; unknown parameters are ignored."""
    paths = {item.name: item.path for item in declared(values)}
    for parameter in parameters:
        if parameter.name in paths and parameter.value is not None:
            values = _with(values, paths[parameter.name], plain(parameter.value))
    return values


def declare_array(node: Node, name: str, kind: Parameter.Type, text: str, default: Sequence[Any] = ()) -> list[Any]:
    """Declare a list parameter that may be empty and return its value. Raises StartError if it is not a list.

    An empty list from the command line has no element type, so the caller checks the types of elements.
    """
    node.declare_parameter(name, None, ParameterDescriptor(description=text, dynamic_typing=True))
    found = node.get_parameter(name).value
    if isinstance(found, str | bytes | int | float):
        raise StartError(f"parameter {name} of {node.get_name()}: found {found!r}, expected a list")
    value = list(default if found is None else found)
    node.set_parameters([Parameter(name, kind, value)] if not value else [Parameter(name, value=value)])
    return value


def by_name(values: Any) -> dict[str, Any]:
    """Return the values of a dataclass by parameter name."""
    return {item.name: item.default for item in declared(values)}


def described(text: str) -> ParameterDescriptor:
    """Return a descriptor with a description only."""
    return ParameterDescriptor(description=text)


def changes(parameters: Iterable[Parameter]) -> dict[str, Any]:
    """Return the parameters of a callback as name → value."""
    return {parameter.name: parameter.value for parameter in parameters}


def plain(value: Any) -> Any:
    """Return arrays as lists, and other values unchanged."""
    return value if isinstance(value, str | bytes | int | float | bool) or value is None else list(value)


def _with(values: T, path: tuple[str, ...], value: Any) -> T:
    """Return a copy with the field at `path` set."""
    first, *rest = path
    if rest:
        value = _with(getattr(values, first), tuple(rest), value)
    return dataclasses.replace(values, **{first: value})  # type: ignore[type-var]  # T is always a dataclass
