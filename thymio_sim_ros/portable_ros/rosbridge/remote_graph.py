"""The nodes of the remote graph, which are members of the graph of this process as long as there is a connection."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple, TypeAlias

from thymio_sim_ros.portable_ros.graph.graph import Graph
from thymio_sim_ros.portable_ros.graph.protocols import ClientEnd, EndEvents, PublisherEnd, Sample, SubscriptionEnd
from thymio_sim_ros.portable_ros.rclpy.qos import QoSPolicyKind, QoSProfile
from thymio_sim_ros.portable_ros.rosbridge.descriptions import Kind, NodeDescription, RemoteEndpoint

__all__ = ["Call", "RemoteGraph", "RemoteService", "RemoteType"]


class RemoteType(NamedTuple):
    """Stands for the class of an interface; this process may not know it."""

    TYPE_NAME: str


Call: TypeAlias = Callable[["RemoteService", ClientEnd, int, bytes], None]
"""Sends the request of a client of this process to a service."""


class _NoEvents:
    """Events of remote endpoints, which matter to their own process only."""

    def report_match(self, change: int) -> None:
        """Ignore it."""

    def report_incompatible(self, policy: QoSPolicyKind) -> None:
        """Ignore it."""

    def report_other_type(self) -> None:
        """Ignore it."""


@dataclass(eq=False)
class _TopicEnd:
    """A remote publisher or subscription."""

    msg_type: Any
    topic_name: str
    context: object
    qos_profile: QoSProfile
    events: EndEvents = field(default_factory=_NoEvents)


class RemotePublisher(_TopicEnd):
    """A remote publisher. Its messages come by the transport."""

    matched: tuple[SubscriptionEnd, ...] = ()
    retained: Sequence[Sample] = ()

    def match(self, subscription: SubscriptionEnd) -> None:
        """Match a subscription of this process."""
        if subscription.context is not self.context:
            self.matched = (*self.matched, subscription)
            subscription.add_match(self)
            subscription.events.report_match(1)

    def unmatch(self, subscription: SubscriptionEnd) -> None:
        """Remove a match."""
        self.matched = tuple(one for one in self.matched if one is not subscription)


class RemoteSubscription(_TopicEnd):
    """A remote subscription. It gets messages by the transport, which carries those of all publishers."""

    matched: tuple[PublisherEnd, ...] = ()

    def add_match(self, publisher: PublisherEnd) -> None:
        """Match a publisher of this process."""
        self.matched = (*self.matched, publisher)

    def unmatch(self, publisher: PublisherEnd) -> None:
        """Remove a match."""
        self.matched = tuple(one for one in self.matched if one is not publisher)

    def receive(self, sample: Sample) -> None:
        """Need nothing: the transport has the message."""


@dataclass(eq=False)
class RemoteService:
    """A remote service."""

    srv_type: Any
    service_name: str
    context: object
    call: Call

    def receive(self, client: ClientEnd, sequence: int, request: bytes) -> None:
        """Send a request of a client of this process."""
        self.call(self, client, sequence, request)


@dataclass(eq=False)
class RemoteClient:
    """A remote client of a service."""

    srv_type: Any
    service_name: str
    context: object

    def receive(self, sequence: int, response: bytes) -> None:
        """Need nothing: responses to remote requests go to the client of the request."""


class RemoteNode:
    """A node of the remote graph."""

    def __init__(self, of: NodeDescription) -> None:
        self._name, self._namespace = of.name, of.namespace
        self.ends: dict[tuple[RemoteEndpoint, int], Any] = {}
        """The endpoints; the number distinguishes those that are equal."""

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
        return [end for (endpoint, _), end in self.ends.items() if endpoint.kind is kind]


class RemoteGraph:
    """Adds the nodes of the remote graph to the graph, and keeps them as they are there."""

    def __init__(self, graph: Graph, context: object, call: Call) -> None:
        """`context` is that of all endpoints, `call` sends requests to services."""
        self._graph, self._context, self._call = graph, context, call
        self._nodes: dict[tuple[str, str, int], RemoteNode] = {}
        self._add: dict[Kind, Callable[[Any], None]] = {
            Kind.PUBLISHER: graph.add_publisher,
            Kind.SUBSCRIPTION: graph.add_subscription,
            Kind.SERVICE: graph.add_service,
            Kind.CLIENT: graph.add_client,
        }
        self._remove: dict[Kind, Callable[[Any], None]] = {
            Kind.PUBLISHER: graph.remove_publisher,
            Kind.SUBSCRIPTION: graph.remove_subscription,
            Kind.SERVICE: graph.remove_service,
            Kind.CLIENT: graph.remove_client,
        }

    def update(self, nodes: Iterable[NodeDescription]) -> None:
        """Add, change and remove nodes, so that there are those of the descriptions."""
        seen: Counter[tuple[str, str]] = Counter()
        wanted: dict[tuple[str, str, int], NodeDescription] = {}
        for one in nodes:
            seen[one.namespace, one.name] += 1
            wanted[one.namespace, one.name, seen[one.namespace, one.name]] = one
        with self._graph.lock:
            for key in [key for key in self._nodes if key not in wanted]:
                self._graph.remove_node(self._nodes[key])
                self._change(self._nodes.pop(key), ())
            for key, described in wanted.items():
                if key not in self._nodes:
                    self._nodes[key] = RemoteNode(described)
                    self._graph.add_node(self._nodes[key])
                self._change(self._nodes[key], described.endpoints)

    def is_own(self, node: object) -> bool:
        """Whether a node of the graph is a remote one."""
        return isinstance(node, RemoteNode)

    def _change(self, node: RemoteNode, endpoints: Iterable[RemoteEndpoint]) -> None:
        seen: Counter[RemoteEndpoint] = Counter()
        wanted = set()
        for endpoint in endpoints:
            seen[endpoint] += 1
            wanted.add((endpoint, seen[endpoint]))
        for key in [key for key in node.ends if key not in wanted]:
            self._remove[key[0].kind](node.ends.pop(key))
        for key in sorted(wanted - node.ends.keys(), key=repr):
            node.ends[key] = self._made(key[0])
            self._add[key[0].kind](node.ends[key])

    def _made(self, of: RemoteEndpoint) -> Any:
        kind = RemoteType(of.type_name)
        if of.kind is Kind.SERVICE:
            return RemoteService(kind, of.name, self._context, self._call)
        if of.kind is Kind.CLIENT:
            return RemoteClient(kind, of.name, self._context)
        made = RemotePublisher if of.kind is Kind.PUBLISHER else RemoteSubscription
        return made(kind, of.name, self._context, of.qos_profile)
