"""The switchboard: the state and all decisions of the bridge, without sockets, clocks or threads.

Inputs are messages of clients and commands of the data source; outputs are deliveries to clients and events for the
data source, which the server passes on. Unknown IDs and rejected requests result in a status for that client only.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from typing import Any

from thymio_sim_ros.bridge import events as ev
from thymio_sim_ros.bridge import messages as ms
from thymio_sim_ros.bridge.access import Role
from thymio_sim_ros.bridge.client_state import ClientState
from thymio_sim_ros.bridge.constants import Capability, StatusLevel
from thymio_sim_ros.bridge.graph import ConnectionGraph

MAX_CLIENT_CHANNELS = 256
"""Channels that one client may open: each may need a publisher."""

MAX_ALL_CLIENT_CHANNELS = 512
"""Channels that all clients together may open."""

MAX_CALLS = 64
"""Service calls of one client that may wait for their answers."""

MAX_PARAMETER_REQUESTS = 64
"""Requests of one client to get or to set parameters that may wait for their answers."""

MAX_OPEN_SIZE = 16 << 20
"""Bytes of all these requests of one client; one request alone may be larger."""

MAX_WATCHED = 20_000
"""Names of parameters that one client may watch."""

MAX_ENDED = 1000
"""Subscriptions of vanished channels that are remembered for each client."""

MAX_REFUSALS = 8
"""Rejections reported for one frame: a frame with many errors must not delay other clients."""


READ_ONLY = "this connection is read-only: it may subscribe and read, but not change anything"

Routes = tuple[tuple[int, int], ...]
"""Pairs of client and its subscription ID."""


@dataclass(frozen=True, slots=True)
class Delivery:
    """A message and the clients that receive it."""

    clients: tuple[int, ...]
    message: ms.ServerMessage


@dataclass(slots=True)
class Outcome:
    """The results of one step, in order."""

    deliveries: list[Delivery] = field(default_factory=list)
    events: list[ev.Event] = field(default_factory=list)
    refusals: int = 0

    def send(self, client: int, message: ms.ServerMessage) -> None:
        """Add a delivery to one client."""
        self.deliveries.append(Delivery((client,), message))

    def refuse(self, client: int, text: str, level: StatusLevel = StatusLevel.ERROR) -> None:
        """Add a status with the reason of a rejection; only the first `MAX_REFUSALS` are sent."""
        self.refusals += 1
        if self.refusals <= MAX_REFUSALS:
            self.send(client, ms.Status(level, text))


class Switchboard:
    """State of one server. Invariant: `routes` lists exactly the subscriptions found in the clients' states."""

    def __init__(
        self, info: ms.ServerInfo, *, is_read_only_service: Callable[[str], bool] = lambda service: False
    ) -> None:
        """`is_read_only_service` says which services a read-only client may call, by name."""
        self._info = info
        self._changes_nothing = is_read_only_service
        self._clients: dict[int, ClientState] = {}
        self._channels: dict[int, ms.Channel] = {}
        self._services: dict[int, ms.Service] = {}
        self._parameters: dict[str, ms.Parameter] = {}
        self._graph = ConnectionGraph()
        self._client_channels = 0
        """Open channels of all clients."""
        self._advertisements: list[ms.ServerMessage] | None = None
        """Advertisements of channels and services for new clients; None after a change."""
        self.retained: dict[int, deque[ev.Data]] = {}
        """Retained messages for new subscribers, by channel."""
        self.routed: dict[int, Routes] = {}
        """Routes of all channels with subscribers; each change creates a new tuple. Read-only for others."""
        self._time_ns = 0

    # --- interface of the server ---

    def routes(self, channel_id: int) -> Routes:
        """(client, subscription ID) of all subscriptions to a channel."""
        return self.routed.get(channel_id, ())

    def retain(self, data: ev.Data) -> None:
        """Retain a message if its channel is retained; a repeated payload is kept once, as the latest."""
        retained = self.retained.get(data.channel_id)
        if retained is None:
            return
        repeated = next((old for old in retained if old.payload == data.payload), None)
        if repeated is not None:
            retained.remove(repeated)
        retained.append(data)

    def join(self, client: int, role: Role = Role.FULL) -> list[ms.ServerMessage]:
        """Add a client; return the messages that it receives first."""
        self._clients[client] = ClientState(is_read_only=role is Role.READ_ONLY)
        greeting: list[ms.ServerMessage] = [self._info_for(client)]
        if Capability.TIME in self._info.capabilities:
            greeting.append(ms.Time(self._time_ns))
        if self._advertisements is None:
            self._advertisements = []
            if self._channels:
                self._advertisements.append(ms.Advertise(tuple(self._channels.values())))
            if self._services:
                self._advertisements.append(ms.AdvertiseServices(tuple(self._services.values())))
        return greeting + self._advertisements

    def leave(self, client: int) -> list[ev.Event]:
        """Remove a client with its subscriptions and channels; return the resulting events."""
        state = self._clients.pop(client)
        outcome = Outcome()
        for channel_id in state.subscriptions.values():
            self._unroute(client, channel_id, outcome)
        outcome.events += (ev.ClientChannelClosed(client, channel_id) for channel_id in state.channels)
        self._client_channels -= len(state.channels)
        if state.graph is not None:
            self._graph_left(outcome)
        return outcome.events

    def receive(self, client: int, message: ms.ClientMessage) -> Outcome:
        """Process a message of a client."""
        outcome = Outcome()
        capability, handle = _FROM_CLIENT[type(message)]
        if capability is not None and capability not in self._info.capabilities:
            outcome.refuse(client, f"this server does not offer {capability}")
        elif self._clients[client].is_read_only and self._is_change(message):
            self._refuse_change(client, message, outcome)
        else:
            handle(self, client, message, outcome)
        return outcome

    def apply(self, command: ev.Command) -> list[Delivery]:
        """Process a command of the data source."""
        deliveries: list[Delivery] = []
        _FROM_OWNER[type(command)](self, command, deliveries)
        return deliveries

    # --- clients' messages ---

    def _subscribe(self, client: int, message: ms.Subscribe, outcome: Outcome) -> None:
        state = self._clients[client]
        subscriptions = dict(state.subscriptions)
        subscribed = set(subscriptions.values())
        for item in message.subscriptions:
            where = f"subscription {item.id}"
            if item.id in subscriptions:
                outcome.refuse(client, f"{where} exists already")
            elif item.channel_id not in self._channels:
                outcome.refuse(client, f"{where}: no channel {item.channel_id}", StatusLevel.WARNING)
            elif item.channel_id in subscribed:
                topic = self._channels[item.channel_id].topic
                outcome.refuse(client, f"{where}: already subscribed to {topic}", StatusLevel.WARNING)
            else:
                subscriptions[item.id] = item.channel_id
                subscribed.add(item.channel_id)
                self._route(item.channel_id, (*self.routes(item.channel_id), (client, item.id)), outcome)
                for data in self.retained.get(item.channel_id, ()):
                    outcome.send(client, ms.MessageData(item.id, data.time_ns, data.payload))
        self._clients[client] = replace(state, subscriptions=subscriptions)

    def _unsubscribe(self, client: int, message: ms.Unsubscribe, outcome: Outcome) -> None:
        state = self._clients[client]
        subscriptions = dict(state.subscriptions)
        for subscription_id in message.subscription_ids:
            channel_id = subscriptions.pop(subscription_id, None)
            if channel_id is not None:
                self._unroute(client, channel_id, outcome)
            elif subscription_id not in state.ended:  # some clients unsubscribe from removed channels
                outcome.refuse(client, f"no subscription {subscription_id}", StatusLevel.WARNING)
        self._clients[client] = replace(state, subscriptions=subscriptions)

    def _open(self, client: int, message: ms.ClientAdvertise, outcome: Outcome) -> None:
        state = self._clients[client]
        channels = dict(state.channels)
        for channel in message.channels:
            where = f"channel {channel.id} for {channel.topic}"
            if channel.id in channels:
                outcome.refuse(client, f"{where}: the id is in use for {channels[channel.id].topic}")
            elif channel.encoding not in self._info.supported_encodings:
                expected = " or ".join(self._info.supported_encodings)
                outcome.refuse(client, f"{where}: expected encoding {expected}, found {channel.encoding}")
            elif len(channels) >= MAX_CLIENT_CHANNELS:
                outcome.refuse(client, f"{where}: more than {MAX_CLIENT_CHANNELS} channels")
            elif self._client_channels >= MAX_ALL_CLIENT_CHANNELS:
                outcome.refuse(client, f"{where}: more than {MAX_ALL_CLIENT_CHANNELS} channels of all clients")
            else:
                channels[channel.id] = channel
                self._client_channels += 1
                outcome.events.append(ev.ClientChannelOpened(client, channel))
        self._clients[client] = replace(state, channels=channels)

    def _close(self, client: int, message: ms.ClientUnadvertise, outcome: Outcome) -> None:
        state = self._clients[client]
        channels = dict(state.channels)
        for channel_id in message.channel_ids:
            if channels.pop(channel_id, None) is None:
                outcome.refuse(client, f"no client channel {channel_id}", StatusLevel.WARNING)
            else:
                self._client_channels -= 1
                outcome.events.append(ev.ClientChannelClosed(client, channel_id))
        self._clients[client] = replace(state, channels=channels)

    def _client_data(self, client: int, message: ms.ClientMessageData, outcome: Outcome) -> None:
        if message.channel_id in self._clients[client].channels:
            outcome.events.append(ev.ClientMessageReceived(client, message.channel_id, message.payload))
        else:
            outcome.refuse(client, f"message on client channel {message.channel_id}, which is not advertised")

    def _call(self, client: int, message: ms.ServiceRequest, outcome: Outcome) -> None:
        event = ev.ServiceCalled(client, message)
        state, size = self._clients[client], ev.size_of(event)
        if message.service_id not in self._services:
            text = f"no service {message.service_id}"
        elif state.calls >= MAX_CALLS:
            text = f"{self._services[message.service_id].name}: {MAX_CALLS} calls of this client wait already"
        elif not _has_room(state, size):
            text = f"{self._services[message.service_id].name}: {_TOO_MUCH}"
        else:
            outcome.events.append(event)
            self._clients[client] = replace(state, calls=state.calls + 1, open_size=state.open_size + size)
            return
        outcome.send(client, ms.ServiceCallFailure(message.service_id, message.call_id, text))
        outcome.refuse(client, text)

    def _get_parameters(self, client: int, message: ms.GetParameters, outcome: Outcome) -> None:
        self._request_parameters(ev.ParametersRequested(client, message.parameter_names, message.id), outcome)

    def _set_parameters(self, client: int, message: ms.SetParameters, outcome: Outcome) -> None:
        self._request_parameters(ev.ParametersSet(client, message.parameters, message.id), outcome)

    def _request_parameters(self, event: ev.ParametersRequested | ev.ParametersSet, outcome: Outcome) -> None:
        state, size = self._clients[event.client], ev.size_of(event)
        if state.parameter_requests >= MAX_PARAMETER_REQUESTS:
            text = f"{MAX_PARAMETER_REQUESTS} requests of this client wait already"
        elif not _has_room(state, size):
            text = _TOO_MUCH
        else:
            outcome.events.append(event)
            self._clients[event.client] = replace(
                state, parameter_requests=state.parameter_requests + 1, open_size=state.open_size + size
            )
            return
        if isinstance(event, ev.ParametersRequested):
            outcome.refuse(event.client, f"parameters (request {event.request_id!r:.40}): {text}")
            return
        names = tuple(item.name for item in event.parameters)
        for name in names[:MAX_REFUSALS]:
            outcome.send(event.client, ms.Status(StatusLevel.ERROR, f"{name}: {text}", ms.parameter_status(name)))
        if event.request_id is not None:
            outcome.send(event.client, self._values(names, event.request_id))

    def _watch_parameters(self, client: int, message: ms.SubscribeParameterUpdates, outcome: Outcome) -> None:
        state = self._clients[client]
        names = state.parameters.union(message.parameter_names)
        if len(names) > MAX_WATCHED:
            outcome.refuse(client, f"parameters: expected at most {MAX_WATCHED} names to watch, found {len(names)}")
            return
        self._clients[client] = replace(state, parameters=names)
        outcome.events.append(ev.ParametersWatched(client, message.parameter_names))

    def _unwatch_parameters(self, client: int, message: ms.UnsubscribeParameterUpdates, outcome: Outcome) -> None:
        state = self._clients[client]
        self._clients[client] = replace(state, parameters=state.parameters.difference(message.parameter_names))

    def _watch_graph(self, client: int, message: ms.SubscribeConnectionGraph, outcome: Outcome) -> None:
        state = self._clients[client]
        if state.graph is not None:
            return
        if all(other.graph is None for other in self._clients.values()):
            outcome.events.append(ev.GraphSubscriptionChanged(True))
        update = self._graph.since(ConnectionGraph())
        if update is not None:
            outcome.send(client, update)
        self._clients[client] = replace(state, graph=self._graph)

    def _unwatch_graph(self, client: int, message: ms.UnsubscribeConnectionGraph, outcome: Outcome) -> None:
        state = self._clients[client]
        if state.graph is not None:
            self._clients[client] = replace(state, graph=None)
            self._graph_left(outcome)

    def _fetch_asset(self, client: int, message: ms.FetchAsset, outcome: Outcome) -> None:
        outcome.events.append(ev.AssetRequested(client, message.uri, message.request_id))

    # --- commands of the data source ---

    def _add_channels(self, command: ev.AddChannels, deliveries: list[Delivery]) -> None:
        self._advertisements = None
        self._channels.update((channel.id, channel) for channel in command.channels)
        self._send_all(ms.Advertise(command.channels), deliveries)

    def _remove_channels(self, command: ev.RemoveChannels, deliveries: list[Delivery]) -> None:
        self._advertisements = None
        ended: dict[int, dict[int, None]] = {}
        for channel_id in command.channel_ids:
            self._channels.pop(channel_id, None)
            self.retained.pop(channel_id, None)
            for client, subscription_id in self.routed.pop(channel_id, ()):
                ended.setdefault(client, {})[subscription_id] = None
        for client, gone in ended.items():
            state = self._clients[client]
            left = {key: value for key, value in state.subscriptions.items() if key not in gone}
            latest = [*state.ended, *gone][-MAX_ENDED:]
            self._clients[client] = replace(state, subscriptions=left, ended=dict.fromkeys(latest))
        self._send_all(ms.Unadvertise(command.channel_ids), deliveries)

    def _retain_last(self, command: ev.RetainLast, deliveries: list[Delivery]) -> None:
        if command.depth and command.channel_id in self.routed:
            retained = self.retained.get(command.channel_id, ())
            self.retained[command.channel_id] = deque(retained, maxlen=command.depth)
        else:
            self.retained.pop(command.channel_id, None)

    def _add_services(self, command: ev.AddServices, deliveries: list[Delivery]) -> None:
        self._advertisements = None
        self._services.update((service.id, service) for service in command.services)
        self._send_all(ms.AdvertiseServices(command.services), deliveries)

    def _remove_services(self, command: ev.RemoveServices, deliveries: list[Delivery]) -> None:
        self._advertisements = None
        for service_id in command.service_ids:
            self._services.pop(service_id, None)
        self._send_all(ms.UnadvertiseServices(command.service_ids), deliveries)

    def _parameters_changed(self, command: ev.ParametersChanged, deliveries: list[Delivery]) -> None:
        changed = {item.name: item for item in command.parameters if self._parameters.get(item.name) != item}
        self._parameters.update(changed)
        for name in command.removed:
            if self._parameters.pop(name, None) is not None:
                changed[name] = ms.Parameter(name)
        for client, state in self._clients.items():
            wanted = tuple(item for name, item in changed.items() if name in state.parameters)
            if wanted:
                deliveries.append(Delivery((client,), ms.ParameterValues(wanted)))

    def _send_parameters(self, command: ev.SendParameters, deliveries: list[Delivery]) -> None:
        state = self._clients.get(command.client)
        if state is not None:
            self._clients[command.client] = replace(
                state,
                parameter_requests=max(0, state.parameter_requests - 1),
                open_size=max(0, state.open_size - command.size),
            )
            names = self._parameters if command.names is None else command.names
            deliveries.append(Delivery((command.client,), self._values(names, command.request_id)))

    def _set_graph(self, command: ev.SetGraph, deliveries: list[Delivery]) -> None:
        self._graph = command.graph
        updates: dict[int, ms.ConnectionGraphUpdate | None] = {}
        for client, state in list(self._clients.items()):
            if state.graph is None:
                continue
            known = id(state.graph)  # most clients know the same one
            update = updates[known] = updates[known] if known in updates else command.graph.since(state.graph)
            if update is not None:
                self._clients[client] = replace(state, graph=command.graph)
                deliveries.append(Delivery((client,), update))

    def _set_time(self, command: ev.SetTime, deliveries: list[Delivery]) -> None:
        self._time_ns = command.time_ns
        self._send_all(ms.Time(command.time_ns), deliveries)

    def _new_session(self, command: ev.NewSession, deliveries: list[Delivery]) -> None:
        self._info = replace(self._info, session_id=command.session_id)
        for is_read_only in (False, True):
            clients = tuple(key for key, state in self._clients.items() if state.is_read_only is is_read_only)
            if clients:
                deliveries.append(Delivery(clients, self._info_for(clients[0])))
        # An empty advertisement makes Lichtblick read the types again, which it forgets and needs for publishing.
        self._send_all(ms.Advertise(()), deliveries)
        for client, state in list(self._clients.items()):
            if state.graph is not None:  # the client forgot it: the next update is complete again
                self._clients[client] = replace(state, graph=ConnectionGraph())
        self._set_graph(ev.SetGraph(self._graph), deliveries)

    def _resend_retained(self, command: ev.ResendRetained, deliveries: list[Delivery]) -> None:
        for channel_id, retained in self.retained.items():
            deliveries += (
                Delivery((client,), ms.MessageData(subscription_id, self._time_ns, data.payload))
                for client, subscription_id in self.routes(channel_id)
                for data in retained
            )

    def _answer_call(self, command: ev.AnswerCall, deliveries: list[Delivery]) -> None:
        state = self._clients.get(command.client)
        if state is not None:
            self._clients[command.client] = replace(
                state, calls=max(0, state.calls - 1), open_size=max(0, state.open_size - command.size)
            )
            deliveries.append(Delivery((command.client,), command.message))

    def _send_to_client(self, command: ev.SendToClient, deliveries: list[Delivery]) -> None:
        if command.client in self._clients:
            deliveries.append(Delivery((command.client,), command.message))

    # --- read-only clients ---

    def _info_for(self, client: int) -> ms.ServerInfo:
        """The server info for a client: without the capability to publish for a read-only one."""
        if not self._clients[client].is_read_only:
            return self._info
        offered = tuple(item for item in self._info.capabilities if item != Capability.CLIENT_PUBLISH)
        metadata = {**self._info.metadata, "access": Role.READ_ONLY.value}
        return replace(self._info, capabilities=offered, metadata=metadata)

    def _is_change(self, message: ms.ClientMessage) -> bool:
        if isinstance(message, ms.ServiceRequest):
            service = self._services.get(message.service_id)
            return service is not None and not self._changes_nothing(service.name)
        return isinstance(message, ms.ClientAdvertise | ms.ClientMessageData | ms.SetParameters)

    def _refuse_change(self, client: int, message: ms.ClientMessage, outcome: Outcome) -> None:
        """Report the rejection, and answer requests that expect an answer."""
        if isinstance(message, ms.ServiceRequest):
            outcome.send(client, ms.ServiceCallFailure(message.service_id, message.call_id, READ_ONLY))
        if isinstance(message, ms.SetParameters):
            names = [item.name for item in message.parameters]
            for name in names[:MAX_REFUSALS]:
                outcome.send(client, ms.Status(StatusLevel.ERROR, f"{name}: {READ_ONLY}", f"parameter:{name}"))
            outcome.send(client, self._values(names, message.id))
        else:
            outcome.refuse(client, READ_ONLY)

    # --- helpers ---

    def _send_all(self, message: ms.ServerMessage, deliveries: list[Delivery]) -> None:
        if self._clients:
            deliveries.append(Delivery(tuple(self._clients), message))

    def _values(self, names: Iterable[str], request_id: str | None) -> ms.ParameterValues:
        known = (self._parameters[name] for name in names if name in self._parameters)
        return ms.ParameterValues(tuple(known), request_id)

    def _route(self, channel_id: int, routes: Routes, outcome: Outcome) -> None:
        """Set the routes of a channel; add an event for its first and its last subscriber."""
        was_wanted = channel_id in self.routed
        if routes:
            self.routed[channel_id] = routes
            if not was_wanted:
                outcome.events.append(ev.ChannelSubscribed(channel_id))
        elif was_wanted:
            del self.routed[channel_id]
            self.retained.pop(channel_id, None)
            outcome.events.append(ev.ChannelUnsubscribed(channel_id))

    def _unroute(self, client: int, channel_id: int, outcome: Outcome) -> None:
        self._route(channel_id, tuple(route for route in self.routes(channel_id) if route[0] != client), outcome)

    def _graph_left(self, outcome: Outcome) -> None:
        if all(state.graph is None for state in self._clients.values()):
            outcome.events.append(ev.GraphSubscriptionChanged(False))


_TOO_MUCH = f"more than {MAX_OPEN_SIZE >> 20} MiB of this client's requests wait already"


def _has_room(state: ClientState, size: int) -> bool:
    return not state.open_size or state.open_size + size <= MAX_OPEN_SIZE


_FROM_CLIENT: dict[type, tuple[Capability | None, Callable[[Switchboard, int, Any, Outcome], None]]] = {
    ms.Subscribe: (None, Switchboard._subscribe),
    ms.Unsubscribe: (None, Switchboard._unsubscribe),
    ms.ClientAdvertise: (Capability.CLIENT_PUBLISH, Switchboard._open),
    ms.ClientUnadvertise: (Capability.CLIENT_PUBLISH, Switchboard._close),
    ms.ClientMessageData: (Capability.CLIENT_PUBLISH, Switchboard._client_data),
    ms.ServiceRequest: (Capability.SERVICES, Switchboard._call),
    ms.GetParameters: (Capability.PARAMETERS, Switchboard._get_parameters),
    ms.SetParameters: (Capability.PARAMETERS, Switchboard._set_parameters),
    ms.SubscribeParameterUpdates: (Capability.PARAMETERS_SUBSCRIBE, Switchboard._watch_parameters),
    ms.UnsubscribeParameterUpdates: (Capability.PARAMETERS_SUBSCRIBE, Switchboard._unwatch_parameters),
    ms.SubscribeConnectionGraph: (Capability.CONNECTION_GRAPH, Switchboard._watch_graph),
    ms.UnsubscribeConnectionGraph: (Capability.CONNECTION_GRAPH, Switchboard._unwatch_graph),
    ms.FetchAsset: (Capability.ASSETS, Switchboard._fetch_asset),
}

_FROM_OWNER: dict[type, Callable[[Switchboard, Any, list[Delivery]], None]] = {
    ev.AddChannels: Switchboard._add_channels,
    ev.RemoveChannels: Switchboard._remove_channels,
    ev.RetainLast: Switchboard._retain_last,
    ev.AddServices: Switchboard._add_services,
    ev.RemoveServices: Switchboard._remove_services,
    ev.ParametersChanged: Switchboard._parameters_changed,
    ev.SendParameters: Switchboard._send_parameters,
    ev.SetGraph: Switchboard._set_graph,
    ev.SetTime: Switchboard._set_time,
    ev.NewSession: Switchboard._new_session,
    ev.ResendRetained: Switchboard._resend_retained,
    ev.AnswerCall: Switchboard._answer_call,
    ev.SendToClient: Switchboard._send_to_client,
}
