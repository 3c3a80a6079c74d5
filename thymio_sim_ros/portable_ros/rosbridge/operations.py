"""Operations of the rosbridge protocol as frames of a WebSocket: JSON text, or CBOR in binary frames."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from typing import Any, TypeAlias

import cbor2

from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.portable_ros.rclpy.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    QoSProfile,
    ReliabilityPolicy,
    qos_profile_unknown,
)

__all__ = ["CDR_BYTES", "Operation", "OperationError", "decode", "encode", "field", "qos_of", "qos_profile"]

Operation: TypeAlias = dict[str, Any]

CDR_BYTES = "bytes"
"""The key of a serialized message that takes the place of its fields."""

_HALF_PAIR = re.compile(r"[\ud800-\udfff]|\\u[dD][89a-fA-F]")
"""What may be half of a surrogate pair, in JSON."""
_POLICIES = {"reliability": ReliabilityPolicy, "durability": DurabilityPolicy, "history": HistoryPolicy}
_CARRIED = {"reliable", "best_effort", "transient_local", "volatile", "keep_last", "keep_all"}


class OperationError(ThymioSimError, ValueError):
    """A frame that is no operation, or an operation that lacks a field; the text says what was found."""


def encode(operation: Operation, *, is_binary: bool) -> str | bytes:
    """The frame of an operation: CBOR if it `is_binary`, else JSON."""
    if is_binary:
        return bytes(cbor2.dumps(operation))
    return json.dumps(operation, separators=(",", ":"))


def decode(frame: str | bytes) -> Operation:
    """The operation of a frame. Raises OperationError."""
    try:
        found = json.loads(frame) if isinstance(frame, str) else cbor2.loads(frame)
        if isinstance(frame, str) and _HALF_PAIR.search(frame):
            json.dumps(found, ensure_ascii=False).encode()  # what cannot be sent back is an error, a UnicodeEncodeError
    except (ValueError, RecursionError, cbor2.CBORError) as error:
        raise OperationError(f"found a frame of {len(frame)} bytes, expected JSON or CBOR: {error}") from error
    if not isinstance(found, dict):
        raise OperationError(f"found {found!r:.60}, expected an object with `op`")
    field(found, "op", str)
    return found


def field(operation: Operation, name: str, kind: type | tuple[type, ...]) -> Any:
    """The value of a field. Raises OperationError if it is missing or of another type."""
    value = operation.get(name)
    if not isinstance(value, kind):
        kinds = kind if isinstance(kind, tuple) else (kind,)
        wanted = " or ".join(one.__name__ for one in kinds)
        raise OperationError(f"operation {operation.get('op')!r}: found {name} = {value!r:.60}, expected {wanted}")
    return value


def qos_of(profile: QoSProfile) -> Operation:
    """The policies of a profile that the protocol carries; those that the middleware is to choose are left out."""
    found: Operation = {name: getattr(profile, name).short_key for name in _POLICIES}
    return {name: key for name, key in found.items() if key in _CARRIED} | {"depth": profile.depth}


def qos_profile(values: Mapping[str, Any] | None) -> QoSProfile:
    """The profile of policies, as far as they are known. Raises OperationError."""
    depth = values.get("depth") if values else None
    profile = QoSProfile(
        history=qos_profile_unknown.history,
        depth=depth if isinstance(depth, int) and depth > 0 else 1,
        reliability=qos_profile_unknown.reliability,
        durability=qos_profile_unknown.durability,
        liveliness=qos_profile_unknown.liveliness,
    )
    for name, kind in _POLICIES.items():
        if values is None or name not in values:
            continue
        try:
            setattr(profile, name, kind(kind.get_from_short_key(str(values[name]))))
        except KeyError as error:
            raise OperationError(f"qos: found {name} = {values[name]!r:.60}, expected {kind.short_keys()}") from error
    return profile
