"""The HTTP server of a class: connections with limits, and a `Router` that answers."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Iterable
from pathlib import Path
from socket import socket

from thymio_sim_ros.bridge.report_limiter import ReportLimiter
from thymio_sim_ros.classroom.address import ClassAddress
from thymio_sim_ros.classroom.classroom import Classroom
from thymio_sim_ros.classroom.router import Router
from thymio_sim_ros.classroom.suite_proxy import SuiteProxy
from thymio_sim_ros.web.content import Content
from thymio_sim_ros.web.http_connections import serve_connections
from thymio_sim_ros.web.server import Page
from thymio_sim_ros.web.settings import Settings, max_connections

__all__ = ["serve_class"]

_DESCRIPTORS = 2
"""Open files of a visitor's connection: one of them leads to a suite."""


async def serve_class(
    listeners: Iterable[socket], classroom: Classroom, folder: Path | None, place: ClassAddress
) -> None:
    """Serve a class on listening sockets until this task is cancelled; `folder` has the built page."""
    log = logging.getLogger(__name__)
    report = ReportLimiter(lambda text: log.warning("class: %s", text))
    page = Page(Content(folder, b"{}"), Settings(is_loopback=place.is_loopback), report)
    proxy = SuiteProxy()
    router = Router(classroom, page, proxy, place, report)
    try:
        at_once = max_connections() // _DESCRIPTORS
        await serve_connections(listeners, router.answer, at_once, report, asyncio.Event(), place.tls)
    finally:
        await page.close()
        await proxy.close()
