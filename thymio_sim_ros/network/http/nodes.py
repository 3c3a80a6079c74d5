"""The nodes of all networks as requests name them: by number, type and robot."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

from aseba_vm import Program
from aseba_vm.protocol.node_client import NodeClient
from aseba_vm.protocol.remote_node import RemoteNode
from thymio_sim_ros.access import RefusedError
from thymio_sim_ros.network.http.replies import Definitions, NodeView

__all__ = ["Directory", "Key"]

NUMBER_STEP = 20
"""The number added to the id of a node, repeatedly, until no other node has the sum, as in the reference."""

Key = tuple[int, int]
"""A node: number of its network, and its id there."""


@dataclass(slots=True)
class _Network:
    """A network; `program` is that of its robot, `definitions` belong to its nodes."""

    client: NodeClient
    robot: str
    program: Program | None = None
    program_definitions: Definitions = field(default=Definitions())
    definitions: dict[int, Definitions] = field(default_factory=dict)


class Directory:
    """All networks, in the order in which they were added, and their nodes."""

    def __init__(self) -> None:
        """Create a directory without networks."""
        self._networks: dict[int, _Network] = {}
        self._numbers = itertools.count()

    def add(self, client: NodeClient, robot: str) -> int:
        """Add a network, with the name of its robot; return its number."""
        number = next(self._numbers)
        self._networks[number] = _Network(client, robot)
        return number

    def remove(self, network: int) -> None:
        """Remove a network."""
        del self._networks[network]

    @property
    def clients(self) -> Mapping[int, NodeClient]:
        """The client of each network."""
        return MappingProxyType({number: network.client for number, network in self._networks.items()})

    def client(self, key: Key) -> NodeClient:
        """The client of the network of a node."""
        return self._networks[key[0]].client

    def remote(self, key: Key) -> RemoteNode | None:
        """A node; None if it is gone."""
        network = self._networks.get(key[0])
        return None if network is None else network.client.nodes.get(key[1])

    def definitions(self, key: Key) -> Definitions:
        """Events and constants of the program of a node; none if they are not known."""
        return self._networks[key[0]].definitions.get(key[1], Definitions())

    def define(self, key: Key, definitions: Definitions) -> None:
        """Set events and constants of the program of a node."""
        self._networks[key[0]].definitions[key[1]] = definitions

    def set_program(self, number: int, program: Program, definitions: Definitions) -> None:
        """Set what is known of the program of a network's robot."""
        network = self._networks[number]
        network.program, network.program_definitions = program, definitions
        for node in network.client.nodes:
            self.apply_program((number, node))

    def apply_program(self, key: Key) -> None:
        """Give a node the names of the program of its robot, if that is known."""
        network = self._networks[key[0]]
        if network.program is not None:
            network.client.note_program(key[1], network.program)
            self.define(key, network.program_definitions)

    def views(self) -> dict[Key, NodeView]:
        """All nodes in order. A node whose id is taken by one of a network before it gets another number."""
        numbers: set[int] = set()
        found = {}
        for key, robot, remote in self._all():
            number = remote.number
            while number in numbers:
                number += NUMBER_STEP
            numbers.add(number)
            found[key] = NodeView(number, robot, remote, self.definitions(key))
        return found

    def find(self, text: str) -> Key:
        """The node of this robot, else of this type, with this number, or of a type that begins so: the first of them.

        Raises RefusedError.
        """
        views = self.views()
        for matches in (
            lambda view: view.robot == text,
            lambda view: view.remote.description.name == text,
            lambda view: str(view.number) == text,
            lambda view: view.remote.description.name.startswith(text),
        ):
            for key, view in views.items():
                if matches(view):
                    return key
        known = ", ".join(f"{view.number} ({view.robot or view.remote.description.name})" for view in views.values())
        raise RefusedError(404, f"no node {text[:80]!r}; expected {known or 'a node, but none is connected'}")

    def event(self, key: Key, name: str) -> tuple[int, int] | None:
        """Number and size of an event of a program; None for an unknown name."""
        return self.definitions(key).event(name)

    def address(self, key: Key, name: str) -> tuple[int, int]:
        """Address and size of a variable. Raises RefusedError."""
        found = self.client(key).nodes[key[1]].addresses.get(name)
        if found is None:
            raise RefusedError(404, f"no variable and no event {name[:80]!r} on this node")
        return found

    def _all(self) -> Iterator[tuple[Key, str, RemoteNode]]:
        for number, network in self._networks.items():
            for node, remote in sorted(network.client.nodes.items()):
                yield (number, node), network.robot, remote
