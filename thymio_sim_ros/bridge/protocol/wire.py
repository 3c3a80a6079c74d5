"""Conversion of frames and messages: text frames are JSON, binary frames begin with an opcode.

There is one table for each direction and form (docs/spec/foxglove.md section 2). The server uses one half of the
functions, tests and clients the other. Decoders raise FrameError for any frame that violates the protocol, and no
other exception.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Callable, Mapping
from typing import Any

from thymio_sim_ros.bridge.protocol import bounded_json
from thymio_sim_ros.bridge.protocol.constants import ASSET_OPCODE, BinaryOpcode, ClientBinaryOpcode
from thymio_sim_ros.bridge.protocol.errors import FrameError
from thymio_sim_ros.bridge.protocol.json_codec import describe, reader, writer
from thymio_sim_ros.bridge.protocol.messages import (
    CLIENT_JSON,
    SERVER_JSON,
    AssetResponse,
    ClientMessage,
    ClientMessageData,
    MessageData,
    ServerMessage,
    ServiceRequest,
    ServiceResponse,
    Time,
)

__all__ = ["DATA_HEAD_SIZE", "data_head", "decode_client", "decode_server", "encode_client", "encode_server"]

Frame = str | bytes

_DATA = struct.Struct("<BIQ")
_TIME = struct.Struct("<BQ")
_CLIENT_DATA = struct.Struct("<BI")
_CALL = struct.Struct("<BIII")
_ASSET = struct.Struct("<BIBI")

_MESSAGE_DATA = int(BinaryOpcode.MESSAGE_DATA)


DATA_HEAD_SIZE = _DATA.size
"""Size of a `MessageData` before its payload, bytes."""


def data_head(subscription_id: int, time_ns: int) -> bytes:
    """The bytes of a `MessageData` before its payload. Hot path: no `MessageData` is created."""
    return _DATA.pack(_MESSAGE_DATA, subscription_id, time_ns)


def decode_client(frame: Frame) -> ClientMessage:
    """Decode a frame of a client. Raises FrameError."""
    message: ClientMessage = _decode(frame, _CLIENT_OPS, _CLIENT_BINARY)
    return message


def decode_server(frame: Frame) -> ServerMessage:
    """Decode a frame of a server. Raises FrameError."""
    message: ServerMessage = _decode(frame, _SERVER_OPS, _SERVER_BINARY)
    return message


def encode_server(message: ServerMessage) -> Frame:
    """Encode a message of a server. Raises ValueError for NaN or infinity in JSON."""
    return _encode(message)


def encode_client(message: ClientMessage) -> Frame:
    """Encode a message of a client. Raises ValueError for NaN or infinity in JSON."""
    return _encode(message)


def _encode(message: Any) -> Frame:
    pack = _PACKERS.get(type(message))
    if pack is not None:
        return pack(message)
    fields = writer(type(message))(message)
    return json.dumps({"op": message.op, **fields}, allow_nan=False, separators=(",", ":"))


def _decode(frame: Frame, by_op: Mapping[str, type[Any]], by_opcode: Mapping[int, Callable[[memoryview], Any]]) -> Any:
    if isinstance(frame, str):
        return _decode_json(frame, by_op)
    if not frame:
        raise FrameError("binary frame", "an opcode", "no bytes")
    unpack = by_opcode.get(frame[0])
    if unpack is None:
        expected = ", ".join(str(opcode) for opcode in by_opcode)
        raise FrameError("binary frame", f"opcode {expected}", f"opcode {frame[0]}")
    return unpack(memoryview(frame))


def _decode_json(text: str, by_op: Mapping[str, type[Any]]) -> Any:
    try:
        value = bounded_json.loads(text, _refuse_constant)
    except bounded_json.TooMuchStructureError as err:
        raise FrameError(
            "text frame", f"at most {bounded_json.MAX_STRUCTURE} characters outside of strings", "more"
        ) from err
    except (ValueError, RecursionError) as err:
        raise FrameError("text frame", "JSON", describe(text)) from err
    if not isinstance(value, dict):
        raise FrameError("text frame", "an object", describe(value))
    op = value.get("op")
    shape = by_op.get(op) if isinstance(op, str) else None
    if shape is None:
        raise FrameError("text frame", f"op {', '.join(by_op)}", describe(op))
    return reader(shape)(value, shape.op)


def _refuse_constant(word: str) -> Any:
    raise FrameError("text frame", "JSON numbers", word)


def _head(layout: struct.Struct, frame: memoryview, name: str) -> tuple[Any, ...]:
    if len(frame) < layout.size:
        raise FrameError(name, f"at least {layout.size} bytes", f"{len(frame)}")
    return layout.unpack_from(frame)


def _counted_text(frame: memoryview, start: int, size: int, name: str) -> str:
    if start + size > len(frame):
        raise FrameError(name, f"{size} bytes of text", f"{len(frame) - start}")
    try:
        return str(frame[start : start + size], "utf-8")
    except UnicodeDecodeError as err:
        raise FrameError(name, "UTF-8", describe(bytes(frame[start : start + size]))) from err


def _unpack_message_data(frame: memoryview) -> MessageData:
    _, subscription_id, time_ns = _head(_DATA, frame, "message data")
    return MessageData(subscription_id, time_ns, bytes(frame[_DATA.size :]))


def _unpack_time(frame: memoryview) -> Time:
    _, time_ns = _head(_TIME, frame, "time")
    return Time(time_ns)


def _unpack_call(frame: memoryview, name: str) -> tuple[int, int, str, bytes]:
    _, service_id, call_id, size = _head(_CALL, frame, name)
    encoding = _counted_text(frame, _CALL.size, size, name)
    return service_id, call_id, encoding, bytes(frame[_CALL.size + size :])


def _unpack_asset(frame: memoryview) -> AssetResponse:
    _, request_id, failed, size = _head(_ASSET, frame, "asset")
    error = _counted_text(frame, _ASSET.size, size, "asset")
    return AssetResponse(request_id, bytes(frame[_ASSET.size + size :]), error if failed else None)


def _unpack_client_data(frame: memoryview) -> ClientMessageData:
    _, channel_id = _head(_CLIENT_DATA, frame, "message data")
    return ClientMessageData(channel_id, bytes(frame[_CLIENT_DATA.size :]))


def _pack_call(opcode: int, call: ServiceRequest | ServiceResponse) -> bytes:
    encoding = call.encoding.encode()
    return _CALL.pack(opcode, call.service_id, call.call_id, len(encoding)) + encoding + call.payload


def _pack_asset(asset: AssetResponse) -> bytes:
    error = (asset.error or "").encode()
    return _ASSET.pack(ASSET_OPCODE, asset.request_id, asset.error is not None, len(error)) + error + asset.data


_CLIENT_OPS = {shape.op: shape for shape in CLIENT_JSON}
_SERVER_OPS = {shape.op: shape for shape in SERVER_JSON}

_CLIENT_BINARY: dict[int, Callable[[memoryview], Any]] = {
    int(ClientBinaryOpcode.MESSAGE_DATA): _unpack_client_data,
    int(ClientBinaryOpcode.SERVICE_CALL_REQUEST): lambda frame: ServiceRequest(*_unpack_call(frame, "service request")),
}
_SERVER_BINARY: dict[int, Callable[[memoryview], Any]] = {
    int(BinaryOpcode.MESSAGE_DATA): _unpack_message_data,
    int(BinaryOpcode.TIME): _unpack_time,
    int(BinaryOpcode.SERVICE_CALL_RESPONSE): lambda frame: ServiceResponse(*_unpack_call(frame, "service response")),
    ASSET_OPCODE: _unpack_asset,
}
_PACKERS: dict[type, Callable[[Any], bytes]] = {
    MessageData: lambda data: data_head(data.subscription_id, data.time_ns) + data.payload,
    Time: lambda time: _TIME.pack(BinaryOpcode.TIME, time.time_ns),
    ServiceResponse: lambda call: _pack_call(BinaryOpcode.SERVICE_CALL_RESPONSE, call),
    AssetResponse: _pack_asset,
    ClientMessageData: lambda data: _CLIENT_DATA.pack(ClientBinaryOpcode.MESSAGE_DATA, data.channel_id) + data.payload,
    ServiceRequest: lambda call: _pack_call(ClientBinaryOpcode.SERVICE_CALL_REQUEST, call),
}
