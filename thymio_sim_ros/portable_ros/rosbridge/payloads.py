"""Messages, requests and responses within operations: serialized for servers that accept it, otherwise as JSON."""

from __future__ import annotations

import json
from typing import Any, Protocol

from thymio_sim_ros.portable_ros.messages import cdr
from thymio_sim_ros.portable_ros.messages.message_class import message_type
from thymio_sim_ros.portable_ros.rosbridge.operations import CDR_BYTES, OperationError

__all__ = ["JsonCodec", "Payloads"]


class JsonCodec(Protocol):
    """Converts messages to JSON and back."""

    def to_json(self, message: Any) -> bytes:
        """The UTF-8 JSON of a message."""

    def from_json(self, data: bytes, message_type: type[Any]) -> Any:
        """The message of a class that UTF-8 JSON stands for. Raises ValueError."""


class Payloads:
    """Converts between serialized messages and what operations contain."""

    def __init__(self, codec: JsonCodec) -> None:
        self._codec = codec
        self.is_serialized = False
        """Whether the server accepts serialized messages."""

    def outgoing(self, data: bytes, type_name: str) -> object:
        """The payload of a serialized message."""
        if self.is_serialized:
            return {CDR_BYTES: data}
        return json.loads(self._codec.to_json(cdr.deserialize(data, message_type(type_name))))

    def incoming(self, payload: object, type_name: str) -> bytes:
        """The serialized message of a payload; None and an empty list stand for no fields. Raises OperationError."""
        if isinstance(payload, dict) and isinstance(payload.get(CDR_BYTES), bytes):
            return bytes(payload[CDR_BYTES])
        try:
            text = json.dumps({} if payload is None or payload == [] else payload).encode()
            return cdr.serialize(self._codec.from_json(text, message_type(type_name)))
        except (ValueError, TypeError) as error:
            raise OperationError(f"found no {type_name}: {error}") from error
