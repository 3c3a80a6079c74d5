"""The page's server in its own thread."""

from __future__ import annotations

import asyncio
import contextlib
import threading
import traceback
from collections.abc import Callable

from thymio_sim_ros.bridge.report_limiter import ReportLimiter
from thymio_sim_ros.bridge.server_thread import listen
from thymio_sim_ros.web.content import Content
from thymio_sim_ros.web.settings import Settings

__all__ = ["PageThread", "Settings"]

_CLOSE_TIMEOUT_S = 3.0
"""Longest time that `close` waits; the thread is a daemon."""


class PageThread:
    """A running server. The port is bound when the constructor returns; `port` is the actual port.

    `warn` is called in the server's thread, at most once a minute for each kind of problem.
    """

    def __init__(
        self, content: Content, settings: Settings, *, address: str, port: int, warn: Callable[[str], object]
    ) -> None:
        """Start serving. Raises OSError if the address and port cannot be used."""
        self._content = content
        self._settings = settings
        self._warn = warn
        self._report = ReportLimiter(lambda text: warn(f"page: {text} (not repeated for a minute)"))
        self._listeners = listen(address, port)
        self.port = int(self._listeners[0].getsockname()[1])
        self._loop = asyncio.SelectorEventLoop()  # as `ServerThread`
        self._stop = asyncio.Event()
        self._thread = threading.Thread(target=self._run, name="page-server", daemon=True)
        self._is_closed = False
        self._thread.start()

    def close(self) -> None:
        """Stop the server and its connections; a second call has no effect."""
        if self._is_closed:
            return
        self._is_closed = True
        with contextlib.suppress(RuntimeError):  # the loop has ended because of an error
            self._loop.call_soon_threadsafe(self._stop.set)
        self._thread.join(_CLOSE_TIMEOUT_S)

    def _run(self) -> None:
        try:
            # Imported in this thread, so that it does not delay the start of other nodes.
            from thymio_sim_ros.web.server import serve

            self._loop.run_until_complete(
                serve(self._listeners, self._content, self._settings, self._report, self._stop)
            )
        except Exception:
            self._warn(f"the page's server has ended, internal error (please report):\n{traceback.format_exc()}")
        finally:
            for listener in self._listeners:
                listener.close()
            self._loop.run_until_complete(self._loop.shutdown_asyncgens())
            self._loop.close()
