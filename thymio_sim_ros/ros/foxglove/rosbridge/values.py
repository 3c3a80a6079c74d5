"""Messages as values of operations: as JSON, as CBOR, and as the bytes of CDR (docs/rosbridge.md, section Messages)."""

from __future__ import annotations

import base64
from enum import StrEnum
from typing import TYPE_CHECKING, Any

import cbor2
import numpy as np
from rclpy._rclpy_pybind11 import RMWError
from rclpy.serialization import deserialize_message, serialize_message

from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.ros.foxglove import json_messages
from thymio_sim_ros.ros.foxglove.cdr_complexity import TooManyPartsError, check_parts

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.messages.message_class import Message, MsgT

__all__ = ["Compression", "ValueRefusedError", "cdr_of", "from_cdr", "from_message", "to_message"]


class Compression(StrEnum):
    """How a client wants messages, by the name of the protocol; the later ones win where a client wants several."""

    NONE = "none"
    PNG = "png"
    CBOR = "cbor"
    RAW = "cbor-raw"

    @property
    def is_binary(self) -> bool:
        """Whether operations are CBOR."""
        return self in (Compression.CBOR, Compression.RAW)


class ValueRefusedError(ThymioSimError, ValueError):
    """A value is no message of its type; the text has the place."""


_TAGS = {
    "uint16": 69, "uint32": 70, "uint64": 71, "int8": 72, "int16": 77, "int32": 78, "int64": 79,
    "float32": 85, "float64": 86,
}  # fmt: skip
"""Tags of arrays of little-endian numbers (RFC 8746 section 2)."""


def cdr_of(value: object) -> bytes | None:
    """The bytes of a message that a client gives in CDR, None for one that it gives as an object."""
    data = value.get("bytes") if isinstance(value, dict) and len(value) == 1 else None
    return data if isinstance(data, bytes) else None


def to_message(value: object, message_type: type[MsgT], where: str) -> MsgT:
    """The message that a client gives, as an object or as `{"bytes": <CDR>}`; `where` is its place in the operation.

    Raises ValueRefusedError.
    """
    data = cdr_of(value)
    if data is not None:
        return _from_bytes(data, message_type, where)
    try:
        return json_messages.from_value({} if value in (None, []) else value, message_type, where)
    except json_messages.JsonMessageError as error:
        raise ValueRefusedError(str(error)) from error


def _from_bytes(data: bytes, message_type: type[MsgT], where: str) -> MsgT:
    try:
        check_parts(data, message_type)
        return deserialize_message(data, message_type)
    except (RMWError, TooManyPartsError) as error:
        first_line = str(error).partition("\n")[0]
        raise ValueRefusedError(f"{where}: expected a {message_type.__name__} in CDR: {first_line}") from error


def from_message(message: Message, compression: Compression) -> dict[str, Any]:
    """A message as a client wants it."""
    if compression is Compression.RAW:
        return {"bytes": serialize_message(message)}
    if compression is Compression.CBOR:
        return json_messages.to_value(message, float, _tagged)
    return json_messages.to_value(message, json_messages.finite, _base64)


def from_cdr(data: bytes, message_type: type[Message], compression: Compression) -> dict[str, Any]:
    """A serialized message as a client wants it."""
    if compression is Compression.RAW:
        return {"bytes": data}
    return from_message(deserialize_message(data, message_type), compression)


def _base64(values: Any) -> object:
    """Bytes as text, other numbers as a list."""
    is_bytes = np.asarray(values).dtype == np.uint8
    return base64.b64encode(values.tobytes()).decode() if is_bytes else json_messages.numbers(values)


def _tagged(values: Any) -> object:
    """Numbers as CBOR has them: byte strings, with a tag for the type of the numbers."""
    array = np.asarray(values)
    data = array.astype(array.dtype.newbyteorder("<")).tobytes()
    tag = _TAGS.get(array.dtype.name)
    return data if tag is None else cbor2.CBORTag(tag, data)
