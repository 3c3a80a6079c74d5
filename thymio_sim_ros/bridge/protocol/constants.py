"""The words of the Foxglove WebSocket protocol: sub-protocols, capabilities, encodings, opcodes, status levels.

Opcodes and levels come from `foxglove-websocket`, the package that defined them. Its vocabulary module imports nothing
but the standard library, so the deprecated `websockets.legacy` behind its server stays out of our process; what it
lacks (assets, capability names) is added here. Facts: docs/spec/foxglove.md section 2.
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
    "Role",
    "StatusLevel",
]

SUBPROTOCOLS = (Subprotocol("foxglove.sdk.v1"), Subprotocol("foxglove.websocket.v1"))
"""Two names of one wire format, the preferred first."""

ASSET_OPCODE = 4
"""Server → client; younger than the package that gives the other opcodes."""

MAX_ID = 0xFFFF_FFFF
"""Ids are unsigned 32-bit numbers, in JSON too."""

CDR = "cdr"
JSON = "json"


class Capability(StrEnum):
    """What a server may announce in serverInfo; `time` exactly when simulated time is used."""

    CLIENT_PUBLISH = "clientPublish"
    PARAMETERS = "parameters"
    PARAMETERS_SUBSCRIBE = "parametersSubscribe"
    SERVICES = "services"
    CONNECTION_GRAPH = "connectionGraph"
    ASSETS = "assets"
    TIME = "time"


class Role(StrEnum):
    """What a client may do; sent to read-only clients in the metadata of serverInfo (key `access`)."""

    FULL = "full"
    READ_ONLY = "read_only"
