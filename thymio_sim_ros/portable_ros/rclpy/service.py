"""Services."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from thymio_sim_ros.portable_ros import ros_types
from thymio_sim_ros.portable_ros.graph.event_queue import EventQueue
from thymio_sim_ros.portable_ros.messages import cdr
from thymio_sim_ros.portable_ros.messages.message_class import Message
from thymio_sim_ros.portable_ros.rclpy.task import await_or_execute
from thymio_sim_ros.portable_ros.rclpy_parts.service_entity import ServiceDescription, ServiceEntity

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.graph.protocols import ClientEnd

__all__ = ["Service"]


class Service(ServiceEntity[Any, Any]):
    """Answers requests; each call gets a request of its own and an empty response."""

    def __init__(self, of: ServiceDescription[Any, Any], callback: Callable[..., Any]) -> None:
        super().__init__(of)
        self.callback = callback
        self._queue: EventQueue[tuple[ClientEnd, int, bytes]] = EventQueue(of.qos_profile.kept)

    def receive(self, client: ClientEnd, sequence: int, request: bytes) -> None:
        """Queue a serialized request of a client, which counts them."""
        if self._queue.put((client, sequence, request)):
            self.notify()

    def send_response(self, response: Message, header: tuple[ClientEnd, int]) -> None:
        """Answer a request. Raises TypeError for a response of another type."""
        with self._handle:
            if not isinstance(response, self.srv_type.Response):
                raise TypeError
            client, sequence = header
            data = cdr.serialize(response)
            self._report(ros_types.ServiceEventInfo.RESPONSE_SENT, client, sequence, response=response)
            client.receive(sequence, data)

    def pending(self) -> int:
        """The number of waiting requests."""
        return len(self._queue)

    def take(self) -> tuple[Callable[..., Any], tuple[Any, ...]] | None:
        """Take a request."""
        found = self._queue.get()
        if found is None:
            return None
        client, sequence, data = found
        request = cdr.deserialize(data, self.srv_type.Request)
        self._report(ros_types.ServiceEventInfo.REQUEST_RECEIVED, client, sequence, request=request)
        return self._answer, (request, (client, sequence))

    async def _answer(self, request: Message, header: tuple[ClientEnd, int]) -> None:
        response = await await_or_execute(self.callback, request, self.srv_type.Response())
        self.send_response(response, header)
