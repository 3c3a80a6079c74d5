"""HTTP for the page, on aiohttp: GET and HEAD of documents, with limits, time-outs and headers that protect the page.

Everything runs in one event loop, except that two helper threads read documents: a playground may take some time.
"""

from __future__ import annotations

import asyncio
import re
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor

from aiohttp import web

from thymio_sim_ros.access import AccessCheck, AccessRules, HostNames, RefusedError, Visitor
from thymio_sim_ros.access.hosts import host_name
from thymio_sim_ros.files.resources import PAGE_BUILD_HINT
from thymio_sim_ros.sim.playground.reader import PlaygroundError
from thymio_sim_ros.web.content import TYPES, Content, Document
from thymio_sim_ros.web.http_connections import COMMON_HEADERS, Report, start_answer, text_response
from thymio_sim_ros.web.settings import Settings

__all__ = ["Page"]

_CHUNK = 32_768
"""Bytes that are written in one iteration of the event loop: data that a client does not read is not copied as a whole,
and large answers do not delay small ones."""
_HASH_LIFETIME_S = 365 * 24 * 3600
_METHODS = "GET, HEAD"
_GZIP = re.compile(r"(?:^|,)\s*gzip\s*(?:;\s*q=(?!0(?:\.0*)?\s*(?:,|$))[\d.]+\s*)?(?:,|$)")
"""Matches gzip in `Accept-Encoding`, unless its quality is 0."""


class Page:
    """Creates the responses to requests."""

    def __init__(self, content: Content, settings: Settings, report: Report) -> None:
        self._content = content
        self._settings = settings
        names = HostNames.LOOPBACK if settings.is_loopback else HostNames.ANY
        self._access = AccessCheck(AccessRules(host_names=names, allowed_hosts=settings.allowed_hosts), report)
        self._pool = ThreadPoolExecutor(2, "page")

    async def close(self) -> None:
        """End the helper threads, which read documents for a moment at most."""
        self._pool.shutdown(cancel_futures=True)

    def refusal(self, request: web.BaseRequest, visitor: Visitor) -> web.StreamResponse | None:
        """The response to a request for another name of this computer; None: it may be answered."""
        try:
            self._access.check_host(visitor)
        except RefusedError as error:
            start_answer(request)
            return text_response(error.status, str(error))
        return None

    async def answer(self, request: web.BaseRequest, visitor: Visitor, path: str | None = None) -> web.StreamResponse:
        """The response to a request; `path` is that of the file, None if it is that of the request."""
        if (refusal := self.refusal(request, visitor)) is not None:
            return refusal
        start_answer(request)
        if request.method not in ("GET", "HEAD"):
            response = text_response(405, "Only GET and HEAD are answered.", {"Allow": _METHODS})
            response.force_close()
            return response
        found = await self.file(request, visitor, request.raw_path.partition("?")[0] if path is None else path)
        return text_response(404, "There is no such file.") if found is None else found

    async def file(self, request: web.BaseRequest, visitor: Visitor, path: str) -> web.StreamResponse | None:
        """The response to GET and HEAD of a file; None if there is no such file."""
        try:
            document = await asyncio.get_running_loop().run_in_executor(self._pool, self._content.find, path)
        except PlaygroundError as error:
            start_answer(request)
            return text_response(422, str(error))
        if document is not None:
            start_answer(request)
            return await self._document(request, visitor, document)
        if self._content.is_built:
            return None
        start_answer(request)
        page = f"<!doctype html><meta charset=utf-8><title>Thymio</title><p>{PAGE_BUILD_HINT}</p>"
        return _response(503, page.encode(), TYPES[".html"], {"Cache-Control": "no-store"})

    async def _document(self, request: web.BaseRequest, visitor: Visitor, document: Document) -> web.StreamResponse:
        headers = {
            "Cache-Control": f"public, max-age={_HASH_LIFETIME_S}, immutable" if document.is_immutable else "no-cache",
            "Content-Security-Policy": _policy(visitor.host or "", self._settings.foxglove_port),
        }
        body, tag = document.body, document.tag
        if document.compressed is not None:
            headers["Vary"] = "Accept-Encoding"
            if _GZIP.search(request.headers.get("Accept-Encoding", "")):
                headers["Content-Encoding"] = "gzip"
                body, tag = document.compressed, f"{document.tag}-gzip"
        headers["ETag"] = f'"{tag}"'
        if _has_tag(request.headers.get("If-None-Match", ""), tag):
            headers.pop("Content-Encoding", None)
            return _response(304, b"", document.media_type, headers)
        if len(body) <= _CHUNK or request.method == "HEAD":
            return _response(200, body, document.media_type, headers)
        headers["Content-Type"] = document.media_type
        response = web.StreamResponse(headers={**COMMON_HEADERS, **headers})
        response.content_length = len(body)
        await response.prepare(request)
        for begin in range(0, len(body), _CHUNK):
            await response.write(body[begin : begin + _CHUNK])
            await asyncio.sleep(0)
        return response


def _response(status: int, body: bytes, media_type: str, headers: Mapping[str, str]) -> web.Response:
    return web.Response(status=status, body=body, headers={**COMMON_HEADERS, "Content-Type": media_type, **headers})


def _policy(host: str, foxglove_port: int) -> str:
    """The Content-Security-Policy: the page may load from this server and connect to it and the bridge on its host."""
    name = host_name(host)
    port = host.rpartition(":")[2] if foxglove_port < 0 else str(foxglove_port)
    place = f"{name}:{port}" if port.isdecimal() else name
    # Safari did not count WebSockets as 'self' until version 15.4. A policy cannot contain an IPv6 address.
    bridge = f"ws://{place} wss://{place}" if name and ":" not in name else "ws: wss:"
    return (
        f"default-src 'self'; script-src 'self'; connect-src 'self' {bridge}; img-src 'self' data: blob:; "
        "style-src 'self' 'unsafe-inline'; object-src 'none'; base-uri 'none'; form-action 'none'; "
        "frame-ancestors 'self'"
    )


def _has_tag(wanted: str, tag: str) -> bool:
    """Whether an If-None-Match header names the tag, weakly compared (RFC 9110 section 13.1.2)."""
    tags = {item.strip().removeprefix("W/") for item in wanted.split(",")}
    return "*" in tags or f'"{tag}"' in tags
