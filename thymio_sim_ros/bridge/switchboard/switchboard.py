"""The switchboard: connected clients, and dispatch of their messages and of the commands of the data source.

Inputs are messages of clients and commands of the data source; outputs are deliveries to clients and events for the
data source, which the server passes on. Unknown IDs and rejected requests result in a status for that client only.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import assert_never

from thymio_sim_ros.access import Role
from thymio_sim_ros.bridge.protocol import messages as ms
from thymio_sim_ros.bridge.protocol.constants import Capability
from thymio_sim_ros.bridge.switchboard import events as ev
from thymio_sim_ros.bridge.switchboard.client_channels import ClientChannels
from thymio_sim_ros.bridge.switchboard.client_state import ClientState
from thymio_sim_ros.bridge.switchboard.graph_subscriptions import GraphSubscriptions
from thymio_sim_ros.bridge.switchboard.outcome import Delivery, Outcome
from thymio_sim_ros.bridge.switchboard.parameters import Parameters
from thymio_sim_ros.bridge.switchboard.pending_requests import RequestKind
from thymio_sim_ros.bridge.switchboard.services import Services
from thymio_sim_ros.bridge.switchboard.subscriptions import Subscriptions

__all__ = ["READ_ONLY", "Switchboard"]

READ_ONLY = "this connection is read-only: it may subscribe and read, but not change anything"

_NEEDED_CAPABILITIES: dict[type, Capability] = {
    ms.ClientAdvertise: Capability.CLIENT_PUBLISH,
    ms.ClientUnadvertise: Capability.CLIENT_PUBLISH,
    ms.ClientMessageData: Capability.CLIENT_PUBLISH,
    ms.ServiceRequest: Capability.SERVICES,
    ms.GetParameters: Capability.PARAMETERS,
    ms.SetParameters: Capability.PARAMETERS,
    ms.SubscribeParameterUpdates: Capability.PARAMETERS_SUBSCRIBE,
    ms.UnsubscribeParameterUpdates: Capability.PARAMETERS_SUBSCRIBE,
    ms.SubscribeConnectionGraph: Capability.CONNECTION_GRAPH,
    ms.UnsubscribeConnectionGraph: Capability.CONNECTION_GRAPH,
    ms.FetchAsset: Capability.ASSETS,
}
"""The capability that a message requires, by the class of the message; other messages are always accepted."""


class Switchboard:
    """State of one server: its clients, and one object for each thing that it offers them."""

    def __init__(
        self, info: ms.ServerInfo, *, is_read_only_service: Callable[[str], bool] = lambda service: False
    ) -> None:
        """`is_read_only_service` says by name which services a read-only client may call."""
        self._info = info
        self._time_ns = 0
        self._clients: dict[int, ClientState] = {}
        self.subscriptions = Subscriptions(self._clients)
        self._client_channels = ClientChannels(info.supported_encodings)
        self._services = Services(is_read_only_service)
        self._parameters = Parameters(self._clients)
        self._graph = GraphSubscriptions(self._clients)

    def join(self, client_id: int, role: Role = Role.FULL) -> list[ms.ServerMessage]:
        """Add a client; return the messages that it receives first."""
        client = self._clients[client_id] = ClientState(client_id, role)
        messages: list[ms.ServerMessage] = [self._info_for(client)]
        if Capability.TIME in self._info.capabilities:
            messages.append(ms.Time(self._time_ns))
        channels, services = self.subscriptions.advertisement, self._services.advertisement
        if channels.channels:
            messages.append(channels)
        if services.services:
            messages.append(services)
        return messages

    def leave(self, client_id: int) -> list[ev.Event]:
        """Remove a client with its subscriptions and channels; return the resulting events."""
        client = self._clients.pop(client_id)
        outcome = Outcome(client_id)
        self.subscriptions.remove_client(client, outcome)
        self._client_channels.remove_client(client, outcome)
        self._graph.unsubscribe(client, outcome)
        return outcome.events

    def receive(self, client_id: int, message: ms.ClientMessage) -> Outcome:
        """Process a message of a client."""
        client, outcome = self._clients[client_id], Outcome(client_id)
        capability = _NEEDED_CAPABILITIES.get(type(message))
        if capability is not None and capability not in self._info.capabilities:
            outcome.refuse(f"this server does not offer {capability}")
        elif client.is_read_only and self._is_change(message):
            self._refuse_change(message, outcome)
        else:
            self._dispatch(client, message, outcome)
        return outcome

    def _dispatch(self, client: ClientState, message: ms.ClientMessage, outcome: Outcome) -> None:
        match message:
            case ms.ClientMessageData():
                self._client_channels.receive(client, message.channel_id, message.payload, outcome)
            case ms.Subscribe():
                self.subscriptions.subscribe(client, message.subscriptions, outcome)
            case ms.Unsubscribe():
                self.subscriptions.unsubscribe(client, message.subscription_ids, outcome)
            case ms.ClientAdvertise():
                self._client_channels.open(client, message.channels, outcome)
            case ms.ClientUnadvertise():
                self._client_channels.close(client, message.channel_ids, outcome)
            case ms.ServiceRequest():
                self._services.call(client, message, outcome)
            case ms.GetParameters():
                self._parameters.get(client, message.parameter_names, message.id, outcome)
            case ms.SetParameters():
                self._parameters.set(client, message, outcome)
            case ms.SubscribeParameterUpdates():
                self._parameters.watch(client, message.parameter_names, outcome)
            case ms.UnsubscribeParameterUpdates():
                self._parameters.unwatch(client, message.parameter_names)
            case ms.SubscribeConnectionGraph():
                self._graph.subscribe(client, outcome)
            case ms.UnsubscribeConnectionGraph():
                self._graph.unsubscribe(client, outcome)
            case ms.FetchAsset():
                outcome.events.append(ev.AssetRequested(client.id, message.uri, message.request_id))
            case _:
                assert_never(message)

    def apply(self, command: ev.Command) -> list[Delivery]:
        """Process a command of the data source."""
        match command:
            case ev.SetTime():
                self._time_ns = command.time_ns
                return self._to_all(ms.Time(command.time_ns))
            case ev.AddChannels():
                self.subscriptions.add_channels(command.channels)
                return self._to_all(ms.Advertise(command.channels))
            case ev.RemoveChannels():
                self.subscriptions.remove_channels(command.channel_ids)
                return self._to_all(ms.Unadvertise(command.channel_ids))
            case ev.RetainLast():
                self.subscriptions.retain_last(command.channel_id, command.depth)
                return []
            case ev.ResendRetained():
                return self.subscriptions.resend_retained(self._time_ns)
            case ev.AddServices():
                self._services.add(command.services)
                return self._to_all(ms.AdvertiseServices(command.services))
            case ev.RemoveServices():
                self._services.remove(command.service_ids)
                return self._to_all(ms.UnadvertiseServices(command.service_ids))
            case ev.ParametersChanged():
                return self._parameters.update(command.parameters, command.removed)
            case ev.SendParameters():
                values = self._parameters.values(command.names, command.request_id)
                return self._answer(command.client, RequestKind.PARAMETERS, command.size, values)
            case ev.AnswerCall():
                return self._answer(command.client, RequestKind.CALL, command.size, command.message)
            case ev.SendToClient():
                is_connected = command.client in self._clients
                return [Delivery((command.client,), command.message)] if is_connected else []
            case ev.SetGraph():
                return self._graph.set_graph(command.graph)
            case ev.NewSession():
                return self._start_session(command.session_id)
            case _:
                assert_never(command)

    def _answer(self, client_id: int, kind: RequestKind, size: int, message: ms.ServerMessage) -> list[Delivery]:
        client = self._clients.get(client_id)
        if client is None:
            return []
        client.pending.remove(kind, size)
        return [Delivery((client_id,), message)]

    def _start_session(self, session_id: str) -> list[Delivery]:
        self._info = replace(self._info, session_id=session_id)
        deliveries = []
        for is_read_only in (False, True):
            clients = [client for client in self._clients.values() if client.is_read_only is is_read_only]
            if clients:
                deliveries.append(Delivery(tuple(client.id for client in clients), self._info_for(clients[0])))
        # A new session makes Lichtblick forget the types that it needs for publishing; an advertisement, also an
        # empty one, makes it read them again.
        return deliveries + self._to_all(ms.Advertise(())) + self._graph.resend()

    def _to_all(self, message: ms.ServerMessage) -> list[Delivery]:
        return [Delivery(tuple(self._clients), message)] if self._clients else []

    def _info_for(self, client: ClientState) -> ms.ServerInfo:
        """The server info for a client: without the capability to publish for a read-only one."""
        if not client.is_read_only:
            return self._info
        offered = tuple(item for item in self._info.capabilities if item != Capability.CLIENT_PUBLISH)
        metadata = {**self._info.metadata, "access": Role.READ_ONLY.value}
        return replace(self._info, capabilities=offered, metadata=metadata)

    def _is_change(self, message: ms.ClientMessage) -> bool:
        if isinstance(message, ms.ServiceRequest):
            return self._services.is_change(message)
        return isinstance(message, ms.ClientAdvertise | ms.ClientMessageData | ms.SetParameters)

    def _refuse_change(self, message: ms.ClientMessage, outcome: Outcome) -> None:
        """Report the rejection, and answer requests that expect an answer."""
        if isinstance(message, ms.ServiceRequest):
            self._services.fail(message, READ_ONLY, outcome)
        elif isinstance(message, ms.SetParameters):
            names = self._parameters.refuse_set(message, READ_ONLY, outcome)
            outcome.send(self._parameters.values(names, message.id))
        else:
            outcome.refuse(READ_ONLY)
