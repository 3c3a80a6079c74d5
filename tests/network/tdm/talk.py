"""A device manager with nodes in memory, and clients that collect what they are sent."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from typing import TypeVar
from uuid import UUID

from aseba_vm import protocol as p
from tests.network.tdm.machine_node import MachineNode
from thymio_sim_ros.device.programs.program import ThymioProgram
from thymio_sim_ros.network.tdm.conversation.clients import Closing, Delivery
from thymio_sim_ros.network.tdm.conversation.device_manager import DeviceManager
from thymio_sim_ros.network.tdm.conversation.handshake import ManagerSettings
from thymio_sim_ros.network.tdm.protocol import messages as m
from thymio_sim_ros.network.tdm.protocol.constants import Command, CompileOption, NodeType
from thymio_sim_ros.network.tdm.protocol.values import decode_value

T = TypeVar("T", bound=m.Message)

MS = 1_000_000


class Talk:
    """Everything that is sent arrives at once. Ids count from 1: the group, then the node, of each network."""

    def __init__(self, *nodes: MachineNode, settings: ManagerSettings | None = None) -> None:
        """Each node is alone on its network."""
        self._ids = iter(range(1, 1000))
        self.now_ns = 0
        self.manager = DeviceManager(
            settings or ManagerSettings(UUID(int=0)), 0, new_id=lambda: UUID(int=next(self._ids))
        )
        self.networks: dict[int, list[MachineNode]] = {}
        self.received: dict[int, list[m.Message]] = defaultdict(list)
        self.closed: dict[int, str] = {}
        self.programs: list[tuple[int, ThymioProgram]] = []
        """Texts of programs, with their networks."""
        self.is_silent = False
        """Whether nodes do not answer."""
        self._requests = iter(range(100, 100_000))
        for node in nodes:
            self.add_network([node])

    def add_network(self, nodes: list[MachineNode], kind: NodeType = NodeType.SIMULATED_THYMIO) -> None:
        """Add a network of nodes that are called thymio_<number>."""
        number = len(self.networks)
        self.networks[number] = nodes
        self.manager.add_network(number, kind=kind, name=f"thymio_{number}")
        self.exchange()

    def join(self, client: int, *, is_local: bool = True, password: str = "") -> None:
        """Connect a client and exchange handshakes."""
        self.manager.join(client, is_local=is_local)
        self.send(client, m.ConnectionHandshake(password=password))

    def send(self, client: int, message: m.Message) -> None:
        """A client sends a message; compilations are executed."""
        compilation = self.manager.receive(client, message)
        self.exchange()
        if compilation is not None:
            self.manager.finish_compilation(compilation, compilation.run())
            self.exchange()

    def ask(self, client: int, kind: type[m.Message], key: UUID, *fields: object) -> m.Message:
        """Send a request, and return its only answer."""
        number = next(self._requests)
        self.send(client, kind(number, key, *fields))  # type: ignore[call-arg]
        answers = [message for message in self.received[client] if getattr(message, "request_id", None) == number]
        assert len(answers) == 1, answers
        return answers[0]

    def command(self, client: int, key: UUID, command: Command) -> m.Message:
        """Send a command to the machine of a node."""
        return self.ask(client, m.SetVMExecutionState, key, command)

    def load(self, client: int, key: UUID, text: str) -> m.Message:
        """Compile and load a program."""
        return self.ask(client, m.CompileAndLoadCodeOnVM, key, 1, text, CompileOption.LOAD_ON_TARGET)

    def exchange(self) -> None:
        """Deliver messages until none is left."""
        self.programs += self.manager.pop_programs()
        while messages := self.manager.pop_messages():
            for number, message in messages:
                for node in () if self.is_silent else self.networks[number]:
                    self.from_node(number, node.handle(message))
        for delivery in self.manager.pop_deliveries():
            if isinstance(delivery, Delivery):
                for client in delivery.clients:
                    self.received[client].append(delivery.message)
            elif isinstance(delivery, Closing):
                self.closed[delivery.client] = delivery.reason
                self.manager.leave(delivery.client)

    def from_node(self, number: int, messages: Iterable[p.Message]) -> None:
        """Messages of a node of a network arrive."""
        for message in messages:
            self.manager.receive_from_network(number, message)

    def run(self, number: int = 0) -> None:
        """The first node of a network executes its handler."""
        self.from_node(number, self.networks[number][0].run())
        self.exchange()

    def advance(self, milliseconds: int) -> None:
        """Time passes, 50 ms at a time."""
        for _ in range(milliseconds // 50):
            self.now_ns += 50 * MS
            self.manager.advance(self.now_ns)
            self.exchange()

    def take(self, client: int, kind: type[T]) -> list[T]:
        """Remove and return what a client has been sent of a kind."""
        found = [message for message in self.received[client] if isinstance(message, kind)]
        self.received[client] = [message for message in self.received[client] if not isinstance(message, kind)]
        return found


def values(message: m.VariablesChanged | m.EventsEmitted) -> dict[str, tuple[int, ...]]:
    """The values of a message by name."""
    parts = message.vars if isinstance(message, m.VariablesChanged) else message.events
    return {part.name: decode_value(part.value) for part in parts}
