"""Every message of the protocol as a frozen value (docs/spec/foxglove.md section 2).

JSON messages name their `op`; their other keys are the camelCase names of the fields. An `int` is an unsigned 32-bit
id, an optional field that is None is left out. Messages without `op` are binary. `wire` turns all of them into frames.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar, get_args

from thymio_sim_ros.bridge.protocol.constants import StatusLevel

# --- parts ---------------------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Channel:
    """A stream that clients can subscribe to."""

    id: int
    topic: str
    encoding: str
    schema_name: str
    schema: str
    schema_encoding: str | None = None


@dataclass(frozen=True, slots=True)
class ClientChannel:
    """A stream that a client sends; the id is the client's own."""

    id: int
    topic: str
    encoding: str
    schema_name: str
    schema: str | None = None
    schema_encoding: str | None = None


@dataclass(frozen=True, slots=True)
class Subscription:
    """A client's name for its interest in one channel."""

    id: int
    channel_id: int


@dataclass(frozen=True, slots=True)
class ServiceSide:
    """Form of a service's request or response."""

    encoding: str
    schema_name: str
    schema_encoding: str
    schema: str


@dataclass(frozen=True, slots=True)
class Service:
    """A service that clients can call."""

    id: int
    name: str
    type: str
    request: ServiceSide
    response: ServiceSide


ParameterValue = bool | int | float | str | tuple[bool | int | float | str, ...] | None


@dataclass(frozen=True, slots=True)
class Parameter:
    """A named value, None: not set. `type` says float64, float64_array or byte_array (base64) where JSON cannot."""

    name: str
    value: ParameterValue = None
    type: str | None = None


@dataclass(frozen=True, slots=True)
class PublishedTopic:
    """Who publishes a topic; node names as /ns/node."""

    name: str
    publisher_ids: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class SubscribedTopic:
    """Who subscribes to a topic."""

    name: str
    subscriber_ids: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class AdvertisedService:
    """Who answers a service."""

    name: str
    provider_ids: tuple[str, ...]


# --- server → client -----------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class ServerInfo:
    """First message to each client; a new session id makes clients drop their state."""

    op: ClassVar[str] = "serverInfo"
    name: str
    capabilities: tuple[str, ...]
    supported_encodings: tuple[str, ...] = ()
    metadata: Mapping[str, str] = field(default_factory=dict)
    session_id: str | None = None


@dataclass(frozen=True, slots=True)
class Status:
    """A remark to the user; with an id it can be replaced or removed."""

    op: ClassVar[str] = "status"
    level: StatusLevel
    message: str
    id: str | None = None


def parameter_status(name: str) -> str:
    """The id of the status that says why a parameter was not set."""
    return f"parameter:{name}"


@dataclass(frozen=True, slots=True)
class RemoveStatus:
    """These remarks no longer hold."""

    op: ClassVar[str] = "removeStatus"
    status_ids: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Advertise:
    """New channels."""

    op: ClassVar[str] = "advertise"
    channels: tuple[Channel, ...]


@dataclass(frozen=True, slots=True)
class Unadvertise:
    """Channels that are gone."""

    op: ClassVar[str] = "unadvertise"
    channel_ids: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class AdvertiseServices:
    """New services."""

    op: ClassVar[str] = "advertiseServices"
    services: tuple[Service, ...]


@dataclass(frozen=True, slots=True)
class UnadvertiseServices:
    """Services that are gone."""

    op: ClassVar[str] = "unadvertiseServices"
    service_ids: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class ParameterValues:
    """Values in force; `id` repeats that of the request it answers."""

    op: ClassVar[str] = "parameterValues"
    parameters: tuple[Parameter, ...]
    id: str | None = None


@dataclass(frozen=True, slots=True)
class ConnectionGraphUpdate:
    """Who talks to whom: the first one complete, later ones differences."""

    op: ClassVar[str] = "connectionGraphUpdate"
    published_topics: tuple[PublishedTopic, ...] = ()
    subscribed_topics: tuple[SubscribedTopic, ...] = ()
    advertised_services: tuple[AdvertisedService, ...] = ()
    removed_topics: tuple[str, ...] = ()
    removed_services: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class ServiceCallFailure:
    """A call that cannot be answered, and why."""

    op: ClassVar[str] = "serviceCallFailure"
    service_id: int
    call_id: int
    message: str


@dataclass(frozen=True, slots=True)
class MessageData:
    """One message of a channel, at `time_ns`, for a client's subscription."""

    subscription_id: int
    time_ns: int
    payload: bytes


@dataclass(frozen=True, slots=True)
class Time:
    """Simulated time, ns."""

    time_ns: int


@dataclass(frozen=True, slots=True)
class ServiceResponse:
    """Answer to a `ServiceRequest` with the same ids."""

    service_id: int
    call_id: int
    encoding: str
    payload: bytes


@dataclass(frozen=True, slots=True)
class AssetResponse:
    """A file, or why there is none (`error`; `data` is then empty)."""

    request_id: int
    data: bytes
    error: str | None = None


# --- client → server -----------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Subscribe:
    """Start streams."""

    op: ClassVar[str] = "subscribe"
    subscriptions: tuple[Subscription, ...]


@dataclass(frozen=True, slots=True)
class Unsubscribe:
    """End streams."""

    op: ClassVar[str] = "unsubscribe"
    subscription_ids: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class ClientAdvertise:
    """Streams that the client is going to send."""

    op: ClassVar[str] = "advertise"
    channels: tuple[ClientChannel, ...]


@dataclass(frozen=True, slots=True)
class ClientUnadvertise:
    """Streams that the client ends."""

    op: ClassVar[str] = "unadvertise"
    channel_ids: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class GetParameters:
    """Ask for values; no names: all."""

    op: ClassVar[str] = "getParameters"
    parameter_names: tuple[str, ...]
    id: str | None = None


@dataclass(frozen=True, slots=True)
class SetParameters:
    """Change values."""

    op: ClassVar[str] = "setParameters"
    parameters: tuple[Parameter, ...]
    id: str | None = None


@dataclass(frozen=True, slots=True)
class SubscribeParameterUpdates:
    """Tell this client of changes of these parameters."""

    op: ClassVar[str] = "subscribeParameterUpdates"
    parameter_names: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class UnsubscribeParameterUpdates:
    """No longer tell this client of them."""

    op: ClassVar[str] = "unsubscribeParameterUpdates"
    parameter_names: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class SubscribeConnectionGraph:
    """Tell this client who talks to whom."""

    op: ClassVar[str] = "subscribeConnectionGraph"


@dataclass(frozen=True, slots=True)
class UnsubscribeConnectionGraph:
    """No longer tell it."""

    op: ClassVar[str] = "unsubscribeConnectionGraph"


@dataclass(frozen=True, slots=True)
class FetchAsset:
    """Ask for a file by its URI."""

    op: ClassVar[str] = "fetchAsset"
    uri: str
    request_id: int


@dataclass(frozen=True, slots=True)
class ClientMessageData:
    """One message of a client's channel."""

    channel_id: int
    payload: bytes


@dataclass(frozen=True, slots=True)
class ServiceRequest:
    """A call; the client chooses `call_id`."""

    service_id: int
    call_id: int
    encoding: str
    payload: bytes


ServerMessage = (
    ServerInfo
    | Status
    | RemoveStatus
    | Advertise
    | Unadvertise
    | AdvertiseServices
    | UnadvertiseServices
    | ParameterValues
    | ConnectionGraphUpdate
    | ServiceCallFailure
    | MessageData
    | Time
    | ServiceResponse
    | AssetResponse
)
ClientMessage = (
    Subscribe
    | Unsubscribe
    | ClientAdvertise
    | ClientUnadvertise
    | GetParameters
    | SetParameters
    | SubscribeParameterUpdates
    | UnsubscribeParameterUpdates
    | SubscribeConnectionGraph
    | UnsubscribeConnectionGraph
    | FetchAsset
    | ClientMessageData
    | ServiceRequest
)

SERVER_JSON: tuple[type[Any], ...] = tuple(kind for kind in get_args(ServerMessage) if hasattr(kind, "op"))
"""Messages of servers that are JSON objects."""

CLIENT_JSON: tuple[type[Any], ...] = tuple(kind for kind in get_args(ClientMessage) if hasattr(kind, "op"))
"""Messages of clients that are JSON objects."""
