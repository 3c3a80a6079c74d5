"""What the clients of rosbridge share: the nodes and limits of the bridge, and the names and types of the graph."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

from rclpy.node import Node

from thymio_sim_ros.bridge.protocol.constants import Capability
from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.ros.foxglove.service_calls import ServiceCalls
from thymio_sim_ros.ros.foxglove.types import MissingTypeError, full_name, load_type

__all__ = ["Host", "RefusedError"]


_MARKS = {"msg": "get_fields_and_field_types", "srv": "Request"}
"""What classes of messages and of services have."""
_WORDS = {"msg": "message", "srv": "service"}


class RefusedError(ThymioSimError):
    """An operation of a client is rejected; the text is sent to it as a status."""


@dataclass(frozen=True, slots=True)
class Host:
    """The bridge, as its clients of rosbridge see it.

    Args:
        node: The node of the bridge, for queries of the graph.
        subscriber: The node that subscribes and calls for clients; its endpoints match those of all others.
        publisher: The node that publishes and serves for clients without a node of their own.
        calls: All calls of services.
        send: Sends messages to a client; see `BridgeServer.send`.
        now_ns: The time of messages.
        wake: Requests calls of `Sessions.poll` until it returns False.
        offered: The capabilities of the server.
        max_size: The longest message of a client.
        depths: The smallest and the largest depth of a subscription.
        served: Types of the services that clients serve, which DDS may not have discovered yet.
    """

    node: Node
    subscriber: Node
    publisher: Node
    calls: ServiceCalls
    send: Callable[[int, Iterable[str | bytes], int | None], None]
    now_ns: Callable[[], int]
    wake: Callable[[], None]
    offered: Sequence[Capability]
    max_size: int
    depths: tuple[int, int]
    served: dict[str, str] = field(default_factory=dict)
    is_topic: Callable[[str], bool] = lambda name: True
    is_client_topic: Callable[[str], bool] = lambda name: True
    is_service: Callable[[str], bool] = lambda name: True
    is_read_only_service: Callable[[str], bool] = lambda name: False

    def topic_type(self, topic: str, given: str | None, where: str) -> tuple[str, Any]:
        """Name and class of the type of a topic: the one that the client gives, or that of the graph.

        Raises RefusedError.
        """
        return self._type(topic, given, "msg", where)

    def service_type(self, service: str, given: str | None, where: str) -> tuple[str, Any]:
        """Name and class of the type of a service, as `topic_type`."""
        return self._type(service, given, "srv", where)

    def _type(self, name: str, given: str | None, kind: str, where: str) -> tuple[str, Any]:
        if not given:
            query = self.node.get_topic_names_and_types if kind == "msg" else self.node.get_service_names_and_types
            given = next((types[0] for found, types in query() if found == name), self.served.get(name))
        if given is None:
            raise RefusedError(f"{where}: expected a name in the ROS graph, or a type, found {name}")
        type_name = full_name(given, kind)
        try:
            found = load_type(type_name)
        except MissingTypeError as error:
            raise RefusedError(f"{where}: {error}") from error
        if not hasattr(found, _MARKS[kind]):
            raise RefusedError(f"{where}: expected the type of a {_WORDS[kind]}, found {type_name}")
        return type_name, found
