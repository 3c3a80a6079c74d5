"""The clients of a device manager: what each is sent, and what it watches."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import dataclass, field
from uuid import UUID

from thymio_sim_ros.network.tdm.protocol.constants import ErrorCode, Watch
from thymio_sim_ros.network.tdm.protocol.messages import Error, Message, RequestCompleted

__all__ = ["Client", "Clients", "Closing", "Delivery"]


@dataclass(slots=True)
class Client:
    """A connection. `watched` has the flags by the id of a node or group."""

    number: int
    is_local: bool
    """Whether it runs on this computer."""
    joined_ns: int
    is_greeted: bool = False
    """Whether the handshakes have been exchanged."""
    watched: dict[UUID, Watch] = field(default_factory=dict)
    is_congested: bool = False
    """Whether it reads slower than it is sent to; changes of variables are then left out."""
    outdated: set[UUID] = field(default_factory=set)
    """Nodes whose changes were left out."""

    def watches(self, key: UUID, flag: Watch) -> bool:
        """Whether it watches this of a node or group."""
        return bool(self.watched.get(key, Watch.NONE) & flag)


@dataclass(frozen=True, slots=True)
class Delivery:
    """A message for clients."""

    message: Message
    clients: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Closing:
    """A client to be disconnected, and why."""

    client: int
    reason: str


class Clients:
    """All connections, and the messages that wait for them in order."""

    def __init__(self) -> None:
        self._clients: dict[int, Client] = {}
        self._outbox: list[Delivery | Closing] = []

    def __iter__(self) -> Iterator[Client]:
        return iter(tuple(self._clients.values()))

    def get(self, number: int) -> Client | None:
        """A client by number; None if it has left."""
        return self._clients.get(number)

    def add(self, client: Client) -> None:
        """Add a connection."""
        self._clients[client.number] = client

    def remove(self, number: int) -> None:
        """Remove a connection."""
        self._clients.pop(number, None)

    def send(self, client: int, message: Message) -> None:
        """Send a message to one client, unless it has left."""
        self.send_to((client,), message)

    def send_to(self, clients: Iterable[int], message: Message) -> None:
        """Send a message to those of some clients that have not left."""
        present = tuple(client for client in clients if client in self._clients)
        if present:
            self._outbox.append(Delivery(message, present))

    def complete(self, client: int, request_id: int) -> None:
        """Say that a request is done."""
        self.send(client, RequestCompleted(request_id))

    def fail(self, client: int, request_id: int, error: ErrorCode) -> None:
        """Say that a request is rejected."""
        self.send(client, Error(request_id, error))

    def finish(self, client: int, request_id: int, error: ErrorCode) -> None:
        """Say that a request is done, or rejected if there is an error."""
        if error == ErrorCode.NONE:
            self.complete(client, request_id)
        else:
            self.fail(client, request_id, error)

    def broadcast(self, make: Callable[[Client], Message]) -> None:
        """Send each client its own form of a message; equal ones are sent as one."""
        forms: dict[Message, list[int]] = {}
        for client in self._clients.values():
            if client.is_greeted:
                forms.setdefault(make(client), []).append(client.number)
        self._outbox += [Delivery(message, tuple(numbers)) for message, numbers in forms.items()]

    def notify(self, key: UUID, flag: Watch, message: Message, *, skip: Collection[int] = ()) -> None:
        """Send a message to the clients that watch this of a node or group, except those to `skip`."""
        watching = [c for c in self._clients.values() if c.watches(key, flag) and c.number not in skip]
        if flag is Watch.VARIABLES:
            for client in watching:
                if client.is_congested:
                    client.outdated.add(key)
            watching = [client for client in watching if not client.is_congested]
        if watching:
            self._outbox.append(Delivery(message, tuple(client.number for client in watching)))

    def are_watching(self, key: UUID, flag: Watch) -> bool:
        """Whether any client watches this of a node or group."""
        return any(client.watches(key, flag) for client in self._clients.values())

    def close(self, client: int, reason: str) -> None:
        """Disconnect a client."""
        self._outbox.append(Closing(client, reason))

    def pop(self) -> list[Delivery | Closing]:
        """The pending deliveries, in order. They are removed from the queue."""
        outbox, self._outbox = self._outbox, []
        return outbox
