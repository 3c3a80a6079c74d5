"""What the parts of the room need of each other, so that none imports a part that imports it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any, NamedTuple, Protocol

from thymio_sim_ros.portable_ros.rclpy.qos import QoSPolicyKind, QoSProfile


class Sample(NamedTuple):
    """A serialized message: when it was published, in ns of wall time, and which one of its publisher it is."""

    data: bytes
    source_timestamp: int
    sequence_number: int


class EndEvents(Protocol):
    """Events of a publisher or a subscription."""

    def report_match(self, change: int) -> None:
        """Report a match (1) or its end (-1)."""

    def report_incompatible(self, policy: QoSPolicyKind) -> None:
        """Report an endpoint that does not fit because of a policy."""

    def report_other_type(self) -> None:
        """Report an endpoint that has another type."""

    def report_liveliness(self, alive: int, not_alive: int) -> None:
        """Report changes of the numbers of publishers that are alive and that are not, to a subscription."""


class SubscriptionEnd(Protocol):
    """A subscription."""

    msg_type: Any
    qos_profile: QoSProfile

    @property
    def context(self) -> object:
        """The context of the node."""

    @property
    def topic_name(self) -> str:
        """The full name of the topic."""

    @property
    def events(self) -> EndEvents:
        """The events."""

    @property
    def matched(self) -> Iterable[PublisherEnd]:
        """The publishers."""

    def add_match(self, publisher: PublisherEnd) -> None:
        """Expect messages of a publisher."""

    def unmatch(self, publisher: PublisherEnd) -> None:
        """Expect no more messages of a publisher."""

    def receive(self, sample: Sample) -> None:
        """Queue a serialized message."""


class PublisherEnd(Protocol):
    """A publisher."""

    msg_type: Any
    qos_profile: QoSProfile

    @property
    def retained(self) -> Sequence[Sample]:
        """The messages that late subscriptions get."""

    @property
    def context(self) -> object:
        """The context of the node."""

    @property
    def topic_name(self) -> str:
        """The full name of the topic."""

    @property
    def events(self) -> EndEvents:
        """The events."""

    @property
    def matched(self) -> Iterable[SubscriptionEnd]:
        """The subscriptions."""

    def match(self, subscription: SubscriptionEnd) -> None:
        """Send messages to a subscription from now on."""

    def unmatch(self, subscription: SubscriptionEnd) -> None:
        """Send no more messages to a subscription."""


class ClientEnd(Protocol):
    """A client of a service."""

    srv_type: Any

    @property
    def context(self) -> object:
        """The context of the node."""

    @property
    def service_name(self) -> str:
        """The full name of the service."""

    def receive(self, sequence: int, response: bytes) -> None:
        """Queue a serialized response."""


class ServiceEnd(Protocol):
    """A service."""

    srv_type: Any

    @property
    def context(self) -> object:
        """The context of the node."""

    @property
    def service_name(self) -> str:
        """The full name."""

    def receive(self, client: ClientEnd, sequence: int, request: bytes) -> None:
        """Queue a serialized request."""


class TimerEnd(Protocol):
    """A timer whose clock was set."""

    def time_was_set(self) -> None:
        """Plan the next call."""


class TaskCreator(Protocol):
    """An executor, as futures need it."""

    def create_task(self, callback: Callable[..., Any], *args: Any) -> Any:
        """Run a callback."""


class Scheduler(Protocol):
    """The executor that has handed a task out."""

    def resume(self, task: Any) -> None:
        """Run a task again."""

    def turn_ended(self, task: Any) -> None:
        """Called when a task has run, until it was done or waits."""


class GraphNode(Protocol):
    """A node, as the graph knows it."""

    @property
    def all_publishers(self) -> Iterable[PublisherEnd]:
        """The publishers, with those of the log and of actions."""

    @property
    def all_subscriptions(self) -> Iterable[SubscriptionEnd]:
        """The subscriptions, with those of actions."""

    @property
    def all_services(self) -> Iterable[ServiceEnd]:
        """The services, with those of actions."""

    @property
    def all_clients(self) -> Iterable[ClientEnd]:
        """The clients, with those of actions."""

    def get_name(self) -> str:
        """The name."""

    def get_namespace(self) -> str:
        """The namespace."""

    def get_fully_qualified_name(self) -> str:
        """Namespace and name."""
