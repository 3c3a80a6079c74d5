"""Serialized messages (CDR, with its encapsulation), by rosbags.

rosbags reads the attributes of a message by the names of its fields, and makes a message from values in their order.
Its type store has the attributes of our classes as fields.
"""

from __future__ import annotations

import functools
import struct
from collections.abc import Callable
from typing import Any, cast

from rosbags.interfaces import Nodetype
from rosbags.serde import SerdeError
from rosbags.typesys import Stores, get_typestore

from thymio_sim_ros.portable_ros.messages.definitions import FieldType, Shape
from thymio_sim_ros.portable_ros.messages.field_values import WideText
from thymio_sim_ros.portable_ros.messages.message_class import EMPTY_FIELD, Message, MsgT, message_type
from thymio_sim_ros.portable_ros.messages.primitives import PRIMITIVES

__all__ = ["deserialize", "serialize"]

_CDR = get_typestore(Stores.EMPTY)
_WIDE_TEXT = "embedded/msg/WideText"
"""The message that stands for a wstring: rosbags does not serialize texts of this type."""
_CDR.fielddefs[_WIDE_TEXT] = cast(Any, ([], [("units", (Nodetype.SEQUENCE, ((Nodetype.BASE, ("uint32", 0)), 0)))]))
_CDR.types[_WIDE_TEXT] = cast(Any, WideText)
_EMPTY = (EMPTY_FIELD, (Nodetype.BASE, ("uint8", 0)))
_ENCAPSULATION = 4
"""Bytes before the content."""


def serialize(message: Message) -> bytes:
    """The bytes of a message. Raises TypeError for a field that has no value of its type."""
    name = message.TYPE_NAME
    _register(name)
    try:
        data = bytes(_CDR.serialize_cdr(message, name, little_endian=True))
    except (AttributeError, IndexError, OverflowError, SerdeError, TypeError, ValueError, struct.error) as error:
        raise TypeError(f"{name}: {_misfit(message) or error}: found {message!r}") from error
    return data


def deserialize(data: bytes, kind: type[MsgT]) -> MsgT:
    """The message that the bytes stand for. Raises ValueError for bytes that are no such message.

    Bytes after the message are ignored: Fast DDS sends a few, since it allocates by an upper estimate of the size.
    """
    name = kind.TYPE_NAME
    _register(name)
    codec = _CDR.get_msgdef(name)
    if data[:1] != b"\0" or data[1:2] not in (b"\0", b"\1"):
        raise ValueError(f"{name}: found encapsulation {data[:_ENCAPSULATION].hex()!r}, expected plain CDR")
    read = codec.deserialize_cdr_le if data[1] else codec.deserialize_cdr_be
    try:
        message, _ = read(data[_ENCAPSULATION:], 0, codec.cls, _CDR)
    except (SerdeError, struct.error, ValueError, IndexError) as error:
        raise ValueError(f"found {len(data)} bytes that are no {name}: {error}") from error
    return cast(MsgT, message)  # made by the class of the codec, which is `kind`


@functools.cache
def _register(name: str) -> None:
    """Add a message to the store for CDR, with all that it contains."""
    kind = message_type(name)
    for member in kind.members:
        if not member.field.type.is_primitive:
            _register(member.field.type.base)
    fields = [(member.wire, _node(member.field.type)) for member in kind.members]
    _CDR.fielddefs[name] = cast(Any, ([], fields or [_EMPTY]))
    _CDR.types[name] = cast(Any, _maker(kind))


def _node(of: FieldType) -> Any:
    """The type of a field as rosbags has it."""
    inner: tuple[Any, Any]
    if of.base == "wstring":
        inner = Nodetype.NAME, _WIDE_TEXT
    elif of.is_primitive:
        inner = Nodetype.BASE, (PRIMITIVES[of.base].wire, of.text_bound)
    else:
        inner = Nodetype.NAME, of.base
    if of.shape is Shape.SCALAR:
        return inner
    return Nodetype.ARRAY if of.shape is Shape.ARRAY else Nodetype.SEQUENCE, (inner, of.size)


def _maker(kind: type[Message]) -> Callable[..., Message]:
    """The function that makes a message of the values that rosbags read."""
    slots = [(member.slot, member.values.from_wire) for member in kind.members]

    def make(*values: Any) -> Message:
        message = kind.__new__(kind)
        message._check_fields = False
        for (slot, convert), value in zip(slots, values, strict=False):
            setattr(message, slot, value if convert is None else convert(value))
        return message

    return make


def _misfit(message: Message) -> str:
    """The first sentence about a field whose value is not of its type, empty if there is none."""
    for member in message.members:
        try:
            member.check(getattr(message, member.slot))
        except AssertionError as error:
            return str(error)
    return ""
