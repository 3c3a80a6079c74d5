"""Checks of WebSocket handshakes: sub-protocol, token and origin, with an answer that names the reason."""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from http import HTTPStatus
from types import MappingProxyType
from typing import TYPE_CHECKING

from thymio_sim_ros.bridge.access import TokenCheck, Tokens, TooManyAttemptsError, given_token
from thymio_sim_ros.bridge.origin_policy import is_allowed
from thymio_sim_ros.bridge.protocol.constants import SUBPROTOCOLS, Role
from thymio_sim_ros.bridge.report_limiter import ReportLimiter
from thymio_sim_ros.errors import ThymioSimError

if TYPE_CHECKING:
    from aiohttp.web import BaseRequest

__all__ = ["WRONG_TOKEN", "HandshakeCheck", "RefusedError", "select_subprotocol", "token_problem"]

WRONG_TOKEN = 4401
"""Close code for a page without a valid token: browsers hide the reason of a rejected handshake from pages."""

_NO_HEADERS: Mapping[str, str] = MappingProxyType({})
_NO_TOKEN_TEXT = "a token is needed: open the whole address in the simulator's terminal, or append ?token=… to yours"
_WRONG_TOKEN_TEXT = (
    "the token is wrong or from an earlier start: open the address that the simulator's terminal shows now"
)


class RefusedError(ThymioSimError):
    """A request that is answered with an HTTP status, a reason and headers."""

    def __init__(self, status: HTTPStatus, text: str, headers: Mapping[str, str] = _NO_HEADERS) -> None:
        super().__init__(text)
        self.status, self.headers = status, headers


class HandshakeCheck:
    """Decides who may connect."""

    def __init__(self, tokens: Tokens, allowed_origins: Sequence[str], log: logging.Logger) -> None:
        self._tokens = tokens
        self._allowed_origins = allowed_origins
        self._check = TokenCheck(tokens, allowed_origins)
        self._warn = ReportLimiter(lambda text: log.warning("%s", text))

    async def role(self, request: BaseRequest) -> Role | None:
        """The role of a client. Raises RefusedError without a valid token, and for a foreign page.

        With a valid token any page is accepted. Without one the role of a page is None: it must be accepted and get the
        reason (`token_problem`), because browsers show it only the close code of an open connection.
        """
        address = request.remote or ""
        origin, host = _header(request, "Origin"), _header(request, "Host")
        try:
            role = await self._check.role(_token(request), address, origin=origin, host=host)
        except TooManyAttemptsError as error:
            self._warn("attempts", f"connections from {address} are rejected for some seconds: too many wrong tokens")
            raise RefusedError(HTTPStatus.TOO_MANY_REQUESTS, str(error)) from error
        if role is None:
            self._warn("token", f"connection from {address} rejected: its token is wrong or missing")
            if origin is None:
                raise RefusedError(HTTPStatus.UNAUTHORIZED, token_problem(request), {"WWW-Authenticate": "Bearer"})
        elif not self._tokens.is_required and not is_allowed(origin, host, self._allowed_origins):
            self._warn("origin", f"web page from {origin:.100} rejected: add it to allowed_origins if it is yours")
            raise RefusedError(HTTPStatus.FORBIDDEN, f"Pages from {origin} may not connect; see allowed_origins.")
        return role


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


def token_problem(request: BaseRequest) -> str:
    """What is wrong with the token of a request, as text for the user."""
    return _NO_TOKEN_TEXT if _token(request) is None else _WRONG_TOKEN_TEXT


def _token(request: BaseRequest) -> str | None:
    return given_token(request.raw_path, request.headers.getall("Authorization", []))


def _header(request: BaseRequest, name: str) -> str | None:
    """The header's value, the last one if it is repeated."""
    values = request.headers.getall(name, [])
    return values[-1] if values else None
