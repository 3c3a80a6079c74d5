"""The graph of a domain: its nodes and their endpoints, and which of them match."""

from __future__ import annotations

import threading
from collections import defaultdict
from collections.abc import Callable, Iterable
from typing import Any

from thymio_sim_ros.portable_ros.graph import time_base, waits
from thymio_sim_ros.portable_ros.graph.deadline import Deadline
from thymio_sim_ros.portable_ros.graph.protocols import (
    ClientEnd,
    GraphNode,
    PublisherEnd,
    Sample,
    ServiceEnd,
    SubscriptionEnd,
)
from thymio_sim_ros.portable_ros.graph.transport import Transport
from thymio_sim_ros.portable_ros.rclpy._rclpy_pybind11 import RCLError
from thymio_sim_ros.portable_ros.rclpy.qos import incompatibilities

__all__ = ["Graph", "forget_graph", "graph_of"]


class _Topic:
    """The endpoints of a topic."""

    def __init__(self) -> None:
        self.publishers: list[PublisherEnd] = []
        self.subscriptions: list[SubscriptionEnd] = []


class Graph:
    """Nodes and endpoints. Thread-safe: `lock` guards all, and `changed` is notified of each change."""

    def __init__(self, domain_id: int) -> None:
        self.domain_id = domain_id
        self.lock = threading.RLock()
        self._changed = threading.Condition(self.lock)
        self.nodes: list[GraphNode] = []
        self.topics: defaultdict[str, _Topic] = defaultdict(_Topic)
        self.services: defaultdict[str, list[ServiceEnd]] = defaultdict(list)
        self.clients: defaultdict[str, list[ClientEnd]] = defaultdict(list)
        self._transport: Transport | None = None

    @property
    def is_carried(self) -> bool:
        """Whether a transport delivers all messages of topics."""
        return self._transport is not None and self._transport.is_connected

    def attach(self, transport: Transport | None) -> None:
        """Connect the graph with another one by a transport; None ends that."""
        with self._changed:
            self._transport = transport
            self._note_change()

    def carry(self, publisher: PublisherEnd, sample: Sample) -> bool:
        """Send a message by the transport; return whether it delivers the message to all subscriptions."""
        return self._transport is not None and self._transport.publish(publisher, sample)

    def wait_for(self, condition: Callable[[], bool], timeout_s: float | None, what: str) -> bool:
        """Wait until a condition of the graph is true; return whether it is. `what` names what is waited for."""
        deadline = Deadline(timeout_s)
        with waits.named(what, timeout_s), self._changed:
            return self._changed.wait_for(lambda: time_base.own_query(condition), deadline.left_s())

    def notify(self) -> None:
        """Wake all waits, since something has changed."""
        with self._changed:
            self._changed.notify_all()

    def add_node(self, node: GraphNode) -> None:
        """Add a node."""
        with self._changed:
            self.nodes.append(node)
            self._note_change()

    def remove_node(self, node: GraphNode) -> None:
        """Remove a node."""
        with self._changed:
            if node in self.nodes:
                self.nodes.remove(node)
            self._note_change()

    def require_topic_type(self, name: str, msg_type: Any, context: object) -> None:
        """Raise RCLError if a context uses the topic with another type: a participant of DDS has one for each."""
        with self.lock:
            topic = self.topics.get(name) or _Topic()
            found = [one.msg_type for one in topic.publishers if one.context is context]
            found += [one.msg_type for one in topic.subscriptions if one.context is context]
        _require_one_type(name, msg_type, found)

    def require_service_type(self, name: str, srv_type: Any, context: object) -> None:
        """Raise RCLError if a context uses the service with another type."""
        with self.lock:
            found = [one.srv_type for one in self.services.get(name, ()) if one.context is context]
            found += [one.srv_type for one in self.clients.get(name, ()) if one.context is context]
        _require_one_type(name, srv_type, found)

    def add_publisher(self, publisher: PublisherEnd) -> None:
        """Add a publisher and match it with all subscriptions."""
        with self._changed:
            topic = self.topics[publisher.topic_name]
            topic.publishers.append(publisher)
            for subscription in topic.subscriptions:
                self._meet(publisher, subscription)
            self._note_change()

    def remove_publisher(self, publisher: PublisherEnd) -> None:
        """Remove a publisher."""
        with self._changed:
            topic = self.topics[publisher.topic_name]
            if publisher in topic.publishers:
                topic.publishers.remove(publisher)
                for subscription in publisher.matched:
                    subscription.unmatch(publisher)
            self._forget(publisher.topic_name)

    def add_subscription(self, subscription: SubscriptionEnd) -> None:
        """Add a subscription and match it with all publishers."""
        with self._changed:
            topic = self.topics[subscription.topic_name]
            topic.subscriptions.append(subscription)
            for publisher in topic.publishers:
                self._meet(publisher, subscription)
            self._note_change()

    def remove_subscription(self, subscription: SubscriptionEnd) -> None:
        """Remove a subscription."""
        with self._changed:
            topic = self.topics[subscription.topic_name]
            if subscription in topic.subscriptions:
                topic.subscriptions.remove(subscription)
                for publisher in subscription.matched:
                    publisher.unmatch(subscription)
            self._forget(subscription.topic_name)

    def add_service(self, service: ServiceEnd) -> None:
        """Add a service."""
        with self._changed:
            self.services[service.service_name].append(service)
            self._note_change()

    def remove_service(self, service: ServiceEnd) -> None:
        """Remove a service."""
        with self._changed:
            if service in self.services[service.service_name]:
                self.services[service.service_name].remove(service)
            self._note_change()

    def add_client(self, client: ClientEnd) -> None:
        """Add a client."""
        with self._changed:
            self.clients[client.service_name].append(client)
            self._note_change()

    def remove_client(self, client: ClientEnd) -> None:
        """Remove a client."""
        with self._changed:
            if client in self.clients[client.service_name]:
                self.clients[client.service_name].remove(client)
            self._note_change()

    def services_for(self, client: ClientEnd) -> list[ServiceEnd]:
        """The services that a client calls."""
        with self.lock:
            wanted = client.srv_type.TYPE_NAME
            return [one for one in self.services[client.service_name] if wanted == one.srv_type.TYPE_NAME]

    def _meet(self, publisher: PublisherEnd, subscription: SubscriptionEnd) -> None:
        """Match two endpoints of a topic, or report to both why they do not match."""
        wanted, offered = publisher.msg_type.TYPE_NAME, subscription.msg_type.TYPE_NAME
        if wanted != offered:
            # A topic may have two types on purpose: an endpoint with a peer of its own type gets no event.
            topic = self.topics[publisher.topic_name]
            if all(wanted != one.msg_type.TYPE_NAME for one in topic.subscriptions):
                publisher.events.report_other_type()
            if all(offered != one.msg_type.TYPE_NAME for one in topic.publishers):
                subscription.events.report_other_type()
            return
        wrong = incompatibilities(publisher.qos_profile, subscription.qos_profile)
        if wrong:
            publisher.events.report_incompatible(wrong[-1][0])
            subscription.events.report_incompatible(wrong[-1][0])
        else:
            publisher.match(subscription)

    def _note_change(self) -> None:
        self._changed.notify_all()
        if self._transport is not None:
            self._transport.graph_changed()

    def _forget(self, name: str) -> None:
        topic = self.topics[name]
        if not topic.publishers and not topic.subscriptions:
            del self.topics[name]
        self._note_change()


def _require_one_type(name: str, kind: Any, found: Iterable[Any]) -> None:
    for other in found:
        if other.TYPE_NAME != kind.TYPE_NAME:
            raise RCLError(f"{name} has the type {other.TYPE_NAME} in this context, not {kind.TYPE_NAME}")


def names_and_types(endpoints: Iterable[tuple[str, Any]]) -> list[tuple[str, list[str]]]:
    """Names of topics or services with all their types, sorted; `endpoints` are pairs of name and class."""
    found: defaultdict[str, set[str]] = defaultdict(set)
    for name, kind in endpoints:
        found[name].add(kind.TYPE_NAME)
    return [(name, sorted(types)) for name, types in sorted(found.items())]


_graphs: dict[int, Graph] = {}
_lock = threading.Lock()


def graph_of(domain_id: int) -> Graph:
    """The graph of a domain; one for all contexts of the process."""
    with _lock:
        return _graphs.setdefault(domain_id, Graph(domain_id))


def forget_graph(domain_id: int) -> None:
    """Let the next context of a domain have a new graph, without the nodes that are left in the present one."""
    with _lock:
        _graphs.pop(domain_id, None)
