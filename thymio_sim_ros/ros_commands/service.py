"""The verbs of services."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping

from thymio_sim_ros.ros_commands.member import Member, listed, load
from thymio_sim_ros.ros_commands.values import from_yaml

__all__ = ["VERBS"]


def _list(member: Member, options: argparse.Namespace) -> None:
    member.discover()
    listed(member.services(), types=options.show_types, count=options.count, hidden=options.include_hidden)


def _type(member: Member, options: argparse.Namespace) -> None:
    service = member.find("service", options.service, member.services)
    for kind in member.services()[service]:
        print(kind)


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


VERBS: Mapping[str, Callable[[Member, argparse.Namespace], None]] = {"list": _list, "type": _type, "call": _call}
