"""Which graph a server is on, asked before this process chooses its own."""

from __future__ import annotations

import json

from websockets.exceptions import WebSocketException
from websockets.sync.client import connect

__all__ = ["is_embedded"]

_SERVICE = "/rosapi/get_ros_version"
_PATIENCE_S = 2.0


def is_embedded(url: str, token: str = "") -> bool | None:
    """Whether the server is a suite on the embedded graph; None if there is no server, or if it wants another token."""
    headers = {"Authorization": f"Bearer {token}"} if token else {}
    try:
        with connect(url, additional_headers=headers, compression=None, proxy=None, open_timeout=_PATIENCE_S) as server:
            server.send(json.dumps({"op": "call_service", "id": _SERVICE, "service": _SERVICE}))
            return _answer(server.recv(timeout=_PATIENCE_S))
    except (OSError, WebSocketException, ValueError):
        return None


def _answer(frame: str | bytes) -> bool:
    """Whether an answer is that of the embedded graph; other servers have no such field."""
    answer = json.loads(frame)
    values = answer.get("values") if isinstance(answer, dict) else None
    return isinstance(values, dict) and values.get("is_embedded") is True
