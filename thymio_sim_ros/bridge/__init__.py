"""A Foxglove WebSocket server for any data source, independent of ROS and of robots.

    messages, wire                 messages of the protocol and their encoding
    switchboard                    clients, channels and subscriptions: all state and decisions, without sockets
    server, server_thread          sockets and their event loop
    transport, client_send_queue   writing to a client from any thread; messages for slow clients
    access, origin_policy          tokens, roles and allowed web pages
    fair_lock                      the lock that guards the state
    events                         values exchanged with the data source: events to it, commands from it

docs/spec/foxglove.md section 1 explains why this is not one of the vendor's packages.
"""

from __future__ import annotations

from thymio_sim_ros.bridge.access import Role, Tokens
from thymio_sim_ros.bridge.constants import SUBPROTOCOLS, Capability
from thymio_sim_ros.bridge.errors import BridgeError, FrameError
from thymio_sim_ros.bridge.messages import ServerInfo
from thymio_sim_ros.bridge.server import EventSink, ServerSettings
from thymio_sim_ros.bridge.server_thread import ServerThread

__all__ = [
    "SUBPROTOCOLS",
    "BridgeError",
    "Capability",
    "EventSink",
    "FrameError",
    "Role",
    "ServerInfo",
    "ServerSettings",
    "ServerThread",
    "Tokens",
]
