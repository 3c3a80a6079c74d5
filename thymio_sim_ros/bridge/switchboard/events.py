"""Events from the bridge to the data source, and commands from the data source to the bridge.

Events report requests of clients; commands report available data. All are frozen values, so they may cross threads.
"""

from __future__ import annotations

from dataclasses import dataclass

from thymio_sim_ros.access import Role
from thymio_sim_ros.bridge.protocol.connection_graph import ConnectionGraph
from thymio_sim_ros.bridge.protocol.messages import (
    Channel,
    ClientChannel,
    Parameter,
    ParameterValue,
    ServerMessage,
    Service,
    ServiceCallFailure,
    ServiceRequest,
    ServiceResponse,
)

# --- events of the bridge --------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class ChannelSubscribed:
    """A channel got its first subscriber."""

    channel_id: int


@dataclass(frozen=True, slots=True)
class ChannelUnsubscribed:
    """A channel lost its last subscriber."""

    channel_id: int


@dataclass(frozen=True, slots=True)
class ClientChannelOpened:
    """A client opened a channel to publish on."""

    client: int
    channel: ClientChannel


@dataclass(frozen=True, slots=True)
class ClientChannelClosed:
    """A client closed a channel, or disconnected."""

    client: int
    channel_id: int


@dataclass(frozen=True, slots=True)
class ClientMessageReceived:
    """A client published on one of its open channels."""

    client: int
    channel_id: int
    payload: bytes


@dataclass(frozen=True, slots=True)
class ServiceCalled:
    """A client calls an existing service; answer with one `AnswerCall`."""

    client: int
    request: ServiceRequest


@dataclass(frozen=True, slots=True)
class ParametersSet:
    """A client sets parameters; answer with one `SendParameters`."""

    client: int
    parameters: tuple[Parameter, ...]
    request_id: str | None


@dataclass(frozen=True, slots=True)
class ParametersRequested:
    """A client requests the values of these parameters (empty: of all); answer with one `SendParameters`."""

    client: int
    names: tuple[str, ...]
    request_id: str | None


@dataclass(frozen=True, slots=True)
class ParametersWatched:
    """A client subscribed to changes of these parameters."""

    client: int
    names: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class AssetRequested:
    """A client requests a file; answer with `SendToClient`."""

    client: int
    uri: str
    request_id: int


@dataclass(frozen=True, slots=True)
class GraphSubscriptionChanged:
    """The first client subscribed to the connection graph (`wanted`), or the last one unsubscribed."""

    wanted: bool


@dataclass(frozen=True, slots=True)
class RosbridgeJoined:
    """A client connected that uses the rosbridge protocol."""

    client: int
    role: Role


@dataclass(frozen=True, slots=True)
class RosbridgeReceived:
    """A message of a rosbridge client."""

    client: int
    frame: str | bytes


@dataclass(frozen=True, slots=True)
class RosbridgeLeft:
    """A rosbridge client disconnected."""

    client: int


Event = (
    ChannelSubscribed
    | ChannelUnsubscribed
    | ClientChannelOpened
    | ClientChannelClosed
    | ClientMessageReceived
    | ServiceCalled
    | ParametersSet
    | ParametersRequested
    | ParametersWatched
    | AssetRequested
    | GraphSubscriptionChanged
    | RosbridgeJoined
    | RosbridgeReceived
    | RosbridgeLeft
)

# --- commands to the bridge ----------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class AddChannels:
    """New channels; IDs are never reused."""

    channels: tuple[Channel, ...]


@dataclass(frozen=True, slots=True)
class RemoveChannels:
    """Remove channels."""

    channel_ids: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class RetainLast:
    """Retain the last `depth` messages of a channel for new subscribers; 0 drops them and retains none."""

    channel_id: int
    depth: int


@dataclass(frozen=True, slots=True)
class Data:
    """A message of a channel at `time_ns`."""

    channel_id: int
    time_ns: int
    payload: bytes


@dataclass(frozen=True, slots=True)
class AddServices:
    """New services; IDs are never reused."""

    services: tuple[Service, ...]


@dataclass(frozen=True, slots=True)
class RemoveServices:
    """Remove services."""

    service_ids: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class ParametersChanged:
    """Current values, and names of removed parameters."""

    parameters: tuple[Parameter, ...]
    removed: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class SendParameters:
    """Send a client the current values of these parameters (None: all), in answer to a request of `size` bytes."""

    client: int
    names: tuple[str, ...] | None
    request_id: str | None
    size: int = 0


@dataclass(frozen=True, slots=True)
class SetGraph:
    """The current connection graph."""

    graph: ConnectionGraph


@dataclass(frozen=True, slots=True)
class SetTime:
    """The current simulated time."""

    time_ns: int


@dataclass(frozen=True, slots=True)
class NewSession:
    """Start a new session: clients drop the data of the last one."""

    session_id: str


@dataclass(frozen=True, slots=True)
class ResendRetained:
    """Send retained messages to all subscribers again, because they dropped them with the last session."""


@dataclass(frozen=True, slots=True)
class AnswerCall:
    """The answer to a client's service call, whose request had `size` bytes; dropped if the client has disconnected."""

    client: int
    message: ServiceResponse | ServiceCallFailure
    size: int


@dataclass(frozen=True, slots=True)
class SendToClient:
    """A message for one client; dropped if it has disconnected."""

    client: int
    message: ServerMessage


Command = (
    AddChannels
    | RemoveChannels
    | RetainLast
    | AddServices
    | RemoveServices
    | ParametersChanged
    | SendParameters
    | SetGraph
    | SetTime
    | NewSession
    | ResendRetained
    | AnswerCall
    | SendToClient
)


_PARAMETER_SIZE = 2048
"""Memory of one parameter as a ROS message in Python, without its value, bytes."""


def size_of(event: Event) -> int:
    """Size of the client's data in an event: payload, message or parameters, bytes. Other events have 0."""
    if isinstance(event, ClientMessageReceived):
        return len(event.payload)
    if isinstance(event, RosbridgeReceived):
        return len(event.frame)
    if isinstance(event, ServiceCalled):
        return len(event.request.payload)
    if isinstance(event, ParametersSet):
        return sum(_PARAMETER_SIZE + _size(item.value) for item in event.parameters)
    return 0


def _size(value: ParameterValue) -> int:
    if isinstance(value, tuple):
        return sum(_size(item) for item in value)
    return len(value) if isinstance(value, str) else 8
