"""The nodes of the remote graph, which are members of the graph of this process as long as there is a connection."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable
from typing import TypeAlias

from thymio_sim_ros.portable_ros.graph.graph import Graph
from thymio_sim_ros.portable_ros.graph.protocols import ClientEnd, Sample
from thymio_sim_ros.portable_ros.graph.remote_ends import RemoteEnd, RemoteNode
from thymio_sim_ros.portable_ros.rosbridge.descriptions import NodeDescription, RemoteEndpoint

__all__ = ["Call", "RemoteGraph"]

Call: TypeAlias = Callable[[RemoteEnd, ClientEnd, int, bytes], None]
"""Sends the request of a client of this process to a service."""


class RemoteGraph:
    """Adds the nodes of the remote graph to the graph, and keeps them as they are there."""

    def __init__(self, graph: Graph, call: Call) -> None:
        self._graph, self._call = graph, call
        self._nodes: dict[tuple[str, str, int], RemoteNode] = {}

    def update(self, nodes: Iterable[NodeDescription]) -> None:
        """Add, change and remove nodes, so that there are those of the descriptions."""
        seen: Counter[tuple[str, str]] = Counter()
        wanted: dict[tuple[str, str, int], NodeDescription] = {}
        for one in nodes:
            seen[one.namespace, one.name] += 1
            wanted[one.namespace, one.name, seen[one.namespace, one.name]] = one
        with self._graph.lock:
            for key in [key for key in self._nodes if key not in wanted]:
                self._nodes.pop(key).leave()
            for key, described in wanted.items():
                if key not in self._nodes:
                    self._nodes[key] = RemoteNode(described.name, described.namespace, self, self._graph)
                _change(self._nodes[key], described.endpoints)

    def is_own(self, node: object) -> bool:
        """Whether a node of the graph is a remote one."""
        return isinstance(node, RemoteNode)

    # --- the carrier of the endpoints ---

    def send_message(self, subscription: RemoteEnd, sample: Sample) -> None:
        """Need nothing: the transport has the message."""

    def send_request(self, service: RemoteEnd, client: ClientEnd, sequence: int, request: bytes) -> None:
        """Send a request of a client of this process."""
        self._call(service, client, sequence, request)

    def send_response(self, client: RemoteEnd, sequence: int, response: bytes) -> None:
        """Need nothing: responses to remote requests go to the client of the request."""


def _change(node: RemoteNode, endpoints: Iterable[RemoteEndpoint]) -> None:
    """Give a node these endpoints; of those that are equal, each has a number."""
    seen: Counter[RemoteEndpoint] = Counter()
    wanted = set()
    for endpoint in endpoints:
        seen[endpoint] += 1
        wanted.add((endpoint, seen[endpoint]))
    for key in [key for key in node.ends if key not in wanted]:
        node.remove(key)
    for key in sorted(wanted - node.ends.keys(), key=repr):
        of = key[0]
        node.add(of.kind, key, of.name, of.type_name, of.qos_profile)
