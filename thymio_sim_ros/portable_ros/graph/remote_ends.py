"""Nodes and endpoints of other processes, which a transport or a link makes members of the graph of this process."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import Enum
from typing import Any, NamedTuple, Protocol

from thymio_sim_ros.portable_ros.graph.graph import Graph
from thymio_sim_ros.portable_ros.graph.protocols import ClientEnd, EndEvents, PublisherEnd, Sample, SubscriptionEnd
from thymio_sim_ros.portable_ros.rclpy.qos import QoSPolicyKind, QoSProfile

__all__ = ["ENDS", "Carrier", "Kind", "RemoteEnd", "RemoteNode"]


class Kind(Enum):
    """Kinds of endpoints."""

    PUBLISHER = "publisher"
    SUBSCRIPTION = "subscription"
    SERVICE = "service"
    CLIENT = "client"


class Carrier(Protocol):
    """Sends what remote endpoints get to their own process."""

    def send_message(self, subscription: RemoteEnd, sample: Sample) -> None:
        """Send a message to a subscription."""

    def send_request(self, service: RemoteEnd, client: ClientEnd, sequence: int, request: bytes) -> None:
        """Send the request of a client of this process to a service."""

    def send_response(self, client: RemoteEnd, sequence: int, response: bytes) -> None:
        """Send the response to a request of a client."""


class _Type(NamedTuple):
    """Stands for the class of a type, which only the processes that use it load."""

    TYPE_NAME: str


class _NoEvents:
    """Events of remote endpoints: their own process has them."""

    def report_match(self, change: int) -> None:
        """Ignore it."""

    def report_incompatible(self, policy: QoSPolicyKind) -> None:
        """Ignore it."""

    def report_other_type(self) -> None:
        """Ignore it."""

    def report_liveliness(self, alive: int, not_alive: int) -> None:
        """Ignore it."""


@dataclass(eq=False)
class RemoteEnd:
    """An endpoint of another process. Its context is the carrier, so that both processes may use different types."""

    key: Any
    """By which the carrier knows it."""
    name: str
    type_name: str
    qos_profile: QoSProfile
    context: Carrier
    matched: tuple[Any, ...] = ()
    events: EndEvents = field(default_factory=_NoEvents)
    msg_type: Any = None
    srv_type: Any = None

    def __post_init__(self) -> None:
        """Stand for an endpoint of a topic or of a service."""
        self.msg_type = self.srv_type = _Type(self.type_name)

    @property
    def topic_name(self) -> str:
        """The full name of the topic."""
        return self.name

    @property
    def service_name(self) -> str:
        """The full name of the service."""
        return self.name

    def unmatch(self, other: object) -> None:
        """Remove a match."""
        self.matched = tuple(one for one in self.matched if one is not other)


class _RemotePublisher(RemoteEnd):
    """A publisher. Its messages come by the carrier."""

    retained: Sequence[Sample] = ()

    def match(self, subscription: SubscriptionEnd) -> None:
        """Note a subscription of this process, or of one behind another carrier."""
        if subscription.context is not self.context:
            self.matched = (*self.matched, subscription)
            subscription.add_match(self)
            subscription.events.report_match(1)


class _RemoteSubscription(RemoteEnd):
    def add_match(self, publisher: PublisherEnd) -> None:
        """Note a publisher."""
        self.matched = (*self.matched, publisher)

    def receive(self, sample: Sample) -> None:
        """Send a message to its process."""
        self.context.send_message(self, sample)


class _RemoteService(RemoteEnd):
    def receive(self, client: ClientEnd, sequence: int, request: bytes) -> None:
        """Send a request to its process."""
        self.context.send_request(self, client, sequence, request)


class _RemoteClient(RemoteEnd):
    def receive(self, sequence: int, response: bytes) -> None:
        """Send a response to its process."""
        self.context.send_response(self, sequence, response)


ENDS: dict[Kind, type[RemoteEnd]] = {
    Kind.PUBLISHER: _RemotePublisher,
    Kind.SUBSCRIPTION: _RemoteSubscription,
    Kind.SERVICE: _RemoteService,
    Kind.CLIENT: _RemoteClient,
}
"""The classes of remote endpoints."""


class RemoteNode:
    """A node of another process, with its endpoints by key."""

    def __init__(self, name: str, namespace: str, context: Carrier, graph: Graph) -> None:
        self._name, self._namespace, self.context, self._graph = name, namespace, context, graph
        self.ends: dict[Any, RemoteEnd] = {}
        graph.add_node(self)

    def add(self, kind: Kind, key: Any, name: str, type_name: str, qos_profile: QoSProfile) -> RemoteEnd:
        """Add an endpoint to the graph."""
        end = self.ends[key] = ENDS[kind](key, name, type_name, qos_profile, self.context)
        getattr(self._graph, f"add_{kind.value}")(end)
        return end

    def remove(self, key: Any) -> None:
        """Remove an endpoint from the graph."""
        end = self.ends.pop(key)
        kind = next(kind for kind, of in ENDS.items() if isinstance(end, of))
        getattr(self._graph, f"remove_{kind.value}")(end)

    def leave(self) -> None:
        """Remove the node and its endpoints from the graph."""
        for key in list(self.ends):
            self.remove(key)
        self._graph.remove_node(self)

    @property
    def all_publishers(self) -> list[Any]:
        """The publishers."""
        return self._of(Kind.PUBLISHER)

    @property
    def all_subscriptions(self) -> list[Any]:
        """The subscriptions."""
        return self._of(Kind.SUBSCRIPTION)

    @property
    def all_services(self) -> list[Any]:
        """The services."""
        return self._of(Kind.SERVICE)

    @property
    def all_clients(self) -> list[Any]:
        """The clients."""
        return self._of(Kind.CLIENT)

    def get_name(self) -> str:
        """The name."""
        return self._name

    def get_namespace(self) -> str:
        """The namespace."""
        return self._namespace

    def get_fully_qualified_name(self) -> str:
        """Namespace and name."""
        return f"{self._namespace.rstrip('/')}/{self._name}"

    def _of(self, kind: Kind) -> list[Any]:
        return [end for end in self.ends.values() if isinstance(end, ENDS[kind])]
