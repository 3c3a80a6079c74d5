"""Parameters of the data source: requests for them and subscriptions to their updates."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from thymio_sim_ros.bridge.protocol.constants import StatusLevel
from thymio_sim_ros.bridge.protocol.messages import Parameter, ParameterValues, SetParameters, Status, parameter_status
from thymio_sim_ros.bridge.switchboard.client_state import ClientState
from thymio_sim_ros.bridge.switchboard.events import ParametersRequested, ParametersSet, ParametersWatched, size_of
from thymio_sim_ros.bridge.switchboard.outcome import MAX_REFUSALS, Delivery, Outcome
from thymio_sim_ros.bridge.switchboard.pending_requests import RequestKind

__all__ = ["MAX_WATCHED", "Parameters"]

MAX_WATCHED = 20_000
"""Names of parameters whose updates one client may subscribe to."""


class Parameters:
    """The current values, as reported by the data source. It decides about requests to set them."""

    def __init__(self, clients: Mapping[int, ClientState]) -> None:
        self._clients = clients
        self._parameters: dict[str, Parameter] = {}

    def update(self, parameters: Iterable[Parameter], removed: Iterable[str]) -> list[Delivery]:
        """Set current values and remove parameters; return the changes for the clients that subscribed to them."""
        changed = {item.name: item for item in parameters if self._parameters.get(item.name) != item}
        self._parameters.update(changed)
        for name in removed:
            if self._parameters.pop(name, None) is not None:
                changed[name] = Parameter(name)
        deliveries = []
        for client in self._clients.values():
            wanted = tuple(item for name, item in changed.items() if name in client.parameters)
            if wanted:
                deliveries.append(Delivery((client.id,), ParameterValues(wanted)))
        return deliveries

    def values(self, names: Iterable[str] | None, request_id: str | None) -> ParameterValues:
        """The current values of these parameters (None: of all); unknown names are left out."""
        selected = self._parameters if names is None else names
        known = (self._parameters[name] for name in selected if name in self._parameters)
        return ParameterValues(tuple(known), request_id)

    def get(self, client: ClientState, names: tuple[str, ...], request_id: str | None, outcome: Outcome) -> None:
        """Pass on a request for values. The data source answers it, because it may have to read them first."""
        event = ParametersRequested(client.id, names, request_id)
        reason = client.pending.add(RequestKind.PARAMETERS, size_of(event))
        if reason is None:
            outcome.events.append(event)
        else:
            outcome.refuse(f"parameters (request {request_id!r:.40}): {reason}")

    def set(self, client: ClientState, message: SetParameters, outcome: Outcome) -> None:
        """Pass on a request to set values."""
        event = ParametersSet(client.id, message.parameters, message.id)
        reason = client.pending.add(RequestKind.PARAMETERS, size_of(event))
        if reason is None:
            outcome.events.append(event)
            return
        names = self.refuse_set(message, reason, outcome)
        if message.id is not None:
            outcome.send(self.values(names, message.id))

    @staticmethod
    def refuse_set(message: SetParameters, reason: str, outcome: Outcome) -> list[str]:
        """Send a status for each parameter, up to `MAX_REFUSALS`; return the names of all parameters."""
        names = [item.name for item in message.parameters]
        for name in names[:MAX_REFUSALS]:
            outcome.send(Status(StatusLevel.ERROR, f"{name}: {reason}", parameter_status(name)))
        return names

    def watch(self, client: ClientState, names: tuple[str, ...], outcome: Outcome) -> None:
        """Subscribe a client to updates; a request that exceeds `MAX_WATCHED` is rejected as a whole."""
        watched = client.parameters.union(names)
        if len(watched) > MAX_WATCHED:
            outcome.refuse(f"parameters: expected at most {MAX_WATCHED} names to watch, found {len(watched)}")
            return
        client.parameters = watched
        outcome.events.append(ParametersWatched(client.id, names))

    @staticmethod
    def unwatch(client: ClientState, names: Iterable[str]) -> None:
        """Unsubscribe a client from updates. Unknown names are ignored."""
        client.parameters = client.parameters.difference(names)
