"""The messages of the protocol as frozen values (docs/spec/foxglove.md section 2).

JSON messages have an `op`; their other keys are the camelCase names of the fields. An `int` is an unsigned 32-bit ID.
An optional field is left out if it is None. Messages without `op` are binary. `wire` encodes and decodes all of them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar, get_args

from thymio_sim_ros.bridge.protocol.constants import StatusLevel

# --- parts ---------------------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Channel:
    """A stream of messages of one topic, which clients can subscribe to."""

    id: int
    topic: str
    encoding: str
    schema_name: str
    schema: str
    schema_encoding: str | None = None


@dataclass(frozen=True, slots=True)
class ClientChannel:
    """A stream of messages that a client publishes; the client chooses the ID."""

    id: int
    topic: str
    encoding: str
    schema_name: str
    schema: str | None = None
    schema_encoding: str | None = None


@dataclass(frozen=True, slots=True)
class Subscription:
    """A subscription of a client to a channel; the client chooses the ID."""

    id: int
    channel_id: int


@dataclass(frozen=True, slots=True)
class ServiceSide:
    """Encoding and schema of the requests or of the responses of a service."""

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
    """A named value; None: not set. `type` is float64, float64_array or byte_array (base64) where JSON is ambiguous."""

    name: str
    value: ParameterValue = None
    type: str | None = None


@dataclass(frozen=True, slots=True)
class PublishedTopic:
    """The publishers of a topic, as node names /ns/node."""

    name: str
    publisher_ids: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class SubscribedTopic:
    """The subscribers of a topic, as node names."""

    name: str
    subscriber_ids: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class AdvertisedService:
    """The servers of a service, as node names."""

    name: str
    provider_ids: tuple[str, ...]


# --- server → client -----------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class ServerInfo:
    """First message to each client; a new session ID makes clients drop their state."""

    op: ClassVar[str] = "serverInfo"
    name: str
    capabilities: tuple[str, ...]
    supported_encodings: tuple[str, ...] = ()
    metadata: Mapping[str, str] = field(default_factory=dict)
    session_id: str | None = None


@dataclass(frozen=True, slots=True)
class Status:
    """A message for the user; with an ID it can be replaced or removed."""

    op: ClassVar[str] = "status"
    level: StatusLevel
    message: str
    id: str | None = None


def parameter_status(name: str) -> str:
    """ID of the status with the reason why a parameter was not set."""
    return f"parameter:{name}"


@dataclass(frozen=True, slots=True)
class RemoveStatus:
    """Remove statuses that no longer apply."""

    op: ClassVar[str] = "removeStatus"
    status_ids: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Advertise:
    """New channels."""

    op: ClassVar[str] = "advertise"
    channels: tuple[Channel, ...]


@dataclass(frozen=True, slots=True)
class Unadvertise:
    """Removed channels."""

    op: ClassVar[str] = "unadvertise"
    channel_ids: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class AdvertiseServices:
    """New services."""

    op: ClassVar[str] = "advertiseServices"
    services: tuple[Service, ...]


@dataclass(frozen=True, slots=True)
class UnadvertiseServices:
    """Removed services."""

    op: ClassVar[str] = "unadvertiseServices"
    service_ids: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class ParameterValues:
    """Current values; `id` is that of the request, None for an update."""

    op: ClassVar[str] = "parameterValues"
    parameters: tuple[Parameter, ...]
    id: str | None = None


@dataclass(frozen=True, slots=True)
class ConnectionGraphUpdate:
    """Publishers, subscribers and services: the first update is complete, later ones are differences."""

    op: ClassVar[str] = "connectionGraphUpdate"
    published_topics: tuple[PublishedTopic, ...] = ()
    subscribed_topics: tuple[SubscribedTopic, ...] = ()
    advertised_services: tuple[AdvertisedService, ...] = ()
    removed_topics: tuple[str, ...] = ()
    removed_services: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class ServiceCallFailure:
    """The reason why a call failed."""

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
    """Answer to the `ServiceRequest` with the same IDs."""

    service_id: int
    call_id: int
    encoding: str
    payload: bytes


@dataclass(frozen=True, slots=True)
class AssetResponse:
    """A file, or the reason why there is none (`error`; `data` is then empty)."""

    request_id: int
    data: bytes
    error: str | None = None


# --- client → server -----------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Subscribe:
    """Subscribe to channels."""

    op: ClassVar[str] = "subscribe"
    subscriptions: tuple[Subscription, ...]


@dataclass(frozen=True, slots=True)
class Unsubscribe:
    """End subscriptions."""

    op: ClassVar[str] = "unsubscribe"
    subscription_ids: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class ClientAdvertise:
    """Open channels on which the client is going to publish."""

    op: ClassVar[str] = "advertise"
    channels: tuple[ClientChannel, ...]


@dataclass(frozen=True, slots=True)
class ClientUnadvertise:
    """Close channels of the client."""

    op: ClassVar[str] = "unadvertise"
    channel_ids: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class GetParameters:
    """Request values; without names: of all parameters."""

    op: ClassVar[str] = "getParameters"
    parameter_names: tuple[str, ...]
    id: str | None = None


@dataclass(frozen=True, slots=True)
class SetParameters:
    """Request to set values."""

    op: ClassVar[str] = "setParameters"
    parameters: tuple[Parameter, ...]
    id: str | None = None


@dataclass(frozen=True, slots=True)
class SubscribeParameterUpdates:
    """Subscribe to updates of these parameters."""

    op: ClassVar[str] = "subscribeParameterUpdates"
    parameter_names: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class UnsubscribeParameterUpdates:
    """Unsubscribe from updates of these parameters."""

    op: ClassVar[str] = "unsubscribeParameterUpdates"
    parameter_names: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class SubscribeConnectionGraph:
    """Subscribe to the connection graph."""

    op: ClassVar[str] = "subscribeConnectionGraph"


@dataclass(frozen=True, slots=True)
class UnsubscribeConnectionGraph:
    """Unsubscribe from the connection graph."""

    op: ClassVar[str] = "unsubscribeConnectionGraph"


@dataclass(frozen=True, slots=True)
class FetchAsset:
    """Request a file by its URI."""

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
    """A call of a service; the client chooses `call_id`."""

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
