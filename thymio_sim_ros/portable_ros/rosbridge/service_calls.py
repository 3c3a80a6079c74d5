"""Requests and responses: of clients of this process to remote services, and of remote clients to services here."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from typing import NamedTuple

from thymio_sim_ros.portable_ros.graph.protocols import ClientEnd
from thymio_sim_ros.portable_ros.graph.remote_ends import RemoteEnd
from thymio_sim_ros.portable_ros.rosbridge.local_endpoints import LocalEndpoint
from thymio_sim_ros.portable_ros.rosbridge.operations import Operation, OperationError
from thymio_sim_ros.portable_ros.rosbridge.payloads import Payloads

__all__ = ["ServiceCalls"]

_MOST_CALLS = 10_000
"""Calls whose responses are awaited; older ones are forgotten."""


class _Pending(NamedTuple):
    client: ClientEnd
    sequence: int
    response_type: str


class ServiceCalls:
    """The calls of one connection. `call` is for all threads, the rest for that of the connection."""

    def __init__(
        self,
        payloads: Payloads,
        queue: Callable[[object, Operation], None],
        report: Callable[[str], None],
    ) -> None:
        """`queue` sends an operation for an endpoint; `report` gets lines for the user."""
        self._payloads, self._queue, self._report = payloads, queue, report
        self._pending: dict[str, _Pending] = {}
        self._numbers = itertools.count(1)

    def call(self, service: RemoteEnd, client: ClientEnd, sequence: int, request: bytes) -> None:
        """Send the request of a client of this process."""
        type_name = service.type_name
        call_id = f"call{next(self._numbers)}"
        if len(self._pending) >= _MOST_CALLS:
            self._pending.pop(next(iter(self._pending)), None)
        self._pending[call_id] = _Pending(client, sequence, f"{type_name}_Response")
        operation = {
            "op": "call_service",
            "id": call_id,
            "service": service.service_name,
            "type": type_name,
            "args": self._payloads.outgoing(request, f"{type_name}_Request"),
            "timeout": 0,  # the program decides how long it waits: results of actions take their time
        }
        if self._payloads.is_serialized:
            operation["compression"] = "cbor-raw"
        self._queue(client, operation)

    def receive_response(self, operation: Operation) -> None:
        """Pass a response to its client; report a failed call. Raises OperationError."""
        pending = self._pending.pop(str(operation.get("id")), None)
        if pending is None:
            return
        if operation.get("result") is True:
            response = self._payloads.incoming(operation.get("values"), pending.response_type)
            pending.client.receive(pending.sequence, response)
        else:
            self._report(f"{operation.get('service')}: {operation.get('values')}")

    def receive_request(self, operation: Operation, service: LocalEndpoint | None) -> None:
        """Pass a request to a service of this process; None for one that there is not."""
        name = operation.get("service")
        answer = {"op": "service_response", "service": name, "id": operation.get("id")}
        if service is None:
            self._queue(self, answer | {"values": f"{name}: this program has no such service", "result": False})
            return
        try:
            request = self._payloads.incoming(operation.get("args"), f"{service.type_name}_Request")
        except OperationError as error:
            self._queue(self, answer | {"values": f"{name}: {error}", "result": False})
            return
        service.end.receive(_Caller(self, service, answer), 0, request)

    def respond(self, service: LocalEndpoint, answer: Operation, response: bytes) -> None:
        """Send the response of a service of this process."""
        values = self._payloads.outgoing(response, f"{service.type_name}_Response")
        self._queue(service.end, answer | {"values": values, "result": True})


class _Caller:
    """The client of one remote request."""

    def __init__(self, calls: ServiceCalls, service: LocalEndpoint, answer: Operation) -> None:
        self._calls, self._service, self._answer = calls, service, answer
        self.srv_type, self.service_name = service.end.srv_type, service.name
        self.context: object = calls

    def receive(self, sequence: int, response: bytes) -> None:
        """Send the response."""
        self._calls.respond(self._service, self._answer, response)
