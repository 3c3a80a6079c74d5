"""The two one-way streets between the bridge and whoever owns the data (for us: the ROS thread).

Events go out: what clients want. Commands come in: what there is. All are frozen values, so they may cross threads.
"""

from __future__ import annotations

from dataclasses import dataclass

from thymio_sim_ros.bridge.graph import ConnectionGraph
from thymio_sim_ros.bridge.messages import (
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

# --- events: the bridge tells --------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class ChannelWanted:
    """The first subscriber of a channel came."""

    channel_id: int


@dataclass(frozen=True, slots=True)
class ChannelUnwanted:
    """The last subscriber of a channel left."""

    channel_id: int


@dataclass(frozen=True, slots=True)
class ClientChannelOpened:
    """A client is going to send."""

    client: int
    channel: ClientChannel


@dataclass(frozen=True, slots=True)
class ClientChannelClosed:
    """A client ended a channel, or left with it open."""

    client: int
    channel_id: int


@dataclass(frozen=True, slots=True)
class ClientSent:
    """A client's message on one of its open channels."""

    client: int
    channel_id: int
    payload: bytes


@dataclass(frozen=True, slots=True)
class ServiceCalled:
    """A client calls an existing service; answer with one `Answer`."""

    client: int
    request: ServiceRequest


@dataclass(frozen=True, slots=True)
class ParametersSet:
    """A client wants these values; answer with one `ShowParameters`."""

    client: int
    parameters: tuple[Parameter, ...]
    request_id: str | None


@dataclass(frozen=True, slots=True)
class ParametersAsked:
    """A client asks for the values of these names, or of all (none); answer with one `ShowParameters`."""

    client: int
    names: tuple[str, ...]
    request_id: str | None


@dataclass(frozen=True, slots=True)
class ParametersWatched:
    """A client wants to be told of changes of these names."""

    client: int
    names: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class AssetWanted:
    """A client wants a file; answer with `Tell`."""

    client: int
    uri: str
    request_id: int


@dataclass(frozen=True, slots=True)
class GraphWanted:
    """The first client asks who talks to whom (`wanted`), or the last one stopped asking."""

    wanted: bool


Event = (
    ChannelWanted
    | ChannelUnwanted
    | ClientChannelOpened
    | ClientChannelClosed
    | ClientSent
    | ServiceCalled
    | ParametersSet
    | ParametersAsked
    | ParametersWatched
    | AssetWanted
    | GraphWanted
)

# --- commands: the bridge is told ----------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class AddChannels:
    """New channels; ids are never used again."""

    channels: tuple[Channel, ...]


@dataclass(frozen=True, slots=True)
class RemoveChannels:
    """Channels that are gone."""

    channel_ids: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class KeepLast:
    """Keep the last `depth` messages of a channel for newcomers; 0: forget them, keep none."""

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
    """New services; ids are never used again."""

    services: tuple[Service, ...]


@dataclass(frozen=True, slots=True)
class RemoveServices:
    """Services that are gone."""

    service_ids: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class ParametersChanged:
    """Values in force, and names that are gone."""

    parameters: tuple[Parameter, ...]
    removed: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class ShowParameters:
    """Send a client the values in force of these names (None: of all), as the answer to its request of `size` bytes."""

    client: int
    names: tuple[str, ...] | None
    request_id: str | None
    size: int = 0


@dataclass(frozen=True, slots=True)
class SetGraph:
    """Who talks to whom now."""

    graph: ConnectionGraph


@dataclass(frozen=True, slots=True)
class SetTime:
    """Simulated time is now `time_ns`."""

    time_ns: int


@dataclass(frozen=True, slots=True)
class NewSession:
    """Clients shall drop what they know of the past."""

    session_id: str


@dataclass(frozen=True, slots=True)
class RepeatKept:
    """Give what is kept for newcomers to all subscribers once more: they have dropped it with the past."""


@dataclass(frozen=True, slots=True)
class Answer:
    """The answer to a client's service call, whose request had `size` bytes; forgotten when the client has left."""

    client: int
    message: ServiceResponse | ServiceCallFailure
    size: int


@dataclass(frozen=True, slots=True)
class Tell:
    """A message for one client; forgotten when it has left."""

    client: int
    message: ServerMessage


Command = (
    AddChannels
    | RemoveChannels
    | KeepLast
    | AddServices
    | RemoveServices
    | ParametersChanged
    | ShowParameters
    | SetGraph
    | SetTime
    | NewSession
    | RepeatKept
    | Answer
    | Tell
)


_PARAMETER_SIZE = 2048
"""What one parameter takes as a ROS message in Python, bytes."""


def size_of(event: Event) -> int:
    """Bytes of a client's content in an event: of a payload, of parameters."""
    if isinstance(event, ClientSent):
        return len(event.payload)
    if isinstance(event, ServiceCalled):
        return len(event.request.payload)
    if isinstance(event, ParametersSet):
        return sum(_PARAMETER_SIZE + _size(item.value) for item in event.parameters)
    return 0


def _size(value: ParameterValue) -> int:
    if isinstance(value, tuple):
        return sum(_size(item) for item in value)
    return len(value) if isinstance(value, str) else 8
