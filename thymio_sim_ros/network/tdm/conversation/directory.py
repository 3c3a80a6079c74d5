"""The state of the device manager: its clients, nodes and groups, and the time."""

from __future__ import annotations

from uuid import UUID

from thymio_sim_ros.device.programs.program import ThymioProgram
from thymio_sim_ros.network.tdm.conversation.clients import Client, Clients
from thymio_sim_ros.network.tdm.conversation.group import Group
from thymio_sim_ros.network.tdm.conversation.managed_node import ManagedNode
from thymio_sim_ros.network.tdm.protocol.constants import Capability, Status
from thymio_sim_ros.network.tdm.protocol.messages import Node, NodesChanged

__all__ = ["Directory"]

_NS_PER_MS = 1_000_000


class Directory:
    """Clients, nodes and groups. A node is locked by at most one client."""

    def __init__(self) -> None:
        self.clients = Clients()
        self.nodes: dict[UUID, ManagedNode] = {}
        self.now_ns = 0
        self.programs: list[tuple[int, ThymioProgram]] = []
        """Programs that are about to be loaded, each with the number of its network."""

    @property
    def time_ms(self) -> int:
        """The time for messages, ms."""
        return self.now_ns // _NS_PER_MS

    def node(self, key: UUID | None) -> ManagedNode | None:
        """A node by id; None for an unknown one."""
        return None if key is None else self.nodes.get(key)

    def locked_node(self, client: Client, key: UUID | None) -> ManagedNode | None:
        """A node by id if this client has locked it."""
        node = self.node(key)
        return node if node is not None and node.locker == client.number else None

    def locked_nodes(self, client: Client, key: UUID | None) -> list[ManagedNode]:
        """The nodes that this client has locked and that have this id, or belong to the group with this id."""
        locked = (node for node in self.nodes.values() if node.locker == client.number)
        return [node for node in locked if key in (node.id, node.group.id)]

    def group(self, key: UUID | None) -> Group | None:
        """A group by its id or that of one of its nodes."""
        return next((node.group for node in self.nodes.values() if key in (node.id, node.group.id)), None)

    def lock(self, node: ManagedNode, client: Client) -> None:
        """Give a node to a client."""
        node.locker = client.number
        self.announce(node)

    def unlock(self, node: ManagedNode) -> None:
        """Take a node back."""
        node.locker = None
        self.announce(node)

    def announce(self, node: ManagedNode, status: Status | None = None) -> None:
        """Send a changed node to all clients; `status` replaces the one that follows from its lock."""
        self.clients.broadcast(lambda client: NodesChanged((self._description(node, client, status),)))

    def nodes_message(self, client: Client) -> NodesChanged:
        """All nodes, as a client sees them."""
        return NodesChanged(tuple(self._description(node, client) for node in self.nodes.values()))

    @staticmethod
    def _description(node: ManagedNode, client: Client, status: Status | None = None) -> Node:
        if status is None:
            status = Status.BUSY if node.locker is not None else Status.AVAILABLE
            status = Status.READY if node.locker == client.number else status
        capabilities = Capability.RENAME | Capability.FORCE_RESET_AND_STOP if client.is_local else Capability(0)
        firmware = node.firmware
        return Node(node.id, node.group.id, status, node.kind, node.name, capabilities, firmware, firmware)
