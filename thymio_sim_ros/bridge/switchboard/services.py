"""Services of the data source and calls of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from thymio_sim_ros.bridge.protocol.messages import AdvertiseServices, Service, ServiceCallFailure, ServiceRequest
from thymio_sim_ros.bridge.switchboard.client_state import ClientState
from thymio_sim_ros.bridge.switchboard.events import ServiceCalled, size_of
from thymio_sim_ros.bridge.switchboard.outcome import Outcome
from thymio_sim_ros.bridge.switchboard.pending_requests import RequestKind

__all__ = ["Services"]


class Services:
    """The services that clients can call."""

    def __init__(self, is_read_only: Callable[[str], bool]) -> None:
        """`is_read_only` says by name which services change nothing."""
        self._is_read_only = is_read_only
        self._services: dict[int, Service] = {}
        self._advertisement: AdvertiseServices | None = None
        """All services for new clients, None after a change."""

    @property
    def advertisement(self) -> AdvertiseServices:
        """All services; the same object until they change, so that its encoding can be cached."""
        if self._advertisement is None:
            self._advertisement = AdvertiseServices(tuple(self._services.values()))
        return self._advertisement

    def add(self, services: Iterable[Service]) -> None:
        """Add services."""
        self._advertisement = None
        self._services.update((service.id, service) for service in services)

    def remove(self, service_ids: Iterable[int]) -> None:
        """Remove services. Unknown IDs are ignored."""
        self._advertisement = None
        for service_id in service_ids:
            self._services.pop(service_id, None)

    def is_change(self, request: ServiceRequest) -> bool:
        """Whether a call may change something, so that read-only clients may not make it."""
        service = self._services.get(request.service_id)
        return service is not None and not self._is_read_only(service.name)

    def call(self, client: ClientState, request: ServiceRequest, outcome: Outcome) -> None:
        """Pass on a call; one of an unknown service or above the limits fails immediately."""
        event = ServiceCalled(client.id, request)
        service = self._services.get(request.service_id)
        if service is None:
            self.fail(request, f"no service {request.service_id}", outcome)
            return
        reason = client.pending.add(RequestKind.CALL, size_of(event))
        if reason is None:
            outcome.events.append(event)
        else:
            self.fail(request, f"{service.name}: {reason}", outcome)

    @staticmethod
    def fail(request: ServiceRequest, reason: str, outcome: Outcome) -> None:
        """Answer a call with a failure, and a status for clients that do not show failures."""
        outcome.send(ServiceCallFailure(request.service_id, request.call_id, reason))
        outcome.refuse(reason)
