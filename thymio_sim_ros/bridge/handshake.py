"""The sub-protocol of a handshake: Foxglove's, or none for rosbridge."""

from __future__ import annotations

from http import HTTPStatus
from typing import TYPE_CHECKING

from thymio_sim_ros.access import RefusedError
from thymio_sim_ros.bridge.protocol.constants import SUBPROTOCOLS

if TYPE_CHECKING:
    from aiohttp.web import BaseRequest

__all__ = ["WRONG_TOKEN", "select_subprotocol"]

WRONG_TOKEN = 4401
"""Close code for a page without a valid token: browsers hide the reason of a rejected handshake from pages."""


def select_subprotocol(request: BaseRequest) -> str | None:
    """The first of `SUBPROTOCOLS` that a client offers; None if it offers nothing, as clients of rosbridge do.

    Raises RefusedError if it offers others only.
    """
    offered = [name.strip() for name in request.headers.get("Sec-WebSocket-Protocol", "").split(",")]
    if not any(offered):
        return None
    for name in SUBPROTOCOLS:
        if name in offered:
            return name
    names = ", ".join(SUBPROTOCOLS)
    raise RefusedError(HTTPStatus.BAD_REQUEST, f"offer one of the sub-protocols {names}, or none for rosbridge")
