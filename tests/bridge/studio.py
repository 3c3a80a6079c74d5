"""A Foxglove client for tests that spin an executor: nothing in it blocks."""

from __future__ import annotations

import ssl
from collections.abc import Callable
from types import TracebackType
from typing import TypeVar

from websockets.sync.client import ClientConnection, connect

from thymio_sim_ros.bridge import SUBPROTOCOLS
from thymio_sim_ros.bridge.protocol import messages as ms
from thymio_sim_ros.bridge.protocol import wire
from thymio_sim_ros.bridge.protocol.constants import CDR

T = TypeVar("T")


class Studio:
    """Knows the advertised channels and services; `until`, given by the test, spins the executor."""

    def __init__(self, port: int, until: Callable[..., object], *, tls: ssl.SSLContext | None = None) -> None:
        url = f"ws://127.0.0.1:{port}" if tls is None else f"wss://localhost:{port}"
        self._connecting = connect(url, subprotocols=SUBPROTOCOLS, max_size=None, max_queue=None, ssl=tls)
        self._until = until
        self.channels: dict[str, ms.Channel] = {}
        self.services: dict[str, ms.Service] = {}
        self.received: list[ms.ServerMessage] = []
        """Everything else, in order; `next` takes from here."""

    def __enter__(self) -> Studio:
        self._connection: ClientConnection = self._connecting.__enter__()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._connecting.__exit__(kind, error, trace)

    def send(self, *messages: ms.ClientMessage) -> None:
        """Send messages."""
        for message in messages:
            self._connection.send(wire.encode_client(message))

    def next(self, kind: type[T], where: Callable[[T], bool] = lambda message: True) -> T:
        """The next message of this kind that satisfies the condition; earlier ones are dropped."""

        def found() -> bool:
            self.read()
            return any(isinstance(message, kind) and where(message) for message in self.received)

        self._until(found, what=f"a {kind.__name__}; received {self.received[-5:]}")
        while True:
            message = self.received.pop(0)
            if isinstance(message, kind) and where(message):
                return message

    def channel(self, topic: str) -> ms.Channel:
        """The channel of a topic, once it is advertised."""
        self._until(lambda: topic in self.read().channels, what=f"channel {topic}")
        return self.channels[topic]

    def service(self, name: str) -> ms.Service:
        """A service, once it is advertised."""
        self._until(lambda: name in self.read().services, what=f"service {name}")
        return self.services[name]

    def subscribe(self, subscription: int, topic: str) -> None:
        """Subscribe to a topic."""
        self.send(ms.Subscribe((ms.Subscription(subscription, self.channel(topic).id),)))

    def advertise(self, number: int, topic: str, schema: str, encoding: str = CDR) -> None:
        """Open a client channel."""
        self.send(ms.ClientAdvertise((ms.ClientChannel(number, topic, encoding, schema),)))

    def parameter(self, name: str) -> ms.ParameterValue:
        """The value of a parameter, once it is known."""
        values: list[ms.Parameter] = []

        def known() -> bool:
            self.send(ms.GetParameters((name,), "look"))
            values[:] = self.next(ms.ParameterValues, lambda answer: answer.id == "look").parameters
            return bool(values)

        self._until(known, what=f"parameter {name}")
        return values[0].value

    def read(self) -> Studio:
        """Process received messages; return the client."""
        while True:
            try:
                message = wire.decode_server(self._connection.recv(timeout=0))
            except TimeoutError:
                return self
            if isinstance(message, ms.Advertise):
                self.channels.update((channel.topic, channel) for channel in message.channels)
            elif isinstance(message, ms.AdvertiseServices):
                self.services.update((service.name, service) for service in message.services)
            elif isinstance(message, ms.Unadvertise):
                self.channels = {k: v for k, v in self.channels.items() if v.id not in message.channel_ids}
            elif isinstance(message, ms.UnadvertiseServices):
                self.services = {k: v for k, v in self.services.items() if v.id not in message.service_ids}
            else:
                self.received.append(message)


def set_and_answer(studio: Studio, *parameters: ms.Parameter) -> list[ms.ServerMessage]:
    """Set parameters; return all messages until the answer."""
    studio.read()
    studio.received.clear()
    studio.send(ms.SetParameters(parameters, "mine"))
    messages: list[ms.ServerMessage] = []
    while not (messages and isinstance(messages[-1], ms.ParameterValues) and messages[-1].id == "mine"):
        messages.append(studio.next(object))
    return messages
