"""Services that answer later than their callback returns, in every executor of rclpy.

The events executor of rclpy 7 does not support coroutines as callbacks of services.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar

from rclpy.node import Node

if TYPE_CHECKING:
    from rclpy.service import Service as Server

    from thymio_sim_ros.portable_ros.messages.message_class import Message, Service

__all__ = ["create_deferred_service"]

Request = TypeVar("Request", bound="Message")
Response = TypeVar("Response", bound="Message")


class _Later:
    """What the callback returns: executors pass it to `send_response`, with the header of the request."""

    def __init__(self) -> None:
        self.header: Any = None


def create_deferred_service(
    node: Node,
    service_type: type[Service[Request, Response]],
    name: str,
    receive: Callable[[Request, Callable[[Response], None]], None],
) -> Server:
    """Create a service that calls `receive` with each request and with a function that sends the response.

    That function is called at most once, after `receive` has returned, and not after the service is destroyed.
    """

    def take(request: Request, _response: Response) -> _Later:
        later = _Later()
        receive(request, lambda response: send(response, later.header))
        return later

    def note(later: _Later, header: Any) -> None:
        later.header = header

    server: Server = node.create_service(service_type, name, take)  # type: ignore[arg-type]
    send = server.send_response
    server.send_response = note  # type: ignore[assignment, method-assign]
    return server
