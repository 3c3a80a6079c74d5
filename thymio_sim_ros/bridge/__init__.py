"""A server of Foxglove WebSocket and of rosbridge for any data source, independent of ROS and of robots.

    protocol/                      messages of the protocol and their encoding
    rosbridge/                     a second protocol: operations and their encoding
    switchboard/                   clients, channels and subscriptions: all state and decisions, without sockets;
                                   events to the data source and commands from it
    server, server_thread          sockets and their event loop; settings has their limits
    handshake                      who may connect, by access (tokens) and origin_policy (web pages)
    transport, framing             writing to a client from any thread
    client_send_queue, fair_lock   messages for slow clients; the lock that guards the state

docs/spec/foxglove.md section 1 explains why this is not one of the vendor's packages.
"""

from __future__ import annotations

from thymio_sim_ros.bridge.access import Tokens
from thymio_sim_ros.bridge.protocol.constants import SUBPROTOCOLS, Capability, Role
from thymio_sim_ros.bridge.protocol.errors import BridgeError, FrameError
from thymio_sim_ros.bridge.protocol.messages import ServerInfo
from thymio_sim_ros.bridge.server_thread import ServerThread
from thymio_sim_ros.bridge.settings import EventSink, ServerSettings

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
