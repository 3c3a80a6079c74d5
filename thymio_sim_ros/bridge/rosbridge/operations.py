"""The operations that clients of rosbridge send: which fields each needs, and what a field may be.

A field means the same in every operation. Unknown fields are ignored; null is a missing field, as in rosbridge_suite.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from thymio_sim_ros.bridge.protocol.constants import Capability
from thymio_sim_ros.bridge.protocol.errors import FrameError
from thymio_sim_ros.bridge.rosbridge.frames import Operation

__all__ = ["OPERATIONS", "OperationKind", "check"]

_TOO_LARGE = 1 << 53
_MAX_ID = 1024
"""Characters of a name or an ID: some are remembered."""


@dataclass(frozen=True, slots=True)
class OperationKind:
    """An operation: the fields that it needs, the capability that a server has to offer, whether it changes anything.

    Read-only clients may not use one that changes something. Whether a service does is decided by its name.
    """

    needs: tuple[str, ...] = ()
    capability: Capability | None = None
    is_change: bool = False


_PUBLISH, _CALL = Capability.CLIENT_PUBLISH, Capability.SERVICES

OPERATIONS: Mapping[str, OperationKind] = {
    "advertise": OperationKind(("topic", "type"), _PUBLISH, True),
    "unadvertise": OperationKind(("topic",), _PUBLISH, True),
    "publish": OperationKind(("topic",), _PUBLISH, True),
    "subscribe": OperationKind(("topic",)),
    "unsubscribe": OperationKind(("topic",)),
    "call_service": OperationKind(("service",), _CALL),
    "advertise_service": OperationKind(("service", "type"), _CALL, True),
    "unadvertise_service": OperationKind(("service",), _CALL, True),
    "service_response": OperationKind(("service", "id"), _CALL, True),
    "send_action_goal": OperationKind(("action", "action_type"), _CALL, True),
    "cancel_action_goal": OperationKind(("action", "id"), _CALL, True),
    "advertise_action": OperationKind(("action", "type"), _CALL, True),
    "unadvertise_action": OperationKind(("action",), _CALL, True),
    "action_feedback": OperationKind(("action", "id"), _CALL, True),
    "action_result": OperationKind(("action", "id"), _CALL, True),
    "fragment": OperationKind(("id", "data", "num", "total")),
    "set_level": OperationKind(("level",)),
    "status": OperationKind(),
    "node": OperationKind(("id", "name"), _PUBLISH, True),
    "remove_node": OperationKind(("id",), _PUBLISH, True),
    "graph": OperationKind(),
    "interfaces": OperationKind(("package", "texts"), _PUBLISH, True),
}

_TEXT, _FLAG, _OBJECT = "a text", "true or false", "an object"
_COUNT, _NUMBER = "an integer of at least 0", "a finite number of at least 0"
_CHOICES = {
    "compression": ("none", "cbor", "cbor-raw", "png"),
    "level": ("info", "warning", "error", "none"),
}
_KINDS = {
    **dict.fromkeys(
        ("topic", "type", "service", "action", "action_type", "node", "name", "namespace", "package"), _TEXT
    ),
    **dict.fromkeys(("data", "compression", "level"), _TEXT),
    **dict.fromkeys(("queue_length", "queue_size", "fragment_size", "num", "total", "status"), _COUNT),
    **dict.fromkeys(("throttle_rate", "timeout"), _NUMBER),
    **dict.fromkeys(("latch", "feedback", "result"), _FLAG),
    "qos": _OBJECT,
    "texts": _OBJECT,
    "id": "a text or an integer",
}
_NAMES = frozenset(_KINDS) - {"data"}
"""Fields whose texts are short."""


def check(operation: Operation) -> dict[str, Any]:
    """The fields of an operation without those that are null. Raises FrameError, which names the field."""
    name = operation["op"]
    kind = OPERATIONS.get(name)
    if kind is None:
        raise FrameError("op", f"one of {', '.join(OPERATIONS)}", f"{name:.40}")
    given = {key: value for key, value in operation.items() if value is not None}
    for field in kind.needs:
        if field not in given:
            raise FrameError(f"{name}.{field}", _KINDS[field], "nothing")
    for field, value in given.items():
        expected = _KINDS.get(field)
        if expected is not None and not _fits(field, value, expected):
            raise FrameError(f"{name}.{field}", _expected(field, expected), f"{value!r:.40}")
    return given


def _fits(field: str, value: object, expected: str) -> bool:
    if isinstance(value, str) and field in _NAMES and (len(value) > _MAX_ID or not _is_utf8(value)):
        return False
    if field in _CHOICES:
        return value in _CHOICES[field]
    if field == "id":
        return isinstance(value, str | int) and not isinstance(value, bool)
    if expected in (_COUNT, _NUMBER):
        kinds = int if expected is _COUNT else int | float
        return isinstance(value, kinds) and not isinstance(value, bool) and 0 <= value < _TOO_LARGE
    return isinstance(value, {_TEXT: str, _FLAG: bool, _OBJECT: dict}[expected])


def _is_utf8(text: str) -> bool:
    try:
        text.encode()
    except UnicodeEncodeError:  # half of a surrogate pair
        return False
    return True


def _expected(field: str, expected: str) -> str:
    if field in _CHOICES:
        return f"one of {', '.join(_CHOICES[field])}"
    return f"{expected} of at most {_MAX_ID} characters" if expected is _TEXT and field in _NAMES else expected
