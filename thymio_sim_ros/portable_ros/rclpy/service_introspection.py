"""Events of services: requests and responses, as their clients and servers publish them."""

from __future__ import annotations

from enum import Enum
from typing import TYPE_CHECKING, Any, Protocol

from thymio_sim_ros.portable_ros import ros_types
from thymio_sim_ros.portable_ros.messages.message_class import Message

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.rclpy.clock import Clock
    from thymio_sim_ros.portable_ros.rclpy.qos import QoSProfile

__all__ = ["ServiceEvents", "ServiceIntrospectionState"]

_GID_BYTES = 16
_SUFFIX = "/_service_event"


class ServiceIntrospectionState(Enum):
    """What is published: nothing, facts about requests and responses, or also these themselves."""

    OFF = 0
    METADATA = 1
    CONTENTS = 2


class _Node(Protocol):
    """A node, as its services need it."""

    def create_publisher(self, msg_type: Any, topic: str, qos_profile: QoSProfile) -> Any:
        """Publish a topic."""

    def destroy_publisher(self, publisher: Any) -> bool:
        """Remove a publisher."""


class ServiceEvents:
    """Publishes the events of a client or a service while it exists."""

    def __init__(
        self,
        node: _Node,
        srv_type: Any,
        service_name: str,
        clock: Clock,
        profile: QoSProfile,
        *,
        has_contents: bool,
    ) -> None:
        self._node, self._srv_type, self._clock, self._has_contents = node, srv_type, clock, has_contents
        self._publisher = node.create_publisher(srv_type.Event, service_name + _SUFFIX, profile)
        self._publisher.is_part = True

    def publish(self, event_type: int, client: object, sequence: int, **content: Message) -> None:
        """Publish an event of a request of a client, which counts them; `content` is `request` or `response`."""
        event = self._srv_type.Event()
        event.info = ros_types.ServiceEventInfo(
            event_type=event_type,
            stamp=self._clock.now().to_msg(),
            client_gid=list(id(client).to_bytes(_GID_BYTES, "little")),
            sequence_number=sequence,
        )
        for name, message in content.items() if self._has_contents else ():
            setattr(event, name, [message])
        self._publisher.publish(event)

    def destroy(self) -> None:
        """Publish no more."""
        self._node.destroy_publisher(self._publisher)
