"""Writes objects whose classes declare FlatBuffers tables, with the builder of the package `flatbuffers`.

Every slot is written, also with its default value and when it is empty: clients differ in what they take for absent.
Only an identifier that is None is left out.
"""

from __future__ import annotations

from typing import Any

from flatbuffers import Builder, number_types

from thymio_sim_ros.network.tdm.protocol.wire_types import Identifier, Octets, Scalar, Slot, Tables, Text, slots_of

__all__ = ["write_table", "write_union"]


def write_union(number: int, content: object) -> bytes:
    """The buffer of a root table with a union in its slots 0 (type) and 1 (table)."""
    builder = Builder(256)
    builder.ForceDefaults(True)
    table = write_table(builder, content)
    builder.StartObject(2)
    builder.PrependUOffsetTRelativeSlot(1, table, 0)
    builder.PrependSlot(number_types.Uint8Flags, 0, number, 0)
    builder.Finish(builder.EndObject())
    return bytes(builder.Output())


def write_table(builder: Any, content: object) -> int:
    """Write a table with all that it refers to, which must precede it; return its offset from the end."""
    kind: Any = type(content)
    slots = slots_of(kind)
    offsets = [_referred(builder, slot, getattr(content, slot.name)) for slot in slots]
    builder.StartObject(len(slots))
    for number, (slot, offset) in enumerate(zip(slots, offsets, strict=True)):
        if isinstance(slot.wire, Scalar):
            builder.PrependSlot(slot.wire.flags, number, getattr(content, slot.name), slot.wire.default)
        elif offset is not None:
            builder.PrependUOffsetTRelativeSlot(number, offset, 0)
    end: int = builder.EndObject()
    return end


def _referred(builder: Any, slot: Slot, value: Any) -> int | None:
    """Write what a slot refers to; None if it is inside the table or absent."""
    offset: int
    match slot.wire:
        case Scalar():
            return None
        case Text():
            offset = builder.CreateString(value)
        case Octets():
            offset = builder.CreateByteVector(value)
        case Identifier():
            if value is None:
                return None
            raw = builder.CreateByteVector(value.bytes)
            builder.StartObject(1)
            builder.PrependUOffsetTRelativeSlot(0, raw, 0)
            offset = builder.EndObject()
        case Tables():
            parts = [write_table(builder, part) for part in value]
            builder.StartVector(4, len(parts), 4)
            for part in reversed(parts):
                builder.PrependUOffsetTRelative(part)
            offset = builder.EndVector()
    return offset
