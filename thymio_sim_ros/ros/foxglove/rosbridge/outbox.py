"""Operations for one client, encoded as it wants them."""

from __future__ import annotations

import itertools
from typing import Any

from thymio_sim_ros.bridge.rosbridge import frames
from thymio_sim_ros.bridge.rosbridge.fragments import split
from thymio_sim_ros.bridge.rosbridge.frames import Operation
from thymio_sim_ros.ros.foxglove.rosbridge.host import Host
from thymio_sim_ros.ros.foxglove.rosbridge.values import Compression

__all__ = ["Outbox"]

_LEVELS = ("info", "warning", "error", "none")


class Outbox:
    """Sends operations to a client."""

    def __init__(self, host: Host, client: int) -> None:
        self._host, self._client = host, client
        self._numbers = itertools.count(1)
        self.level = "error"
        """The lowest level of a status that is sent."""

    def send(
        self,
        operation: Operation,
        compression: Compression = Compression.NONE,
        fragment_size: int | None = None,
        slot: int | None = None,
    ) -> None:
        """Send an operation. A client that is slow gets only the newest operations of a `slot`."""
        if compression.is_binary:
            self._host.send(self._client, [frames.as_cbor(operation)], slot)
            return
        text = frames.as_json(operation)
        if compression is Compression.PNG:
            text = frames.as_json({"op": "png", "data": frames.as_png(text)})
        if fragment_size is None or len(text) <= fragment_size:
            self._host.send(self._client, [text], slot)
            return
        parts = split(text, fragment_size, str(next(self._numbers)))
        self._host.send(self._client, map(frames.as_json, parts), slot)

    def status(self, level: str, text: str, operation_id: object = None) -> None:
        """Send a status, unless the client wants none of this level."""
        if _LEVELS.index(level) >= _LEVELS.index(self.level):
            self.send(frames.status(level, text, operation_id))

    def answer(self, kind: str, name: str, operation: Operation, **fields: Any) -> None:
        """Send the answer to an operation: `kind` is its name, and `name` the field with the service or action."""
        given = {"id": operation["id"]} if "id" in operation else {}
        compression = Compression(operation.get("compression", "none"))
        self.send(
            {"op": kind, name: operation[name], **fields, **given},
            Compression.NONE if compression is Compression.PNG else compression,
            operation.get("fragment_size"),
        )
