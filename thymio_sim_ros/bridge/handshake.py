"""The sub-protocol of a handshake."""

from __future__ import annotations

from collections.abc import Sequence
from http import HTTPStatus
from typing import TYPE_CHECKING

from thymio_sim_ros.access import RefusedError
from thymio_sim_ros.bridge.protocol.constants import SUBPROTOCOLS

if TYPE_CHECKING:
    from aiohttp.web import BaseRequest

__all__ = ["WRONG_TOKEN", "select_subprotocol"]

WRONG_TOKEN = 4401
"""Close code for a page without a valid token: browsers hide the reason of a rejected handshake from pages."""


def select_subprotocol(request: BaseRequest, known: Sequence[str] = SUBPROTOCOLS) -> str | None:
    """The first of the known sub-protocols that a client offers; None if it offers nothing, as clients of rosbridge do.

    Raises RefusedError if it offers others only: browsers end a connection without one that they have offered.
    """
    offered = [name.strip() for name in request.headers.get("Sec-WebSocket-Protocol", "").split(",")]
    if not any(offered):
        return None
    for name in known:
        if name in offered:
            return name
    raise RefusedError(HTTPStatus.BAD_REQUEST, f"offer one of the sub-protocols {', '.join(known)}, or none")
