"""What the graph has: polled, because ROS does not report changes, within a share of the thread's time."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from rclpy.node import Node

from thymio_sim_ros.bridge.protocol.connection_graph import ConnectionGraph
from thymio_sim_ros.ros.foxglove.graph import (
    connection_graph,
    is_parameter_service,
    services_with_servers,
    visible,
    visible_topics,
)
from thymio_sim_ros.ros.foxglove.time_share import TimeShare

__all__ = ["SHARE", "Discovery", "Filters", "Found"]

SHARE = 0.02
"""Largest share of the thread's time for queries of the graph, which take 12 ms with twenty robots. The same share
applies to queries of the publishers of subscribed topics, and to the connection graph."""

Names = Mapping[str, Sequence[str]]
"""Types of topics or services, by name."""


@dataclass(frozen=True, slots=True)
class Filters:
    """What is offered to clients: topics and services by name, and hidden ones."""

    is_topic: Callable[[str], bool]
    is_service: Callable[[str], bool]
    hidden: bool


@dataclass(frozen=True, slots=True)
class Found:
    """Topics and services that are offered."""

    topics: Names
    services: Names


class Discovery:
    """Follows the graph of a node. Only for the thread of its executor."""

    def __init__(self, node: Node, filters: Filters, send: Callable[[ConnectionGraph], None]) -> None:
        """`send` gets the connection graph whenever it may have changed, while it is wanted."""
        self._node, self._filters, self._send = node, filters, send
        self._query_share, self._connections_share = TimeShare(SHARE), TimeShare(SHARE)
        self._seen: tuple[Names, Names] = ({}, {})
        self._offered: tuple[tuple[str, ...], tuple[str, ...]] = ((), ())
        self._is_wanted, self._is_outdated = False, True

    @property
    def services(self) -> Names:
        """All services of the graph that have a server."""
        return self._seen[1]

    def poll(self) -> Found | None:
        """Query the graph; None if that is not due yet, or if nothing has changed."""
        if self._is_wanted and self._is_outdated:
            self._send_connections()
        if not self._query_share.is_due:
            return None
        with self._query_share.work():
            topics, services = dict(self._node.get_topic_names_and_types()), services_with_servers(self._node)
        if (topics, services) == self._seen:
            return None
        self._seen = (topics, services)
        hidden = self._filters.hidden
        shown = visible_topics(topics, self._filters.is_topic, hidden=hidden)
        offered = visible(services, self._filters.is_service, hidden=hidden)
        if not hidden:
            offered = {name: types for name, types in offered.items() if not is_parameter_service(name)}
        self._offered = (tuple(shown), tuple(offered))
        return Found(shown, offered)

    def want_connections(self, *, wanted: bool) -> None:
        """Send the connection graph from now on, or no more."""
        self._is_wanted, self._is_outdated = wanted, True
        if wanted:
            self._send_connections()

    def mark_outdated(self) -> None:
        """Note that nodes may have connected."""
        self._is_outdated = True

    def _send_connections(self) -> None:
        """Send the connection graph, unless it has used up its share of time."""
        if self._connections_share.is_due:
            self._is_outdated = False
            with self._connections_share.work():
                self._send(connection_graph(self._node, *self._offered))
