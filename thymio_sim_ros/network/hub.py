"""Networks of Aseba nodes and their clients: who gets which message. Only for the thread of the event loop.

A message of a client goes to the nodes of its network. A reply goes to the client that asked, since clients differ in
the versions that they accept; all other messages of a node go to all clients of the network.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Protocol

from aseba_vm.protocol import Message
from thymio_sim_ros.device.programs.program import ThymioProgram

__all__ = ["Connection", "Hub", "HubListener", "Network", "Nodes", "Receive"]

Receive = Callable[[Sequence[Message]], None]
"""Takes messages for a client, in order."""

_CLIENTS = itertools.count(1)
"""Numbers of clients."""


class Nodes(Protocol):
    """The nodes of a network, wherever they are. Calls must not block and raise no errors."""

    def connect(self, client: int, /) -> None:
        """Add a client."""

    def disconnect(self, client: int, /) -> None:
        """Remove a client."""

    def send(self, client: int, messages: Sequence[Message], /) -> None:
        """Pass messages of a client to the nodes."""

    def is_full(self, client: int, /) -> bool:
        """Whether the client should pause, because too many of its messages wait."""


class Connection:
    """A client of a network."""

    def __init__(self, network: Network, client: int) -> None:
        """`client`: its number, different from that of all other clients."""
        self.client = client
        self._network = network

    @property
    def network(self) -> Network:
        """The network."""
        return self._network

    @property
    def is_full(self) -> bool:
        """Whether the client should pause, because too many of its messages wait. `send` still accepts messages."""
        return self._network.nodes.is_full(self.client)

    def send(self, *messages: Message) -> None:
        """Send messages to the nodes; after `close` they are dropped."""
        if self.client in self._network:
            self._network.nodes.send(self.client, messages)

    def remember(self, program: ThymioProgram) -> None:
        """Give the text of a program whose bytecode follows, so that a simulated robot shows it."""
        if self.client in self._network:
            self._network.remember(self.client, program)

    def close(self) -> None:
        """Leave the network; a second call has no effect."""
        self._network.remove(self.client)


class Network:
    """The nodes behind one stream, and their clients."""

    def __init__(
        self, name: str, nodes: Nodes, *, place: int = 0, node_ids: Sequence[int] = (), is_simulated: bool = True
    ) -> None:
        """`name`: that of the robot, or ""; `place`: of the robot among all, from 0, which decides its port.

        `node_ids`: numbers of the nodes when the network was created, if they are known.
        """
        self.name = name
        self.nodes = nodes
        self.place = place
        self.node_ids = tuple(node_ids)
        self.is_simulated = is_simulated
        self.program: ThymioProgram | None = None
        """The program of the robot, if it is known."""
        self.followers: list[Callable[[Network], None]] = []
        """Called when `program` has changed."""
        self.remember: Callable[[int, ThymioProgram], None] = lambda client, program: None
        """Takes the texts of programs from clients, by number."""
        self._receivers: dict[int, Receive] = {}

    def __contains__(self, client: int) -> bool:
        return client in self._receivers

    def connect(self, receive: Receive) -> Connection:
        """Add a client; `receive` is called with each group of messages for it."""
        client = next(_CLIENTS)
        self._receivers[client] = receive
        self.nodes.connect(client)
        return Connection(self, client)

    def remove(self, client: int) -> None:
        """Remove a client, if it is there."""
        if self._receivers.pop(client, None) is not None:
            self.nodes.disconnect(client)

    def set_program(self, program: ThymioProgram) -> None:
        """Note which program the robot has."""
        self.program = program
        for follower in list(self.followers):
            follower(self)

    def deliver(self, messages: Sequence[Message], client: int | None = None) -> None:
        """Pass messages of the nodes to a client that may have left already, or to all clients."""
        if client is None:
            for receive in list(self._receivers.values()):
                receive(messages)
        elif client in self._receivers:
            self._receivers[client](messages)


class HubListener(Protocol):
    """A server that follows the networks of a hub."""

    def network_added(self, network: Network, /) -> None:
        """A network is there."""

    def network_removed(self, network: Network, /) -> None:
        """A network is not there any more; its clients get no further messages."""


class Hub:
    """All networks, in the order in which they were added."""

    def __init__(self) -> None:
        self._networks: list[Network] = []
        self._listeners: list[HubListener] = []

    def __iter__(self) -> Iterator[Network]:
        return iter(self._networks)

    def __len__(self) -> int:
        return len(self._networks)

    @property
    def by_name(self) -> Mapping[str, Network]:
        """The networks by name."""
        return {network.name: network for network in self._networks}

    def add(self, network: Network) -> None:
        """Add a network."""
        self._networks.append(network)
        for listener in list(self._listeners):
            listener.network_added(network)

    def remove(self, network: Network) -> None:
        """Remove a network; a second call has no effect."""
        if network in self._networks:
            self._networks.remove(network)
            for listener in list(self._listeners):
                listener.network_removed(network)

    def follow(self, listener: HubListener) -> None:
        """Report all networks to a listener, those that are there at once."""
        self._listeners.append(listener)
        for network in list(self._networks):
            listener.network_added(network)

    def unfollow(self, listener: HubListener) -> None:
        """Report nothing to a listener any more."""
        self._listeners.remove(listener)
