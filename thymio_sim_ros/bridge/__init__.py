"""A Foxglove WebSocket server for any source of data: no ROS and no robot in here.

    messages, wire      what is said, and its bytes
    channels            who wants what: all state and decisions, without sockets
    server, thread      sockets and the event loop around them
    transport, outlet   the way out to a client, from either thread
    access              tokens, and what they allow
    turn                whose turn it is to work on all that
    events              what the source of data is told (events) and tells (commands)

Why our own server on `websockets` and not one of the vendor's packages: docs/spec/foxglove.md section 1.
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
