"""Descriptions of types as ROS distributes them, and the hashes of interfaces, which are made of them (RIHS01)."""

from __future__ import annotations

import functools
import hashlib
import json
from collections.abc import Iterator
from typing import Any

from thymio_sim_ros.portable_ros.messages.definitions import Field, FieldType, Shape, definition, structure
from thymio_sim_ros.portable_ros.messages.message_class import EMPTY_FIELD

__all__ = ["HASH_PREFIX", "referenced", "type_description", "type_hash"]

HASH_PREFIX = "RIHS01_"

_TYPE_IDS = {
    one.name.removeprefix("FIELD_TYPE_"): one.value
    for one in definition("type_description_interfaces/msg/FieldType").constants
}
_ID_NAMES = {"bool": "BOOLEAN", "char": "UINT8", "float32": "FLOAT", "float64": "DOUBLE"}
"""The names of ids that differ from those of the types. rosidl has `char` as another name of `uint8`."""
_EMPTY = Field(EMPTY_FIELD, FieldType("uint8"))


def type_description(name: str) -> dict[str, Any]:
    """The fields of an interface and of all that it is made of, by the names of `TypeDescription`.

    Raises KeyError if there is no such interface.
    """
    return {
        "type_description": _individual(name),
        "referenced_type_descriptions": [_individual(one) for one in referenced(name)],
    }


@functools.cache
def type_hash(name: str) -> str:
    """The hash of a message, a service or an action, such as `RIHS01_…`. Raises KeyError if there is none."""
    described = type_description(name)
    for one in (described["type_description"], *described["referenced_type_descriptions"]):
        for field in one["fields"]:
            del field["default_value"]
    text = json.dumps(described)
    return HASH_PREFIX + hashlib.sha256(text.encode()).hexdigest()


def referenced(name: str) -> list[str]:
    """The full names of all interfaces that an interface is made of, without itself, sorted."""
    found: set[str] = set()
    missing = {name}
    while missing:
        found |= missing
        missing = {base for one in missing for base in _bases(one)} - found
    return sorted(found - {name})


def _bases(name: str) -> Iterator[str]:
    return (field.type.base for field in structure(name).fields if not field.type.is_primitive)


def _individual(name: str) -> dict[str, Any]:
    return {"type_name": name, "fields": [_field(field) for field in structure(name).fields or (_EMPTY,)]}


def _field(field: Field) -> dict[str, Any]:
    of = field.type
    return {
        "name": field.name,
        "type": {
            "type_id": _type_id(of),
            "capacity": of.size,
            "string_capacity": of.text_bound,
            "nested_type_name": "" if of.is_primitive else of.base,
        },
        "default_value": "" if field.default is None else _default_text(field.default),
    }


def _default_text(value: Any) -> str:
    """A default as descriptions have it: octets as numbers."""
    if isinstance(value, tuple):
        return str(tuple(one[0] if isinstance(one, bytes) else one for one in value))
    return str(value[0] if isinstance(value, bytes) else value)


def _type_id(of: FieldType) -> int:
    words = [_ID_NAMES.get(of.base, of.base.upper()) if of.is_primitive else "NESTED_TYPE"]
    if of.text_bound:
        words.insert(0, "BOUNDED")
    if of.shape is Shape.ARRAY:
        words.append("ARRAY")
    elif of.shape is Shape.SEQUENCE:
        words.append("BOUNDED_SEQUENCE" if of.size else "UNBOUNDED_SEQUENCE")
    return int(_TYPE_IDS["_".join(words)])
