"""The verbs of parameters."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import yaml
from rcl_interfaces.msg import ParameterType, ParameterValue
from rclpy.parameter import (
    Parameter,
    get_parameter_value,
    parameter_dict_from_yaml_file,
    parameter_value_to_python,
)
from rclpy.parameter_client import AsyncParameterClient
from rclpy.topic_or_service_is_hidden import topic_or_service_is_hidden

from thymio_sim_ros.ros.profiles import missing_parameter
from thymio_sim_ros.ros_commands.errors import CommandError
from thymio_sim_ros.ros_commands.member import ANSWER_S, Member

__all__ = ["VERBS"]

_SERVICES = ("list_parameters", "get_parameters", "set_parameters")
_LABELS = {
    ParameterType.PARAMETER_BOOL: "Boolean value is:",
    ParameterType.PARAMETER_INTEGER: "Integer value is:",
    ParameterType.PARAMETER_DOUBLE: "Double value is:",
    ParameterType.PARAMETER_STRING: "String value is:",
    ParameterType.PARAMETER_BYTE_ARRAY: "Byte values are:",
    ParameterType.PARAMETER_BOOL_ARRAY: "Boolean values are:",
    ParameterType.PARAMETER_INTEGER_ARRAY: "Integer values are:",
    ParameterType.PARAMETER_DOUBLE_ARRAY: "Double values are:",
    ParameterType.PARAMETER_STRING_ARRAY: "String values are:",
}


_TYPES = {
    ParameterType.PARAMETER_BOOL: "boolean",
    ParameterType.PARAMETER_INTEGER: "integer",
    ParameterType.PARAMETER_DOUBLE: "double",
    ParameterType.PARAMETER_STRING: "string",
    ParameterType.PARAMETER_BYTE_ARRAY: "byte array",
    ParameterType.PARAMETER_BOOL_ARRAY: "boolean array",
    ParameterType.PARAMETER_INTEGER_ARRAY: "integer array",
    ParameterType.PARAMETER_DOUBLE_ARRAY: "double array",
    ParameterType.PARAMETER_STRING_ARRAY: "string array",
}


def _list(member: Member, options: argparse.Namespace) -> None:
    if options.node is not None:
        full, client = _client(member, options.node)
        for name in _names(member, full, client):
            print(f"  {name}")
        return
    member.discover()
    for full in member.nodes():
        if topic_or_service_is_hidden(full) or not _has_parameters(member, full):
            continue
        print(f"{full}:")
        for name in _names(member, full, AsyncParameterClient(member.node, full)):
            print(f"  {name}")


def _get(member: Member, options: argparse.Namespace) -> None:
    full, client = _client(member, options.node)
    (value,) = _values(member, full, client, [options.parameter])
    if value.type not in _LABELS:
        raise _unknown(options.parameter, full)
    print(_LABELS[value.type], _python(value))


def _set(member: Member, options: argparse.Namespace) -> None:
    full, client = _client(member, options.node)
    _ready(member, full, client)
    value = parameter_value_to_python(get_parameter_value(options.value))
    (result,) = member.answer(client.set_parameters([Parameter(options.parameter, value=value)]), full).results
    reason = f": {result.reason}" if result.reason else ""
    if not result.successful:
        raise CommandError(f"Setting parameter failed{reason}")
    print(f"Set parameter successful{reason}")


def _describe(member: Member, options: argparse.Namespace) -> None:
    full, client = _client(member, options.node)
    names = _names(member, full, client)
    for name in options.parameters:
        if name not in names:
            raise _unknown(name, full)
    for found in member.answer(client.describe_parameters(options.parameters), full).descriptors:
        print(f"Parameter name: {found.name}\n  Type: {_TYPES.get(found.type, 'not set')}")
        if found.description:
            print(f"  Description: {found.description}")
        print("  Constraints:")
        if found.read_only:
            print("    Read only: true")
        for limits in (*found.floating_point_range, *found.integer_range):
            print(f"    Min value: {limits.from_value}\n    Max value: {limits.to_value}")
            if limits.step:
                print(f"    Step: {limits.step}")
        if found.additional_constraints:
            print(f"    Additional constraints: {found.additional_constraints}")


def _unknown(name: str, full: str) -> CommandError:
    reason = missing_parameter(full, name) or f"`param list {full}` prints its parameters"
    return CommandError(f"found no parameter {name} of {full}: {reason}")


def _dump(member: Member, options: argparse.Namespace) -> None:
    full, client = _client(member, options.node)
    names = _names(member, full, client)
    tree: dict[str, Any] = {}
    for name, value in zip(names, _values(member, full, client, names), strict=True):
        *groups, last = name.split(".")
        place = tree
        for group in groups:
            place = place.setdefault(group, {})
        place[last] = _python(value)
    yaml.safe_dump({full: {"ros__parameters": tree}}, sys.stdout, default_flow_style=False, allow_unicode=True)


def _load(member: Member, options: argparse.Namespace) -> None:
    full, client = _client(member, options.node)
    try:
        values = parameter_dict_from_yaml_file(str(options.file), use_wildcard=True, target_nodes=[full])
    except OSError as error:
        raise CommandError(f"{options.file}: {error.strerror}, expected a file of parameters") from error
    except yaml.YAMLError as error:
        raise CommandError(f"{options.file}: {' '.join(str(error).split())}") from error
    except (RuntimeError, AttributeError, TypeError, ValueError) as error:  # raised by rclpy for other contents
        raise CommandError(
            f"{options.file}: found no parameters of {full}, expected `{full}:` and below it `ros__parameters:`"
        ) from error
    _ready(member, full, client)
    wanted = [Parameter.from_parameter_msg(value) for value in values.values()]
    results = member.answer(client.set_parameters(wanted), full).results
    for name, result in zip(values, results, strict=True):
        reason = f": {result.reason}" if result.reason else ""
        print(f"Set parameter {name} {'successful' if result.successful else 'failed'}{reason}")
    if not any(result.successful for result in results):
        raise CommandError(f"no parameter of {options.file} could be set")


def _has_parameters(member: Member, full: str) -> bool:
    services = member.services()
    return all(f"{full}/{service}" in services for service in _SERVICES)


def _client(member: Member, node: str) -> tuple[str, AsyncParameterClient]:
    """The full name of a node and a client of its parameters. Raises CommandError."""
    full = member.find("node", node, member.nodes)
    if not member.wait(lambda: _has_parameters(member, full)):
        raise CommandError(f"node {full}: found no services of parameters, expected a node with parameters")
    return full, AsyncParameterClient(member.node, full)


def _names(member: Member, full: str, client: AsyncParameterClient) -> list[str]:
    _ready(member, full, client)
    return sorted(member.answer(client.list_parameters(), full).result.names)


def _ready(member: Member, full: str, client: AsyncParameterClient) -> None:
    if not member.spin_until(client.services_are_ready, ANSWER_S):
        raise CommandError(f"node {full}: its services of parameters do not answer within {ANSWER_S:g} s")


def _values(member: Member, full: str, client: AsyncParameterClient, names: list[str]) -> Sequence[ParameterValue]:
    _ready(member, full, client)
    found: Sequence[ParameterValue] = member.answer(client.get_parameters(names), full).values
    return found or [ParameterValue()] * len(names)


def _python(value: ParameterValue) -> Any:
    found = parameter_value_to_python(value)
    return found.tolist() if hasattr(found, "tolist") else found


VERBS: Mapping[str, Callable[[Member, argparse.Namespace], None]] = {
    "list": _list,
    "get": _get,
    "set": _set,
    "describe": _describe,
    "dump": _dump,
    "load": _load,
}
