"""Frames of the Aseba network protocol, the part that these tests need.

Source: docs/spec/aseba-protocol.md sections 1.1 and 1.3.
"""

from __future__ import annotations

import socket
import struct
from typing import NamedTuple

from aseba_vm import TargetDescription
from tests.patience import PATIENCE_S

DESCRIPTION, VARIABLE, EVENT, NATIVE = 0x9000, 0x9001, 0x9002, 0x9003
VARIABLES, STATE, PRESENT = 0x9005, 0x900A, 0x900C
GET_DESCRIPTION, SET_BYTECODE, RUN, GET_STATE = 0xA000, 0xA001, 0xA003, 0xA007
GET_VARIABLES, GET_NODE_DESCRIPTION, LIST_NODES = 0xA00B, 0xA010, 0xA011


class Frame(NamedTuple):
    """A message: source node, type, payload."""

    source: int
    kind: int
    payload: bytes

    @property
    def words(self) -> tuple[int, ...]:
        return struct.unpack(f"<{len(self.payload) // 2}H", self.payload)


class Wire:
    """A stream of frames. Every wait ends with a TimeoutError."""

    def __init__(self, stream: socket.socket) -> None:
        self.stream = stream
        stream.settimeout(PATIENCE_S)
        stream.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def send(self, source: int, kind: int, payload: bytes = b"") -> None:
        self.stream.sendall(struct.pack("<HHH", len(payload), source, kind) + payload)

    def send_words(self, source: int, kind: int, *words: int) -> None:
        self.send(source, kind, struct.pack(f"<{len(words)}H", *words))

    def receive(self) -> Frame:
        """Return the next frame. Raises EOFError when the connection is closed."""
        size, source, kind = struct.unpack("<HHH", self._read(6))
        return Frame(source, kind, self._read(size))

    def wait_for(self, *kinds: int) -> Frame:
        """Return the next frame of these types; others are skipped."""
        while (frame := self.receive()).kind not in kinds:
            pass
        return frame

    def _read(self, size: int) -> bytes:
        data = b""
        while len(data) < size:
            part = self.stream.recv(size - len(data))
            if not part:
                raise EOFError
            data += part
        return data


def text(string: str) -> bytes:
    data = string.encode("utf-8")
    return bytes([len(data)]) + data


def describe(wire: Wire, node: int, target: TargetDescription) -> None:
    """Send the description of a node, header first, in one burst."""
    counts = (len(target.variables), len(target.local_events), len(target.natives))
    sizes = (5, target.bytecode_size, target.stack_size, target.variables_size, *counts)
    wire.send(node, DESCRIPTION, text(target.name) + struct.pack("<7H", *sizes))
    for variable in target.variables:
        wire.send(node, VARIABLE, struct.pack("<H", variable.size) + text(variable.name))
    for event in target.local_events:
        wire.send(node, EVENT, text(event.name) + text(event.description))
    for native in target.natives:
        parameters = b"".join(struct.pack("<h", each.size) + text(each.name) for each in native.parameters)
        head = text(native.name) + text(native.description) + struct.pack("<H", len(native.parameters))
        wire.send(node, NATIVE, head + parameters)
