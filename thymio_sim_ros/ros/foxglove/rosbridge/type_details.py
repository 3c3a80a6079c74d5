"""The fields of types as rosapi describes them."""

from __future__ import annotations

import re
from typing import Any

from thymio_sim_ros.ros.foxglove.types import full_name, load_type

__all__ = ["type_details"]

_MANY = re.compile(r"^sequence<(?P<item>[^,>]+(?:<\d+>)?)(?:, \d+)?>$|^(?P<cell>.+)\[(?P<size>\d+)\]$")


def type_details(type_name: str, part: str) -> list[dict[str, Any]]:
    """The fields of a message type, or of the `Request` or `Response` of a service, and of all types in them.

    `fieldarraylen` is -1 for a single value, 0 for a sequence, otherwise the length of an array.
    Raises MissingTypeError.
    """
    is_message = part == "msg"
    loaded = load_type(full_name(type_name, "msg" if is_message else "srv"))
    kind = loaded if is_message else getattr(loaded, part)
    found: dict[str, dict[str, Any]] = {}
    _add(type_name if is_message else f"{type_name}{part}", kind, found)
    return list(found.values())


def _add(name: str, kind: Any, found: dict[str, dict[str, Any]]) -> None:
    if name in found:
        return
    fields = {field: _item_and_length(text) for field, text in kind.get_fields_and_field_types().items()}
    found[name] = {
        "type": name,
        "fieldnames": list(fields),
        "fieldtypes": [item for item, _ in fields.values()],
        "fieldarraylen": [length for _, length in fields.values()],
        "examples": [_example(item, length) for item, length in fields.values()],
        "constnames": [],
        "constvalues": [],
    }
    for item, _ in fields.values():
        if "/" in item:
            _add(item, load_type(full_name(item)), found)


def _item_and_length(text: str) -> tuple[str, int]:
    match = _MANY.match(text)
    if match is None:
        return text, -1
    return (match["item"], 0) if match["item"] else (match["cell"], int(match["size"]))


def _example(item: str, length: int) -> str:
    if length >= 0:
        return "[]"
    if "/" in item:
        return "{}"
    return {"boolean": "False", "float": "0.0", "double": "0.0"}.get(item, "" if "string" in item else "0")
