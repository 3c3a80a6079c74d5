"""Nodes and endpoints of another process, as members of the embedded graph of this one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple, Protocol

from thymio_sim_ros.portable_ros.graph.protocols import ClientEnd, EndEvents, PublisherEnd, Sample, SubscriptionEnd
from thymio_sim_ros.portable_ros.rclpy.qos import QoSPolicyKind, QoSProfile

__all__ = ["ENDS", "RemoteEnd", "RemoteNode", "Sender"]


class Sender(Protocol):
    """Sends what remote endpoints get to their own process."""

    def send_message(self, subscription: int, sample: Sample) -> None:
        """Send a message to a subscription."""

    def send_request(self, service: int, client: ClientEnd, sequence: int, request: bytes) -> None:
        """Send the request of a client of this process to a service."""

    def send_response(self, client: int, sequence: int, response: bytes) -> None:
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


@dataclass(eq=False)
class RemoteEnd:
    """An endpoint of another process. Its context is the link, so that both processes may use different types."""

    number: int
    """The number by which its process knows it."""
    name: str
    type_name: str
    qos_profile: QoSProfile
    context: Any
    """The link, which is a `Sender`."""
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
    """A publisher. Its own process sends each message to the subscriptions that it matches there."""

    retained: Sequence[Sample] = ()

    def match(self, subscription: SubscriptionEnd) -> None:
        """Note a subscription."""
        self.matched = (*self.matched, subscription)
        subscription.add_match(self)
        subscription.events.report_match(1)


class _RemoteSubscription(RemoteEnd):
    def add_match(self, publisher: PublisherEnd) -> None:
        """Note a publisher."""
        self.matched = (*self.matched, publisher)

    def receive(self, sample: Sample) -> None:
        """Send a message to its process."""
        self.context.send_message(self.number, sample)


class _RemoteService(RemoteEnd):
    def receive(self, client: ClientEnd, sequence: int, request: bytes) -> None:
        """Send a request to its process."""
        self.context.send_request(self.number, client, sequence, request)


class _RemoteClient(RemoteEnd):
    def receive(self, sequence: int, response: bytes) -> None:
        """Send a response to its process."""
        self.context.send_response(self.number, sequence, response)


ENDS: dict[str, type[RemoteEnd]] = {
    "publisher": _RemotePublisher,
    "subscription": _RemoteSubscription,
    "service": _RemoteService,
    "client": _RemoteClient,
}
"""Kinds of endpoints."""


class RemoteNode:
    """A node of another process."""

    def __init__(self, name: str, namespace: str, context: object) -> None:
        """`context`: the link."""
        self._name, self._namespace, self.context = name, namespace, context
        self.ends: list[RemoteEnd] = []

    @property
    def all_publishers(self) -> list[Any]:
        """The publishers."""
        return self._of(_RemotePublisher)

    @property
    def all_subscriptions(self) -> list[Any]:
        """The subscriptions."""
        return self._of(_RemoteSubscription)

    @property
    def all_services(self) -> list[Any]:
        """The services."""
        return self._of(_RemoteService)

    @property
    def all_clients(self) -> list[Any]:
        """The clients."""
        return self._of(_RemoteClient)

    def get_name(self) -> str:
        """The name."""
        return self._name

    def get_namespace(self) -> str:
        """The namespace."""
        return self._namespace

    def get_fully_qualified_name(self) -> str:
        """Namespace and name."""
        return f"{self._namespace.rstrip('/')}/{self._name}"

    def _of(self, kind: type[RemoteEnd]) -> list[Any]:
        return [end for end in self.ends if isinstance(end, kind)]
