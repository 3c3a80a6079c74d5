"""The verbs of services."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Mapping
from typing import Any

from thymio_sim_ros.ros_commands.member import Member, find_by_type, listed, load, print_types
from thymio_sim_ros.ros_commands.node import split
from thymio_sim_ros.ros_commands.topic import echoed, recorded
from thymio_sim_ros.ros_commands.values import from_yaml

__all__ = ["VERBS"]

_EVENTS = "/_service_event"
"""End of the name of the topic with the events of a service."""
_KINDS = ("REQUEST_SENT", "REQUEST_RECEIVED", "RESPONSE_SENT", "RESPONSE_RECEIVED")
"""The kinds of events (service_msgs/msg/ServiceEventInfo), in the order of their numbers."""


def _list(member: Member, options: argparse.Namespace) -> None:
    member.discover()
    listed(member.services(), types=options.show_types, count=options.count, hidden=options.include_hidden)


def _type(member: Member, options: argparse.Namespace) -> None:
    print_types(member, "service", options.service, member.services)


def _info(member: Member, options: argparse.Namespace) -> None:
    service, kind = member.find_type("service", options.service, member.services)
    member.discover()
    print(f"Type: {kind}")
    for role, of_node in (
        ("Clients", member.node.get_client_names_and_types_by_node),
        ("Services", member.node.get_service_names_and_types_by_node),
    ):
        print(f"{role} count: {sum(service in dict(of_node(*split(one))) for one in member.nodes())}")


def _find(member: Member, options: argparse.Namespace) -> None:
    find_by_type(member, options, "srv", member.services)


def _call(member: Member, options: argparse.Namespace) -> None:
    name, kind = load(options.type, "srv")
    request = from_yaml(options.values, kind.Request, member.node)
    service = member.find("service", options.service, member.services)
    member.check_type("service", service, name, member.services)
    client = member.node.create_client(kind, service)
    if not client.service_is_ready():
        print("waiting for service to become available...", flush=True)
        member.spin_until(client.service_is_ready)
    print(f"requester: making request: {request!r}\n", flush=True)
    response = member.result(client.call_async(request), service)
    print(f"response:\n{response!r}\n")


def _echo(member: Member, options: argparse.Namespace) -> None:
    if options.type is None:
        service, name = member.find_type("service", options.service, member.services)
    else:
        name, _ = load(options.type, "srv")
        service = member.check_type("service", options.service, name, member.services)
    topic = service + _EVENTS

    def show(event: Any) -> None:
        number = event.info.event_type
        print(
            echoed(event, options).replace(f"event_type: {number}\n", f"event_type: {_KINDS[number]}\n", 1), flush=True
        )

    member.node.create_subscription(load(name, "srv")[1].Event, topic, show, recorded(member, topic))
    if not member.wait(lambda: member.node.count_publishers(topic)):
        print(
            f"{service} reports no requests yet: neither its server nor a client has called configure_introspection",
            file=sys.stderr,
            flush=True,
        )
    member.spin_until(lambda: False)


VERBS: Mapping[str, Callable[[Member, argparse.Namespace], None]] = {
    "list": _list,
    "type": _type,
    "info": _info,
    "find": _find,
    "call": _call,
    "echo": _echo,
}
