"""Services of the ROS graph as services of the bridge; responses have the encoding of the request, CDR or JSON."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rclpy._rclpy_pybind11 import RMWError
from rclpy.node import Node
from rclpy.serialization import deserialize_message, serialize_message

from thymio_sim_ros.bridge.protocol.constants import CDR, JSON, StatusLevel
from thymio_sim_ros.bridge.protocol.messages import (
    Service,
    ServiceCallFailure,
    ServiceRequest,
    ServiceResponse,
    ServiceSide,
    Status,
)
from thymio_sim_ros.bridge.switchboard.events import AddServices, AnswerCall, Command, RemoveServices, SendToClient
from thymio_sim_ros.ros.foxglove import json_messages
from thymio_sim_ros.ros.foxglove.cdr_complexity import TooManyPartsError, check_parts
from thymio_sim_ros.ros.foxglove.file_access import call_refusal
from thymio_sim_ros.ros.foxglove.schemas import service_definitions
from thymio_sim_ros.ros.foxglove.service_calls import ServiceCalls
from thymio_sim_ros.ros.foxglove.types import MissingTypeError, load_type

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.messages.message_class import Message
    from thymio_sim_ros.portable_ros.messages.message_class import Service as ServiceType

__all__ = ["Services"]


@dataclass(frozen=True, slots=True)
class _OfferedService:
    service: Service
    service_type: type[ServiceType[Any, Any]]


class Services:
    """One service of the bridge for each service of the graph. Belongs to the executor's thread."""

    def __init__(self, node: Node, calls: ServiceCalls, post: Callable[[Command], None]) -> None:
        self._node = node
        self._calls = calls
        self._post = post
        self._ids = itertools.count(1)
        self._by_name: dict[str, _OfferedService] = {}
        self._by_id: dict[int, _OfferedService] = {}
        self._refused: set[str] = set()
        self._definitions: dict[str, tuple[str, str]] = {}
        """Definitions of request and response of each type that was used so far."""

    def update(self, services: Mapping[str, Sequence[str]]) -> None:
        """Add new services and remove vanished ones. `services` maps names to types, of which the first one is used."""
        gone = [name for name, offer in self._by_name.items() if offer.service.type not in services.get(name, ())]
        if gone:
            ended = [self._by_name.pop(name).service for name in gone]
            for service in ended:
                del self._by_id[service.id]
                self._calls.forget(service.name)
            self._post(RemoveServices(tuple(service.id for service in ended)))
        added = [
            offer.service
            for name, types in services.items()
            if name not in self._by_name and (offer := self._add(name, types[0])) is not None
        ]
        if added:
            self._post(AddServices(tuple(added)))

    def call(self, client: int, request: ServiceRequest) -> None:
        """Execute a call of a client; it is answered with a response or a failure."""
        offer = self._by_id.get(request.service_id)
        if offer is None:
            self.fail(client, request, f"service {request.service_id} no longer exists")
            return
        try:
            message = _decode(request, offer.service_type.Request)
        except (RMWError, json_messages.JsonMessageError, TooManyPartsError, ValueError) as error:
            self.fail(client, request, f"{offer.service.name}: cannot decode the request: {_first_line(error)}")
            return
        if refusal := call_refusal(offer.service.type, message):
            self.fail(client, request, f"{offer.service.name}: {refusal}")
            return

        def done(response: Message | None, reason: str) -> None:
            if response is None:
                self.fail(client, request, reason)
                return
            try:
                payload = json_messages.to_json(response) if request.encoding == JSON else serialize_message(response)
            except Exception as error:  # the response has a value that the encoding does not support
                self.fail(client, request, f"{offer.service.name}: cannot encode the response: {_first_line(error)}")
                return
            answer = ServiceResponse(request.service_id, request.call_id, request.encoding, payload)
            self._post(AnswerCall(client, answer, len(request.payload)))

        self._calls.call(offer.service_type, offer.service.name, message, done, sender=client)

    def _add(self, name: str, type_name: str) -> _OfferedService | None:
        try:
            service_type = load_type(type_name)
            definitions = self._definitions.get(type_name) or service_definitions(type_name)
        except MissingTypeError as error:
            if name not in self._refused:
                self._refused.add(name)
                self._node.get_logger().warning(f"service {name} is not bridged: {error}")
            return None
        self._definitions[type_name] = definitions
        request, response = (
            ServiceSide(CDR, f"{type_name}_{side}", "ros2msg", text)
            for side, text in zip(("Request", "Response"), definitions, strict=True)
        )
        offer = _OfferedService(Service(next(self._ids), name, type_name, request, response), service_type)
        self._by_name[name] = self._by_id[offer.service.id] = offer
        return offer

    def fail(self, client: int, request: ServiceRequest, text: str) -> None:
        """Answer a call with the reason why it failed."""
        # Some clients show failures, others only statuses (docs/spec/foxglove.md section 2).
        failure = ServiceCallFailure(request.service_id, request.call_id, text)
        self._post(AnswerCall(client, failure, len(request.payload)))
        self._post(SendToClient(client, Status(StatusLevel.ERROR, text)))


def _decode(request: ServiceRequest, message_type: type[Message]) -> Message:
    if request.encoding == CDR:
        check_parts(request.payload, message_type)
        return deserialize_message(request.payload, message_type)
    if request.encoding == JSON:
        return json_messages.from_json(request.payload or b"{}", message_type)
    raise ValueError(f"expected encoding {CDR} or {JSON}, found {request.encoding}")


def _first_line(error: BaseException) -> str:
    return str(error).partition("\n")[0]
