"""Conversion of JSON objects and ROS messages, for clients that use the encoding `json`.

Missing keys have their default values, unknown keys are rejected; arrays are lists, byte arrays also base64 text, and
NaN is null
(docs/spec/foxglove.md section 5). In Jazzy the setters of rosidl check values only if an environment variable is set;
therefore ranges and lengths are checked here.
"""

from __future__ import annotations

import base64
import json
import math
import re
import sys
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from thymio_sim_ros.bridge.protocol import bounded_json
from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.ros.foxglove.types import full_name, load_type

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.messages.message_class import Message, MsgT

__all__ = ["JsonMessageError", "finite", "from_json", "from_value", "numbers", "to_json", "to_value"]

_LIST = re.compile(r"^(?:sequence<(?P<item>[^,]+)(?:, (?P<most>\d+))?>|(?P<cell>.+)\[(?P<exactly>\d+)\])$")
_INTEGER = re.compile(r"^(u?)int(8|16|32|64)$")
_TEXT = re.compile(r"^w?string(?:<(\d+)>)?$")

_ROS_1_NAMES = {"secs": "sec", "nsecs": "nanosec"}
"""Fields of times and durations, which older clients write in another way."""

MAX_MESSAGES = 2000
"""Nested messages in one message."""


class JsonMessageError(ThymioSimError, ValueError):
    """JSON does not fit the message type; the text says where."""


def from_json(data: bytes, message_type: type[MsgT]) -> MsgT:
    """Convert UTF-8 JSON to a message of the class. Raises JsonMessageError."""
    try:
        value = bounded_json.loads(data.decode())
    except (ValueError, RecursionError) as error:
        raise JsonMessageError(f"not JSON: {error}") from error
    return from_value(value, message_type)


def from_value(value: object, message_type: type[MsgT], where: str = "message") -> MsgT:
    """Convert decoded JSON to a message of the class. Raises JsonMessageError, with the place in the value `where`."""
    if _messages_in(value) > MAX_MESSAGES:
        raise JsonMessageError(f"{where}: expected at most {MAX_MESSAGES} objects, found more")
    message = message_type()
    _fill(message, value, where)
    return message


def _messages_in(value: object) -> int:
    """Number of objects in a JSON value: each becomes a message, which takes about 20 µs."""
    if isinstance(value, dict):
        return 1 + sum(_messages_in(item) for item in value.values() if isinstance(item, (dict, list)))
    return sum(_messages_in(item) for item in value if isinstance(item, (dict, list))) if isinstance(value, list) else 0


def to_json(message: Message) -> bytes:
    """Convert a message to UTF-8 JSON; NaN and infinity, which JSON does not have, become null."""
    return json.dumps(to_value(message, finite, numbers), allow_nan=False, separators=(",", ":")).encode()


def finite(number: float) -> float | None:
    """A number as JSON has it."""
    return number if math.isfinite(number) else None


def numbers(values: Any) -> list[Any]:
    """Several numbers, an array of NumPy or of `array`, as JSON has them."""
    plain = values.tolist()
    return list(map(finite, plain)) if plain and isinstance(plain[0], float) else list(plain)


def to_value(message: Message, of_float: Callable[[float], Any], of_numbers: Callable[[Any], Any]) -> dict[str, Any]:
    """The fields of a message as objects, lists, texts and numbers.

    `of_float` converts a number with a fraction, `of_numbers` an array of NumPy or of `array`.
    """

    def plain(value: Any) -> Any:
        if isinstance(value, float):
            return of_float(value)
        if isinstance(value, (str, bool, int)):
            return value
        if isinstance(value, bytes):
            return value[0] if len(value) == 1 else list(value)
        if hasattr(value, "get_fields_and_field_types"):
            return {name: plain(getattr(value, name)) for name in value.get_fields_and_field_types()}
        return of_numbers(value) if hasattr(value, "tolist") else [plain(item) for item in value]

    return plain(message)  # type: ignore[no-any-return]


def _fill(message: Message, value: object, where: str) -> None:
    if not isinstance(value, dict):
        raise JsonMessageError(f"{where}: expected an object, found {value!r:.40}")
    fields = message.get_fields_and_field_types()
    for given, item in value.items():
        key = given if given in fields else _ROS_1_NAMES.get(str(given), str(given))
        kind = fields.get(key)
        if kind is None:
            raise JsonMessageError(f"{where}: no field {key}; fields are {', '.join(fields)}")
        inner = getattr(message, key)
        if hasattr(inner, "get_fields_and_field_types"):
            _fill(inner, item, f"{where}.{key}")
        else:
            setattr(message, key, _convert(item, kind, f"{where}.{key}"))


def _convert(value: object, kind: str, where: str) -> object:
    is_list = _LIST.match(kind)
    if is_list is not None:
        items = _convert_list(value, is_list["item"] or is_list["cell"], where)
        exactly, most = is_list["exactly"], is_list["most"]
        if (exactly and len(items) != int(exactly)) or (most and len(items) > int(most)):
            raise JsonMessageError(f"{where}: expected {kind}, found {len(items)} elements")
        return items
    if "/" in kind:
        message = load_type(full_name(kind))()
        _fill(message, value, where)
        return message
    return _convert_scalar(value, kind, where)


def _convert_list(value: object, kind: str, where: str) -> list[object]:
    if isinstance(value, str) and kind in ("octet", "uint8", "int8"):
        try:
            data = base64.b64decode(value, validate=True)
        except ValueError as error:
            raise JsonMessageError(f"{where}: expected a list or base64, found {value!r:.40}") from error
        if kind == "octet":
            return [bytes([byte]) for byte in data]
        return [byte - 256 if kind == "int8" and byte > 127 else byte for byte in data]
    if not isinstance(value, list):
        raise JsonMessageError(f"{where}: expected a list, found {value!r:.40}")
    return [_convert(item, kind, f"{where}[{index}]") for index, item in enumerate(value)]


def _convert_scalar(value: object, kind: str, where: str) -> object:
    is_text = _TEXT.match(kind)
    if is_text is not None:
        if isinstance(value, str) and _is_utf8(value) and len(value.encode()) <= int(is_text[1] or sys.maxsize):
            return value
    elif kind == "boolean":
        if isinstance(value, bool):
            return value
    elif value is None and kind in ("float", "double"):
        return math.nan
    elif isinstance(value, (int, float)) and not isinstance(value, bool):
        number = _number(value, kind)
        if number is not None:
            return number
    raise JsonMessageError(f"{where}: expected {kind}, found {value!r:.40}")


def _number(value: int | float, kind: str) -> float | int | bytes | None:
    """The number in the type of the field, None if it does not fit."""
    if kind in ("float", "double"):
        try:
            return float(value)
        except OverflowError:
            return None
    if isinstance(value, float) and not value.is_integer():
        return None
    if kind == "octet":
        return bytes([int(value)]) if 0 <= value < 256 else None
    integer = _INTEGER.match(kind)
    assert integer is not None, kind
    low, high = _limits(unsigned=bool(integer[1]), bits=int(integer[2]))
    return int(value) if low <= value <= high else None


def _is_utf8(text: str) -> bool:
    try:
        text.encode()
    except UnicodeEncodeError:  # half of a surrogate pair
        return False
    return True


def _limits(*, unsigned: bool, bits: int) -> tuple[int, int]:
    return (0, (1 << bits) - 1) if unsigned else (-(1 << (bits - 1)), (1 << (bits - 1)) - 1)
