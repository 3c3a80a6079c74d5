"""The first message of a client, and the answer of the device manager."""

from __future__ import annotations

import hmac
from dataclasses import dataclass, field
from uuid import UUID, uuid4

from thymio_sim_ros.network.tdm.conversation.clients import Client
from thymio_sim_ros.network.tdm.conversation.directory import Directory
from thymio_sim_ros.network.tdm.protocol.messages import ConnectionHandshake, Message

__all__ = ["ManagerSettings", "greet"]

VERSION = 1
"""The only version of the protocol."""


@dataclass(frozen=True, slots=True)
class ManagerSettings:
    """Identity and access of a device manager."""

    uuid: UUID = field(default_factory=uuid4)
    ws_port: int = 0
    """Port of its WebSocket server; 0: none."""
    password: str = field(default="", repr=False)
    """The password that clients on other computers must send; empty: none."""


def greet(directory: Directory, client: Client, message: Message, settings: ManagerSettings) -> None:
    """Answer a handshake and send all nodes, or disconnect the client."""
    if not isinstance(message, ConnectionHandshake):
        directory.clients.close(client.number, f"expected a handshake first, found {type(message).__name__}")
        return
    if not message.min_protocol_version <= VERSION <= message.protocol_version:
        found = f"{message.min_protocol_version} to {message.protocol_version}"
        directory.clients.close(client.number, f"expected version {VERSION} of the protocol, found {found}")
        return
    is_known = hmac.compare_digest(message.password.encode(), settings.password.encode())
    if settings.password and not client.is_local and not is_known:
        directory.clients.close(client.number, "wrong or missing password")
        return
    client.is_greeted = True
    reply = ConnectionHandshake(
        localhost_peer=client.is_local, ws_port=settings.ws_port, uuid=settings.uuid, password=message.password
    )
    directory.clients.send(client.number, reply)
    directory.clients.send(client.number, directory.nodes_message(client))
