"""The connection to a pupil's suite, as a client of its Foxglove bridge.

State and program come in when they change; poses only while they are wanted: without the teacher's page, suites do no
work for them.
"""

from __future__ import annotations

import asyncio
import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from websockets.asyncio.client import ClientConnection, connect

from thymio_sim_ros.bridge.protocol import messages as ms
from thymio_sim_ros.bridge.protocol import wire
from thymio_sim_ros.bridge.protocol.constants import CDR, JSON, SUBPROTOCOLS
from thymio_sim_ros.bridge.protocol.errors import FrameError
from thymio_sim_ros.classroom.cdr import CdrError, read_diagnostic, read_string
from thymio_sim_ros.classroom.suite_state import (
    MissionTry,
    Overview,
    SuiteState,
    SuiteStateError,
    read_overview,
    read_state,
    read_try,
)

__all__ = ["DRAFT", "NODE_DRAFT", "PLAYGROUND", "PROGRAM_NAME", "RAISED_HAND", "SOURCE", "BridgeClient", "SuiteStatus"]

_STATE, _OVERVIEW, _PROGRAM = "/simulator/_state", "/simulator/_overview", "/_aseba/status"
_MISSION, _TRY = "/simulator/_mission", "/simulator/_mission/try"
_PAUSE = "/simulator/pause"
PROGRAM_NAME, SOURCE = "/aseba_runtime.script.name", "/aseba_runtime.script.source"
PLAYGROUND, RAISED_HAND = "/simulator.playground", "/web_ui.raised_hand"
DRAFT, NODE_DRAFT = "/web_ui.draft", "/web_ui.node_draft"
_PAGE = "/web_ui."
_WATCHED = (PROGRAM_NAME, SOURCE, PLAYGROUND, DRAFT, NODE_DRAFT, RAISED_HAND)
_FOLLOWED = (_STATE, _MISSION, _TRY)
_PING_S, _PONG_S = 10.0, 30.0
"""Time between pings, and until a suite without an answer counts as broken; long, for a machine under load."""


@dataclass(slots=True)
class SuiteStatus:
    """The state of a running suite: contents of its topics, None or empty until they have arrived."""

    state: SuiteState | None = None
    overview: Overview = field(default_factory=dict)
    programs: dict[str, dict[str, str]] = field(default_factory=dict)
    """Topic of a robot's program → its values."""
    attempt: MissionTry | None = None
    """The try of the mission that is open."""


class BridgeClient:
    """One connection; `run` serves it until it ends. Only for the thread of its event loop."""

    def __init__(
        self,
        url: str,
        token: str,
        on_parameter: Callable[[str, str | bool], None],
        on_try: Callable[[MissionTry], None],
    ) -> None:
        """`on_parameter` gets name and value of the watched parameters, which are the constants of this module."""
        self._url, self._token, self._on_parameter, self._on_try = url, token, on_parameter, on_try
        self._connection: ClientConnection | None = None
        self._channels: dict[str, int] = {}
        self._topics: dict[int, str] = {}
        """Subscription → topic; its number is that of the channel."""
        self._services: dict[str, int] = {}
        self._wants_overview = False
        self._calls = 0
        self.status = SuiteStatus()
        self.is_ready = asyncio.Event()
        """Set while the connection is open and the state of the world is known."""
        self.has_changed = asyncio.Event()
        """Set when the state of the world or the services have changed; the coroutine that waits for it clears it."""

    async def run(self) -> None:
        """Connect and receive. Raises OSError or WebSocketException (ConnectionClosed) when the connection ends."""
        headers = {"Authorization": f"Bearer {self._token}"}
        async with connect(
            self._url,
            subprotocols=SUBPROTOCOLS,
            additional_headers=headers,
            max_size=None,
            compression=None,
            proxy=None,
            ping_interval=_PING_S,
            ping_timeout=_PONG_S,
        ) as connection:
            self._connection = connection
            try:
                await self._send(ms.SubscribeParameterUpdates(_WATCHED), ms.GetParameters(_WATCHED, "watched"))
                async for frame in connection:
                    await self._receive(frame)
            finally:
                self._connection = None
                self.is_ready.clear()
        raise ConnectionResetError("the bridge has closed the connection")

    async def watch_overview(self, *, wanted: bool) -> None:
        """Subscribe to the overview, or unsubscribe."""
        if wanted != self._wants_overview:
            self._wants_overview = wanted
            await self._follow_overview()

    async def pause(self, *, paused: bool) -> bool:
        """Pause the world or let it run; return whether the request could be sent."""
        service = self._services.get(_PAUSE)
        if service is None:
            return False
        self._calls += 1
        await self._send(ms.ServiceRequest(service, self._calls, JSON, json.dumps({"data": paused}).encode()))
        return True

    async def set_page(self, values: Mapping[str, str | bool]) -> None:
        """Set parameters of the page's node."""
        await self._send(ms.SetParameters(tuple(ms.Parameter(_PAGE + name, value) for name, value in values.items())))

    async def _send(self, *messages: ms.ClientMessage) -> None:
        if self._connection is not None:
            for message in messages:
                await self._connection.send(wire.encode_client(message))

    async def _receive(self, frame: str | bytes) -> None:
        try:
            message = wire.decode_server(frame)
        except FrameError:
            return
        match message:
            case ms.MessageData(subscription_id=number, payload=payload):
                self._read(self._topics.get(number, ""), payload)
            case ms.Advertise(channels=channels):
                self._channels |= {channel.topic: channel.id for channel in channels if channel.encoding == CDR}
                for channel in channels:
                    if channel.topic in _FOLLOWED or channel.topic.endswith(_PROGRAM):
                        await self._subscribe(channel.topic)
                await self._follow_overview()
            case ms.Unadvertise(channel_ids=numbers):
                self._channels = {topic: number for topic, number in self._channels.items() if number not in numbers}
                for number in numbers:
                    self.status.programs.pop(self._topics.pop(number, ""), None)
            case ms.AdvertiseServices(services=services):
                self._services |= {service.name: service.id for service in services if service.name == _PAUSE}
                self.has_changed.set()
            case ms.ParameterValues(parameters=parameters):
                for parameter in parameters:
                    if isinstance(parameter.value, str | bool) and parameter.name in _WATCHED:
                        self._on_parameter(parameter.name, parameter.value)

    async def _subscribe(self, topic: str) -> None:
        number = self._channels[topic]
        if number not in self._topics:
            self._topics[number] = topic
            await self._send(ms.Subscribe((ms.Subscription(number, number),)))

    async def _follow_overview(self) -> None:
        number = self._channels.get(_OVERVIEW)
        if number is None:
            return
        if self._wants_overview:
            await self._subscribe(_OVERVIEW)
        elif self._topics.pop(number, None) is not None:
            await self._send(ms.Unsubscribe((number,)))

    def _read(self, topic: str, payload: bytes) -> None:
        try:
            if topic == _STATE:
                self.status.state = read_state(read_string(payload))
                self.is_ready.set()
                self.has_changed.set()
            elif topic == _OVERVIEW:
                self.status.overview = read_overview(read_string(payload))
            elif topic == _MISSION:
                if read_string(payload) == "null":
                    self.status.attempt = None
            elif topic == _TRY:
                self.status.attempt = read_try(read_string(payload))
                self._on_try(self.status.attempt)
            elif topic:
                self.status.programs[topic] = read_diagnostic(payload)
        except (CdrError, SuiteStateError):
            return  # a pupil's node may publish on these topics, too
