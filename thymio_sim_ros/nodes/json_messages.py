"""JSON objects ↔ ROS messages: what clients publish and call in JSON (foxglove.md section 5).

Missing keys keep their defaults, unknown keys are refused; arrays are lists, byte arrays also base64 text.
"""

from __future__ import annotations

import base64
import binascii
import json
import math
import re
from typing import Any

from thymio_sim_ros.nodes.foxglove_types import full_name, load_type

__all__ = ["JsonMessageError", "from_json", "to_json"]

_ELEMENT = re.compile(r"^(?:sequence<(?P<sequence>[^,]+)(?:, \d+)?>|(?P<array>.+)\[\d+\])$")
_INTEGER = re.compile(r"^(u?)int(8|16|32|64)$")
_TEXT = re.compile(r"^w?string(<\d+>)?$")


class JsonMessageError(ValueError):
    """JSON that does not fit the message type; the text says where."""


def from_json(data: bytes, message_type: Any) -> Any:
    """A message of the class from UTF-8 JSON; raises JsonMessageError."""
    try:
        value = json.loads(data)
    except (ValueError, RecursionError) as error:
        raise JsonMessageError(f"not JSON: {error}") from error
    message = message_type()
    _fill(message, value, "message")
    return message


def to_json(message: Any) -> bytes:
    """The message as UTF-8 JSON; what JSON cannot say (NaN, infinity) is null."""
    return json.dumps(_plain(message), allow_nan=False, separators=(",", ":")).encode()


def _fill(message: Any, value: Any, where: str) -> None:
    if not isinstance(value, dict):
        raise JsonMessageError(f"{where}: expected an object, found {value!r:.40}")
    fields = message.get_fields_and_field_types()
    for key, item in value.items():
        kind = fields.get(key)
        if kind is None:
            raise JsonMessageError(f"{where}: no field {key}; fields are {', '.join(fields)}")
        try:
            setattr(message, key, _convert(item, kind, f"{where}.{key}"))
        except (AssertionError, TypeError, OverflowError) as error:  # rosidl's setters check bounds and lengths
            raise JsonMessageError(f"{where}.{key}: expected {kind}, found {item!r:.40}") from error


def _convert(value: Any, kind: str, where: str) -> Any:
    element = _ELEMENT.match(kind)
    if element is not None:
        return _convert_list(value, element["sequence"] or element["array"], where)
    if "/" in kind:
        message = load_type(full_name(kind))()
        _fill(message, value, where)
        return message
    return _convert_scalar(value, kind, where)


def _convert_list(value: Any, kind: str, where: str) -> Any:
    if isinstance(value, str) and kind in ("octet", "uint8", "int8"):
        try:
            data = base64.b64decode(value, validate=True)
        except binascii.Error as error:
            raise JsonMessageError(f"{where}: expected a list or base64, found {value!r:.40}") from error
        return [data[i : i + 1] for i in range(len(data))] if kind == "octet" else list(data)
    if not isinstance(value, list):
        raise JsonMessageError(f"{where}: expected a list, found {value!r:.40}")
    return [_convert(item, kind, f"{where}[{index}]") for index, item in enumerate(value)]


def _convert_scalar(value: Any, kind: str, where: str) -> Any:
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if kind in ("float", "double") and is_number:
        return float(value)
    if kind == "boolean" and isinstance(value, bool):
        return value
    if _TEXT.match(kind) and isinstance(value, str):
        return value
    if is_number and float(value).is_integer():
        if kind == "octet" and 0 <= value < 256:
            return bytes([int(value)])
        bounds = _INTEGER.match(kind)
        if bounds is not None:
            low, high = _limits(unsigned=bool(bounds[1]), bits=int(bounds[2]))
            if low <= value <= high:
                return int(value)
    raise JsonMessageError(f"{where}: expected {kind}, found {value!r:.40}")


def _limits(*, unsigned: bool, bits: int) -> tuple[int, int]:
    return (0, (1 << bits) - 1) if unsigned else (-(1 << (bits - 1)), (1 << (bits - 1)) - 1)


def _plain(value: Any) -> Any:
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, (str, bool, int)):
        return value
    if isinstance(value, bytes):
        return value[0] if len(value) == 1 else list(value)
    if hasattr(value, "get_fields_and_field_types"):
        return {name: _plain(getattr(value, name)) for name in value.get_fields_and_field_types()}
    return [_plain(item) for item in value.tolist()] if hasattr(value, "tolist") else [_plain(item) for item in value]
