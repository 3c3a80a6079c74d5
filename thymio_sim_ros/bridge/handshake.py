"""Checks of WebSocket handshakes: sub-protocol, token and origin, with an answer that names the reason."""

from __future__ import annotations

import contextlib
import logging
from collections.abc import Sequence
from http import HTTPStatus

from websockets.asyncio.server import ServerConnection
from websockets.datastructures import Headers
from websockets.exceptions import ConnectionClosed, NegotiationError
from websockets.http11 import Request, Response
from websockets.typing import Subprotocol

from thymio_sim_ros.bridge.access import TokenCheck, Tokens, TooManyAttemptsError, given_token
from thymio_sim_ros.bridge.origin_policy import is_allowed
from thymio_sim_ros.bridge.protocol.constants import SUBPROTOCOLS, StatusLevel
from thymio_sim_ros.bridge.protocol.messages import Status
from thymio_sim_ros.bridge.protocol.wire import encode_server
from thymio_sim_ros.bridge.report_limiter import ReportLimiter
from thymio_sim_ros.bridge.rosbridge import frames
from thymio_sim_ros.bridge.transport import SharedConnection

__all__ = ["WRONG_TOKEN", "HandshakeCheck", "select_subprotocol"]

WRONG_TOKEN = 4401
"""Close code for a page without a valid token: browsers hide the reason of a rejected handshake from pages."""

_NO_TOKEN_TEXT = "a token is needed: open the whole address in the simulator's terminal, or append ?token=… to yours"
_WRONG_TOKEN_TEXT = (
    "the token is wrong or from an earlier start: open the address that the simulator's terminal shows now"
)


class HandshakeCheck:
    """Decides who may connect. It sets `role` of a connection; None: the connection must be closed by `reject`."""

    def __init__(self, tokens: Tokens, allowed_origins: Sequence[str], log: logging.Logger) -> None:
        self._tokens = tokens
        self._allowed_origins = allowed_origins
        self._check = TokenCheck(tokens, allowed_origins)
        self._warn = ReportLimiter(lambda text: log.warning("%s", text))

    async def check(self, connection: ServerConnection, request: Request) -> Response | None:
        """The response that rejects a handshake without a valid token or from a foreign page, otherwise None.

        With a valid token any page is accepted. Without one, a page is accepted for now, because browsers show it only
        the close code of an open connection.
        """
        assert isinstance(connection, SharedConnection)
        address = _address(connection)
        token = given_token(request.path, request.headers.get_all("Authorization"))
        origin, host = _header(request.headers, "Origin"), _header(request.headers, "Host")
        try:
            connection.role = await self._check.role(token, address, origin=origin, host=host)
        except TooManyAttemptsError as error:
            self._warn("attempts", f"connections from {address} are rejected for some seconds: too many wrong tokens")
            return connection.respond(HTTPStatus.TOO_MANY_REQUESTS, f"{error}\n")
        if connection.role is None:
            self._warn("token", f"connection from {address} rejected: its token is wrong or missing")
            if origin is not None:
                return None  # `reject` sends the reason
            response = connection.respond(HTTPStatus.UNAUTHORIZED, f"{_token_text(request)}\n")
            response.headers["WWW-Authenticate"] = "Bearer"
            return response
        if self._tokens.is_required or is_allowed(origin, host, self._allowed_origins):
            return None
        self._warn("origin", f"web page from {origin:.100} rejected: add it to allowed_origins if it is yours")
        return connection.respond(HTTPStatus.FORBIDDEN, f"Pages from {origin} may not connect; see allowed_origins.\n")

    async def reject(self, connection: SharedConnection) -> None:
        """Send a status with the reason why the token was not accepted, and close the connection."""
        assert connection.request is not None
        text = _token_text(connection.request)
        status = (
            frames.as_json(frames.status("error", text, "access"))
            if connection.is_rosbridge
            else encode_server(Status(StatusLevel.ERROR, text, "access"))
        )
        with contextlib.suppress(ConnectionClosed):
            await connection.send(status)
            await connection.close(WRONG_TOKEN, "wrong or missing token")


def select_subprotocol(_connection: ServerConnection, offered: Sequence[Subprotocol]) -> Subprotocol | None:
    """The first of `SUBPROTOCOLS` that a client offers; None if it offers nothing, as clients of rosbridge do.

    Raises NegotiationError if it offers others only.
    """
    if not offered:
        return None
    for name in SUBPROTOCOLS:
        if name in offered:
            return name
    raise NegotiationError(f"offer one of the sub-protocols {', '.join(SUBPROTOCOLS)}, or none for rosbridge")


def _address(connection: ServerConnection) -> str:
    peer = connection.remote_address
    return str(peer[0]) if peer else ""


def _token_text(request: Request) -> str:
    given = given_token(request.path, request.headers.get_all("Authorization"))
    return _NO_TOKEN_TEXT if given is None else _WRONG_TOKEN_TEXT


def _header(headers: Headers, name: str) -> str | None:
    """The header's value, the last one if it is repeated."""
    values = headers.get_all(name)
    return values[-1] if values else None
