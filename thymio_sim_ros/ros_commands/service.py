"""The verbs of services."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping

from thymio_sim_ros.ros_commands.member import Member, find_by_type, listed, load, print_types
from thymio_sim_ros.ros_commands.node import split
from thymio_sim_ros.ros_commands.values import from_yaml

__all__ = ["VERBS"]


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


VERBS: Mapping[str, Callable[[Member, argparse.Namespace], None]] = {
    "list": _list,
    "type": _type,
    "info": _info,
    "find": _find,
    "call": _call,
}
