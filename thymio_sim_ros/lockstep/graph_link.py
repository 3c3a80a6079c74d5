"""GraphLink: one end of the connection of two embedded graphs, whose processes run in turns.

Each end puts what the other one misses into one list per turn: nodes and endpoints that are new or have gone, then
messages, requests and responses, in the order in which they were sent. Endpoints of the other process are members of
the graph (`graph/remote_ends.py`), so that matches, counts and queries need to know nothing of the link, and what
passes through several links arrives.
"""

from __future__ import annotations

import base64
import warnings
from collections.abc import Callable, Iterable
from functools import lru_cache
from typing import Any, ClassVar

from thymio_sim_ros.portable_ros.graph.graph import Graph
from thymio_sim_ros.portable_ros.graph.protocols import ClientEnd, GraphNode, PublisherEnd, Sample
from thymio_sim_ros.portable_ros.graph.remote_ends import ENDS, Kind, RemoteEnd, RemoteNode
from thymio_sim_ros.portable_ros.rclpy.duration import Duration
from thymio_sim_ros.portable_ros.rclpy.qos import QoSProfile, qos_profile_services_default

__all__ = ["Changes", "GraphLink", "LinkHub"]

Changes = list[list[Any]]
"""What one end sends in a turn, as JSON has it; the first item of each change is its kind."""

_POLICIES = ("history", "depth", "reliability", "durability", "liveliness")
_DURATIONS = ("lifespan", "deadline", "liveliness_lease_duration")


class LinkHub:
    """The transport of a graph with links: tells all of them that nodes or endpoints have changed."""

    is_connected = False
    """Messages go to remote subscriptions one by one, not by the transport."""

    def __init__(self, graph: Graph) -> None:
        self.graph = graph
        self.links: list[GraphLink] = []
        graph.attach(self)

    def graph_changed(self) -> None:
        """Note that nodes or endpoints have changed."""
        for link in self.links:
            link.has_changed = True

    def publish(self, publisher: PublisherEnd, sample: Sample) -> bool:
        """Carry nothing."""
        return False


class GraphLink:
    """One end of a link. Invariant: the other end knows what `take` has returned."""

    def __init__(self, hub: LinkHub) -> None:
        self._hub, self._graph = hub, hub.graph
        self.has_changed = True
        """Whether nodes or endpoints may have changed since the last turn."""
        self._sent: Changes = []
        self._numbers: dict[int, int] = {}
        """Numbers of local nodes and endpoints by the identity of the object."""
        self._locals: dict[int, Any] = {}
        self._last_number = 0
        self._told: set[int] = set()
        """Numbers of the local nodes and endpoints that the other end knows."""
        self._nodes: dict[int, RemoteNode] = {}
        """Remote nodes by number."""
        self._owners: dict[int, RemoteNode] = {}
        """The nodes of remote endpoints by the number of the endpoint."""
        self._is_cut = False
        hub.links.append(self)

    @property
    def has_news(self) -> bool:
        """Whether `take` would return anything."""
        return self.has_changed or bool(self._sent)

    def take(self) -> Changes:
        """What has changed since the last call."""
        changes = self._graph_changes() if self.has_changed else []
        self.has_changed = False
        sent, self._sent = self._sent, []
        return [*changes, *sent]

    def apply(self, changes: Changes) -> None:
        """Do what the other end has returned by `take`. Raises ValueError for anything else."""
        for kind, *values in changes:
            try:
                self._appliers[kind](self, *values)
            except (KeyError, TypeError, ValueError) as error:
                raise ValueError(f"found the change {[kind, *values]!r:.200}, expected one of a graph") from error

    def close(self) -> None:
        """Remove all nodes and endpoints of the other process."""
        self._hub.links.remove(self)
        for number in list(self._nodes):
            self._remove(number)
        self._sent.clear()

    def cut(self) -> None:
        """Keep nothing more for the other end. Takes no lock: a forked process may have inherited any."""
        self._is_cut = True

    # --- the carrier of remote endpoints ---

    def send_message(self, subscription: RemoteEnd, sample: Sample) -> None:
        """Send a message to a subscription."""
        self._send(["message", subscription.key, _text(sample.data), *sample[1:]])

    def send_request(self, service: RemoteEnd, client: ClientEnd, sequence: int, request: bytes) -> None:
        """Send the request of a client of this process to a service."""
        self._send(["request", service.key, self._number(client), sequence, _text(request)])

    def send_response(self, client: RemoteEnd, sequence: int, response: bytes) -> None:
        """Send the response to a request of a client."""
        self._send(["response", client.key, sequence, _text(response)])

    def _send(self, change: list[Any]) -> None:
        if not self._is_cut:
            self._sent.append(change)

    # --- what this process has ---

    def _graph_changes(self) -> Changes:
        """Nodes and endpoints that are new or have gone."""
        present: dict[int, list[Any]] = {}
        with self._graph.lock:
            for node in self._graph.nodes:
                if getattr(node, "context", None) is self:
                    continue
                owner = self._number(node)
                present[owner] = ["node", owner, node.get_name(), node.get_namespace()]
                for kind, end in _ends_of(node):
                    is_topic = kind in (Kind.PUBLISHER, Kind.SUBSCRIPTION)
                    name = end.topic_name if is_topic else end.service_name
                    of = (end.msg_type if is_topic else end.srv_type).TYPE_NAME
                    number = self._number(end)
                    present[number] = ["end", number, owner, kind.value, name, of, *_packed(end.qos_profile)]
        gone = [number for number in self._locals if number not in present]
        new = [change for number, change in present.items() if number not in self._told]
        self._told = set(present)
        for number in gone:
            del self._numbers[id(self._locals.pop(number))]
        return [*new, *(["gone", number] for number in gone)]

    def _number(self, of: object) -> int:
        number = self._numbers.get(id(of))
        if number is None:
            number = self._last_number = self._last_number + 1
            self._numbers[id(of)] = number
            self._locals[number] = of
            self.has_changed = True
        return number

    # --- what the other process has sent ---

    def _add_node(self, number: int, name: str, namespace: str) -> None:
        self._nodes[number] = RemoteNode(name, namespace, self, self._graph)

    def _add_end(self, number: int, owner: int, kind: str, name: str, type_name: str, *policies: int) -> None:
        node = self._owners[number] = self._nodes[owner]
        node.add(Kind(kind), number, name, type_name, _unpacked(policies))

    def _remove(self, number: int) -> None:
        if number in self._nodes:
            node = self._nodes.pop(number)
            for key in node.ends:
                del self._owners[key]
            node.leave()
        elif number in self._owners:
            self._owners.pop(number).remove(number)

    def _pass_message(self, subscription: int, data: str, stamp: int, count: int) -> None:
        if (end := self._locals.get(subscription)) is not None:  # it may have gone meanwhile
            end.receive(Sample(_bytes(data), stamp, count))

    def _pass_request(self, service: int, client: int, sequence: int, data: str) -> None:
        if (end := self._locals.get(service)) is not None:
            if client in self._owners:
                caller = self._owners[client].ends[client]
            else:  # a client of a node that has just gone
                caller = ENDS[Kind.CLIENT](client, end.service_name, "", qos_profile_services_default, self)
            end.receive(caller, sequence, _bytes(data))

    def _pass_response(self, client: int, sequence: int, data: str) -> None:
        if (end := self._locals.get(client)) is not None:
            end.receive(sequence, _bytes(data))

    _appliers: ClassVar[dict[str, Callable[..., None]]] = {
        "node": _add_node,
        "end": _add_end,
        "gone": _remove,
        "message": _pass_message,
        "request": _pass_request,
        "response": _pass_response,
    }


def _ends_of(node: GraphNode) -> Iterable[tuple[Kind, Any]]:
    for kind in Kind:
        for end in getattr(node, f"all_{kind.value}s"):
            yield kind, end


def _packed(profile: QoSProfile) -> list[int]:
    durations = (getattr(profile, name).nanoseconds for name in _DURATIONS)
    return [*(int(getattr(profile, name)) for name in _POLICIES), *durations]


@lru_cache(maxsize=64)
def _unpacked(policies: tuple[int, ...]) -> QoSProfile:
    values: dict[str, Any] = dict(zip((*_POLICIES, *_DURATIONS), policies, strict=True))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of a depth of 0: the process that made the profile has had it
        return QoSProfile(**values | {name: Duration(nanoseconds=values[name]) for name in _DURATIONS})


def _text(data: bytes) -> str:
    return base64.b64encode(data).decode("ascii")


def _bytes(text: str) -> bytes:
    return base64.b64decode(text)
