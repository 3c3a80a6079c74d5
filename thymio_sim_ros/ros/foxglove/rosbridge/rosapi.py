"""The services of rosapi, which clients of rosbridge use to explore the graph (docs/rosbridge.md, section rosapi).

The package rosapi serves them as a node. Here they are no services of the graph: their types are not installed
everywhere. A node of that name has precedence.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.srv import GetParameters, ListParameters, SetParameters
from rclpy.node import NodeNameNonExistentError
from rclpy.parameter import Parameter, parameter_value_to_python

from thymio_sim_ros.portable_ros.import_hook import is_served
from thymio_sim_ros.ros.foxglove.file_access import parameter_refusal
from thymio_sim_ros.ros.foxglove.graph import visible_topics
from thymio_sim_ros.ros.foxglove.rosbridge.host import Host
from thymio_sim_ros.ros.foxglove.rosbridge.type_details import type_details
from thymio_sim_ros.ros.foxglove.schemas import message_definition
from thymio_sim_ros.ros.foxglove.types import MissingTypeError

__all__ = ["CHANGES", "call", "serves"]

_PREFIX = "/rosapi/"
CHANGES = frozenset({"/rosapi/set_param", "/rosapi/delete_param"})
"""Services that read-only clients may not call."""

Values = dict[str, Any]
Done = Callable[[Values | str], None]
"""Takes the fields of a response, or the reason why there is none."""


def serves(name: str) -> bool:
    """Whether a service, by its full name, is one of rosapi."""
    return name in _ANSWERS or name in _CALLS


def call(host: Host, name: str, args: object, done: Done, client: int) -> None:
    """Answer a call; `done` is called once, at once or later."""
    given = args if isinstance(args, dict) else {}
    if name in _CALLS:
        _CALLS[name](host, given, done, client)
        return
    try:
        done(_ANSWERS[name](host, given))
    except MissingTypeError as error:
        done(f"{name}: {error}")


def _text(args: Mapping[str, Any], key: str) -> str:
    value = args.get(key, "")
    return value if isinstance(value, str) else ""


# --- names and types -------------------------------------------------------------------------------------------------


def _topics(host: Host) -> dict[str, str]:
    shown = visible_topics(dict(host.node.get_topic_names_and_types()), host.is_topic, hidden=False)
    return {name: types[0] for name, types in shown.items()}


def _services(host: Host) -> dict[str, str]:
    return {name: types[0] for name, types in host.node.get_service_names_and_types() if host.is_service(name)}


def _nodes(host: Host) -> list[str]:
    return [_full(name, space) for name, space in host.node.get_node_names_and_namespaces() if name[:1] != "_"]


def _full(name: str, namespace: str) -> str:
    return f"{namespace.rstrip('/')}/{name}"


def _node_details(host: Host, args: Mapping[str, Any]) -> Values:
    namespace, _, name = _text(args, "node").rpartition("/")
    node, found = host.node, (name, namespace or "/")
    try:
        subscribing = node.get_subscriber_names_and_types_by_node(*found)
        publishing = node.get_publisher_names_and_types_by_node(*found)
        services = node.get_service_names_and_types_by_node(*found)
    except (NodeNameNonExistentError, ValueError):
        return {"subscribing": [], "publishing": [], "services": []}
    parts = {"subscribing": subscribing, "publishing": publishing, "services": services}
    return {key: [item for item, _ in items] for key, items in parts.items()}


def _providers(host: Host, service: str) -> list[str]:
    return [node for node in _nodes(host) if service in _node_details(host, {"node": node})["services"]]


def _raw_types(host: Host) -> Values:
    topics = _topics(host)
    texts = {}
    for kind in set(topics.values()):
        try:
            texts[kind] = message_definition(kind)
        except MissingTypeError as error:
            texts[kind] = f"# {error}"
    return {**_listed(topics), "typedefs_full_text": [texts[kind] for kind in topics.values()]}


def _listed(topics: Mapping[str, str]) -> Values:
    return {"topics": list(topics), "types": list(topics.values())}


def _with_type(names: Mapping[str, str], args: Mapping[str, Any]) -> list[str]:
    wanted = _short(_text(args, "type"))
    return [name for name, kind in names.items() if _short(kind) == wanted]


def _short(kind: str) -> str:
    """A type as `package/Type`, which clients write for `package/msg/Type`."""
    words = kind.split("/")
    return f"{words[0]}/{words[-1]}"


def _action_servers(host: Host) -> list[str]:
    end = "/_action/send_goal"
    return [name.removesuffix(end) for name, _ in host.node.get_service_names_and_types() if name.endswith(end)]


def _time(host: Host) -> Values:
    sec, nanosec = divmod(host.now_ns(), 1_000_000_000)
    return {"time": {"sec": sec, "nanosec": nanosec}}


def _ros_version() -> Values:
    """As of rosapi, and whether the graph is the embedded one, which commands ask for."""
    return {"version": 2, "distro": os.environ.get("ROS_DISTRO", "jazzy"), "is_embedded": is_served("rclpy")}


def _endpoints(found: Any) -> list[str]:
    return sorted({_full(info.node_name, info.node_namespace) for info in found})


_ANSWERS: Mapping[str, Callable[[Host, Mapping[str, Any]], Values]] = {
    "/rosapi/topics": lambda host, args: _listed(_topics(host)),
    "/rosapi/topics_for_type": lambda host, args: {"topics": _with_type(_topics(host), args)},
    "/rosapi/topics_and_raw_types": lambda host, args: _raw_types(host),
    "/rosapi/topic_type": lambda host, args: {"type": _topics(host).get(_text(args, "topic"), "")},
    "/rosapi/services": lambda host, args: {"services": list(_services(host))},
    "/rosapi/services_for_type": lambda host, args: {"services": _with_type(_services(host), args)},
    "/rosapi/service_type": lambda host, args: {"type": _services(host).get(_text(args, "service"), "")},
    "/rosapi/service_providers": lambda host, args: {"providers": _providers(host, _text(args, "service"))},
    "/rosapi/service_node": lambda host, args: {"node": next(iter(_providers(host, _text(args, "service"))), "")},
    "/rosapi/nodes": lambda host, args: {"nodes": _nodes(host)},
    "/rosapi/node_details": _node_details,
    "/rosapi/action_servers": lambda host, args: {"action_servers": _action_servers(host)},
    "/rosapi/publishers": lambda host, args: {
        "publishers": _endpoints(host.node.get_publishers_info_by_topic(_text(args, "topic") or "/"))
    },
    "/rosapi/subscribers": lambda host, args: {
        "subscribers": _endpoints(host.node.get_subscriptions_info_by_topic(_text(args, "topic") or "/"))
    },
    "/rosapi/message_details": lambda host, args: {"typedefs": type_details(_text(args, "type"), "msg")},
    "/rosapi/service_request_details": lambda host, args: {"typedefs": type_details(_text(args, "type"), "Request")},
    "/rosapi/service_response_details": lambda host, args: {"typedefs": type_details(_text(args, "type"), "Response")},
    "/rosapi/get_time": lambda host, args: _time(host),
    "/rosapi/get_ros_version": lambda host, args: _ros_version(),
}


# --- parameters ------------------------------------------------------------------------------------------------------


def _split(args: Mapping[str, Any]) -> tuple[str, str]:
    """The full name of a node and the name of its parameter, which clients write as `node:parameter`."""
    node, _, name = _text(args, "name").partition(":")
    return f"/{node.strip('/')}", name


def _get_param(host: Host, args: Mapping[str, Any], done: Done, client: int) -> None:
    node, name = _split(args)
    default = _text(args, "default_value")

    def finish(response: Any, _reason: str) -> None:
        value = parameter_value_to_python(response.values[0]) if response and response.values else None
        done({"value": json.dumps(value, default=list) if value is not None else default or "null"})

    _ask(host, GetParameters, f"{node}/get_parameters", GetParameters.Request(names=[name]), finish, client)


def _has_param(host: Host, args: Mapping[str, Any], done: Done, client: int) -> None:
    node, name = _split(args)

    def finish(response: Any, _reason: str) -> None:
        done({"exists": bool(response and response.values and response.values[0].type)})

    _ask(host, GetParameters, f"{node}/get_parameters", GetParameters.Request(names=[name]), finish, client)


def _set_param(host: Host, args: Mapping[str, Any], done: Done, client: int) -> None:
    node, name = _split(args)
    try:
        message = Parameter(name, value=json.loads(_text(args, "value"))).to_parameter_msg()
        refusal = parameter_refusal(name, message.value.string_value)
    except (ValueError, TypeError, AttributeError) as error:
        message, refusal = ParameterMessage(), f"args.value: expected a parameter in JSON: {error}"
    if refusal:
        done(f"{_PREFIX}set_param: {name}: {refusal}")
        return

    def finish(response: Any, reason: str) -> None:
        result = response.results[0] if response and response.results else None
        is_set = result is not None and result.successful
        done({} if is_set else f"{_PREFIX}set_param: {name}: {reason if result is None else result.reason}")

    _ask(host, SetParameters, f"{node}/set_parameters", SetParameters.Request(parameters=[message]), finish, client)


def _get_param_names(host: Host, args: Mapping[str, Any], done: Done, client: int) -> None:
    end = "/list_parameters"
    nodes = [name.removesuffix(end) for name in _services(host) if name.endswith(end)]
    names: dict[str, list[str]] = {}

    def finish(node: str, response: Any, _reason: str) -> None:
        names[node] = [] if response is None else [f"{node}:{name}" for name in response.result.names]
        if len(names) == len(nodes):
            done({"names": [name for node in nodes for name in names[node]]})

    for node in nodes:
        request = ListParameters.Request()
        _ask(host, ListParameters, node + end, request, partial(finish, node), client)
    if not nodes:
        done({"names": []})


def _ask(host: Host, kind: Any, name: str, request: Any, done: Callable[[Any, str], None], client: int) -> None:
    """Call a service of a node, if there is one of this name."""
    if host.node.count_services(name):
        host.calls.call(kind, name, request, done, sender=client)
    else:
        done(None, f"no service {name}")


_CALLS: Mapping[str, Callable[[Host, Mapping[str, Any], Done, int], None]] = {
    "/rosapi/get_param": _get_param,
    "/rosapi/has_param": _has_param,
    "/rosapi/set_param": _set_param,
    "/rosapi/get_param_names": _get_param_names,
    "/rosapi/delete_param": lambda host, args, done, client: done(
        f"{_PREFIX}delete_param: parameters of ROS 2 cannot be deleted by others"
    ),
}
