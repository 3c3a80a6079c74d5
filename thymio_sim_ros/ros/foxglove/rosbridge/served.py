"""Services that clients serve."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

from rclpy._rclpy_pybind11 import RCLError

from thymio_sim_ros.bridge.rosbridge.frames import Operation
from thymio_sim_ros.ros.foxglove.rosbridge.client_node import ClientNode
from thymio_sim_ros.ros.foxglove.rosbridge.host import RefusedError
from thymio_sim_ros.ros.foxglove.rosbridge.outbox import Outbox
from thymio_sim_ros.ros.foxglove.rosbridge.values import Compression, from_message, to_message
from thymio_sim_ros.ros.rclpy_ext.deferred_service import create_deferred_service

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.messages.message_class import Message

__all__ = ["MAX_WAITING", "ServedService"]

MAX_WAITING = 64
"""Requests of one service that wait for the client; the oldest is given up for a further one."""


class ServedService:
    """A service whose requests are sent to a client, as `call_service`, and answered by its `service_response`."""

    def __init__(
        self,
        outbox: Outbox,
        place: ClientNode,
        service: str,
        kind: Any,
        compression: Compression,
        shown: dict[str, Any],
        numbers: Iterator[int],
    ) -> None:
        """`shown` are the fields by which the client knows the service. Raises RefusedError."""
        self._outbox, self._place, self._kind = outbox, place, kind
        self.service = service
        self._compression, self._shown = compression, shown
        self._numbers = numbers
        self._waiting: dict[str, Callable[[Message], None]] = {}
        try:
            self._server = create_deferred_service(place.publisher, kind, service, self._receive)
        except (RCLError, TypeError, AttributeError) as error:
            raise RefusedError(f"advertise_service.type: {error}".partition("\n")[0]) from error

    def _receive(self, request: Message, respond: Callable[[Message], None]) -> None:
        request_id = f"service_request:{self._shown['service']}:{next(self._numbers)}"
        if len(self._waiting) >= MAX_WAITING:
            del self._waiting[next(iter(self._waiting))]
            self._outbox.status("warning", f"{self._shown['service']}: more than {MAX_WAITING} requests wait")
        self._waiting[request_id] = respond
        args = from_message(request, self._compression)
        self._outbox.send({"op": "call_service", "id": request_id, **self._shown, "args": args}, self._compression)

    def has(self, request_id: str) -> bool:
        """Whether a request waits for its response."""
        return request_id in self._waiting

    def respond(self, operation: Operation) -> None:
        """Answer a request that waits. Raises ValueRefusedError; the request then goes on waiting."""
        response = to_message(operation.get("values"), self._kind.Response, "service_response.values")
        self._waiting.pop(str(operation["id"]))(response)

    def close(self) -> None:
        """End the service; its requests are not answered."""
        self._waiting.clear()
        self._place.publisher.destroy_service(self._server)
