"""A server of Foxglove WebSocket and of rosbridge for any data source, independent of ROS and of robots.

    protocol/                      messages of the protocol and their encoding
    rosbridge/                     a second protocol: operations and their encoding
    switchboard/                   clients, channels and subscriptions: all state and decisions, without sockets;
                                   events to the data source and commands from it
    server                         clients around the switchboard, without sockets; settings has their limits
    websocket                      one client on a WebSocket of aiohttp; client_send_queue: messages for it
    handshake                      sub-protocols; `access` decides who may connect
    connections, throttle          limits of connections, and of the time of busy clients; fair_queue: who is next
    listening                      listening sockets of all servers

docs/spec/foxglove.md section 1 explains why this is not one of the vendor's packages.
"""

from __future__ import annotations

from thymio_sim_ros.access import Role, Tokens
from thymio_sim_ros.bridge.protocol.constants import SUBPROTOCOLS, Capability
from thymio_sim_ros.bridge.protocol.errors import BridgeError, FrameError
from thymio_sim_ros.bridge.protocol.messages import ServerInfo
from thymio_sim_ros.bridge.server import BridgeServer
from thymio_sim_ros.bridge.settings import EventSink, ServerSettings

__all__ = [
    "SUBPROTOCOLS",
    "BridgeError",
    "BridgeServer",
    "Capability",
    "EventSink",
    "FrameError",
    "Role",
    "ServerInfo",
    "ServerSettings",
    "Tokens",
]
