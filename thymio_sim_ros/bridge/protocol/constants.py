"""Constants of the Foxglove WebSocket protocol: sub-protocols, capabilities, encodings, opcodes, status levels.

Opcodes and levels come from `foxglove-websocket`, the package that defined them. Its module `types` imports only the
standard library, so the deprecated `websockets.legacy`, which its server needs, is not loaded. What the package lacks
(assets, capability names) is added here. Facts: docs/spec/foxglove.md section 2.
"""

from __future__ import annotations

from enum import StrEnum

from foxglove_websocket.types import (  # type: ignore[import-untyped]  # ships without py.typed
    BinaryOpcode,
    ClientBinaryOpcode,
    StatusLevel,
)
from websockets.typing import Subprotocol

__all__ = [
    "ASSET_OPCODE",
    "CDR",
    "JSON",
    "MAX_ID",
    "SUBPROTOCOLS",
    "BinaryOpcode",
    "Capability",
    "ClientBinaryOpcode",
    "StatusLevel",
]

SUBPROTOCOLS = (Subprotocol("foxglove.sdk.v1"), Subprotocol("foxglove.websocket.v1"))
"""Two names of one wire format, the preferred first."""

ASSET_OPCODE = 4
"""Opcode of an asset, server → client; `foxglove-websocket` does not have it."""

MAX_ID = 0xFFFF_FFFF
"""IDs are unsigned 32-bit integers, also in JSON."""

CDR = "cdr"
JSON = "json"


class Capability(StrEnum):
    """A capability that a server announces in serverInfo; `time` if and only if it uses simulated time."""

    CLIENT_PUBLISH = "clientPublish"
    PARAMETERS = "parameters"
    PARAMETERS_SUBSCRIBE = "parametersSubscribe"
    SERVICES = "services"
    CONNECTION_GRAPH = "connectionGraph"
    ASSETS = "assets"
    TIME = "time"
