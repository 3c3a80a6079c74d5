"""The nodes of a remote graph by the services of rosapi, for servers that do not send their graph."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from typing import Any

from thymio_sim_ros.portable_ros.graph.remote_ends import Kind
from thymio_sim_ros.portable_ros.rosbridge.descriptions import NodeDescription, RemoteEndpoint
from thymio_sim_ros.portable_ros.rosbridge.operations import Operation

__all__ = ["RosapiPoll"]

_LISTS = {"nodes": "nodes", "topics": "topics", "services": "services"}
_DETAILS = {Kind.PUBLISHER: "publishing", Kind.SUBSCRIPTION: "subscribing", Kind.SERVICE: "services"}
_numbers = itertools.count(1)


class RosapiPoll:
    """One look at the graph: asks for nodes, topics and services, then for their details.

    `requests` are the operations to send; each response may add some. Without requests and without calls that are not
    answered, `nodes` are complete.
    """

    def __init__(self, service_types: dict[str, str]) -> None:
        """`service_types`: types by name that are known already; it gets those that the poll finds."""
        self.requests: list[Operation] = []
        self._open: dict[str, tuple[str, str]] = {}
        """Id of a call → its service and argument."""
        self._topic_types: dict[str, str] = {}
        self._service_types = service_types
        self._services: set[str] = set()
        self._details: dict[str, dict[str, Any]] = {}
        self.has_answers = False
        """Whether a call was successful: there is a rosapi."""
        for name in _LISTS:
            self._call(name)

    @property
    def is_done(self) -> bool:
        """Whether all calls are answered."""
        return not self._open

    def receive(self, call_id: str, values: object) -> bool:
        """Note a response, None for a failed call; return whether the call is one of this poll."""
        if call_id not in self._open:
            return False
        service, argument = self._open.pop(call_id)
        self.has_answers |= values is not None
        found = values if isinstance(values, dict) else {}
        if service == "topics":
            self._topic_types = dict(zip(_texts(found, "topics"), _texts(found, "types"), strict=False))
        elif service == "services":
            self._services = set(_texts(found, "services"))
            for name in sorted(self._services - self._service_types.keys()):
                self._call("service_type", service=name)
        elif service == "nodes":
            for name in _texts(found, "nodes"):
                self._call("node_details", node=name)
        elif service == "service_type":
            self._service_types[argument] = str(found.get("type", ""))
        elif found:
            self._details[argument] = found
        return True

    def nodes(self) -> list[NodeDescription]:
        """The nodes with those endpoints whose types are known."""
        for name in self._service_types.keys() - self._services:
            del self._service_types[name]
        return [self._node(name, details) for name, details in sorted(self._details.items())]

    def _node(self, full_name: str, details: dict[str, Any]) -> NodeDescription:
        namespace, _, name = full_name.rpartition("/")
        return NodeDescription(name, namespace or "/", tuple(self._endpoints(details)))

    def _endpoints(self, details: dict[str, Any]) -> Iterator[RemoteEndpoint]:
        for kind, key in _DETAILS.items():
            types = self._service_types if kind is Kind.SERVICE else self._topic_types
            for name in _texts(details, key):
                if types.get(name):
                    yield RemoteEndpoint(kind, name, types[name])

    def _call(self, rosapi: str, **arguments: str) -> None:
        call_id = f"rosapi{next(_numbers)}"
        self._open[call_id] = (rosapi, next(iter(arguments.values()), ""))
        self.requests.append({"op": "call_service", "id": call_id, "service": f"/rosapi/{rosapi}", "args": arguments})


def _texts(values: dict[str, Any], key: str) -> list[str]:
    found = values.get(key)
    return [one for one in found if isinstance(one, str)] if isinstance(found, list) else []
