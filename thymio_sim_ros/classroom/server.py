"""The HTTP server of the teacher's page: its files, and the interface of `requests`, which needs the token."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Iterable
from pathlib import Path
from socket import socket

from aiohttp import web

from thymio_sim_ros.bridge.access import TokenCheck, Tokens, TooManyAttemptsError, given_token
from thymio_sim_ros.bridge.report_limiter import ReportLimiter
from thymio_sim_ros.classroom.classroom import Classroom
from thymio_sim_ros.classroom.requests import MAX_BODY, RefusalError, answer
from thymio_sim_ros.web.content import Content
from thymio_sim_ros.web.http_connections import COMMON_HEADERS, serve_connections, start_answer, text_response
from thymio_sim_ros.web.server import Page
from thymio_sim_ros.web.settings import Settings, max_connections

__all__ = ["serve_class"]

_PREFIX = "/class/"
_INDEX = "class.html"


class _Teacher:
    """Creates the responses to requests."""

    def __init__(self, classroom: Classroom, page: Page, token: str) -> None:
        self._classroom, self._page = classroom, page
        self._tokens = TokenCheck(Tokens(token))

    async def answer(self, request: web.BaseRequest) -> web.StreamResponse:
        """The response to a request."""
        path = request.raw_path.partition("?")[0]
        if not path.startswith(_PREFIX):
            return await self._page.answer(request)
        try:
            await self._check(request)
            body = await _body(request)
            start_answer(request)
            done = await answer(self._classroom, request.method, path.removeprefix(_PREFIX), body)
        except RefusalError as error:
            start_answer(request)
            response = text_response(error.status, str(error))
            response.force_close()
            return response
        headers = {**COMMON_HEADERS, "Content-Type": done.media_type, "Cache-Control": "no-store"}
        if done.file:
            headers["Content-Disposition"] = f'attachment; filename="{done.file}"'
        return web.Response(body=done.body, headers=headers)

    async def _check(self, request: web.BaseRequest) -> None:
        """Raise RefusalError without the token of the teacher. It is in a header, which no foreign page can send."""
        given = given_token("", request.headers.getall("Authorization", []))
        origin, host = request.headers.get("Origin"), request.headers.get("Host")
        try:
            role = await self._tokens.role(given, request.remote or "", origin=origin, host=host)
        except TooManyAttemptsError as error:
            raise RefusalError(429, str(error)) from error
        if role is None:
            raise RefusalError(401, "expected the token of the teacher: Authorization: Bearer …")


async def serve_class(
    listeners: Iterable[socket], classroom: Classroom, folder: Path | None, token: str, *, is_loopback: bool
) -> None:
    """Serve the teacher's page on listening sockets until this task is cancelled; `folder` has the built page."""
    log = logging.getLogger(__name__)
    report = ReportLimiter(lambda text: log.warning("teacher's page: %s", text))
    settings = Settings(_port(listeners), is_loopback=is_loopback)
    page = Page(Content(folder, b"{}", index=_INDEX), settings, report)
    teacher = _Teacher(classroom, page, token)
    try:
        await serve_connections(listeners, teacher.answer, max_connections(), report, asyncio.Event())
    finally:
        await page.close()


def _port(listeners: Iterable[socket]) -> int:
    return int(next(iter(listeners)).getsockname()[1])


async def _body(request: web.BaseRequest) -> bytes:
    if not request.body_exists:
        return b""
    body = bytearray()
    async for chunk in request.content.iter_any():
        body += chunk
        if len(body) > MAX_BODY:
            raise RefusalError(413, f"expected a body of at most {MAX_BODY} bytes")
    return bytes(body)
