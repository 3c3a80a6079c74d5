"""The thread of the page's server."""

from __future__ import annotations

import asyncio
import contextlib
import threading
import time
import traceback
from collections.abc import Callable

from thymio_sim_ros.bridge.server_thread import listen
from thymio_sim_ros.web.content import Content
from thymio_sim_ros.web.settings import Settings

__all__ = ["PageThread", "Settings"]

_REPORT_EVERY_S = 60.0
_END_S = 3.0
"""Longest time for ending; the thread is a daemon's."""


class PageThread:
    """A running server. The port is bound when the constructor returns; `port` is the one really taken.

    Raises OSError when the address cannot be used. `warn` gets one line for each kind of problem, at most one a minute;
    it is called in the server's thread.
    """

    def __init__(
        self, content: Content, settings: Settings, *, address: str, port: int, warn: Callable[[str], None]
    ) -> None:
        self._content = content
        self._settings = settings
        self._warn = warn
        self._reported_s: dict[str, float] = {}
        self._listeners = listen(address, port)
        self.port = int(self._listeners[0].getsockname()[1])
        self._loop = asyncio.new_event_loop()
        self._stop = asyncio.Event()
        self._thread = threading.Thread(target=self._run, name="page-server", daemon=True)
        self._is_closed = False
        self._thread.start()

    def close(self) -> None:
        """End the server and its connections; twice does no harm."""
        if self._is_closed:
            return
        self._is_closed = True
        with contextlib.suppress(RuntimeError):  # it has ended by itself
            self._loop.call_soon_threadsafe(self._stop.set)
        self._thread.join(_END_S)

    def _run(self) -> None:
        try:
            # Here, so that the start of everything else does not wait for it.
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

    def _report(self, kind: str, text: str) -> None:
        now_s = time.monotonic()
        if now_s - self._reported_s.get(kind, -_REPORT_EVERY_S) >= _REPORT_EVERY_S:
            self._reported_s[kind] = now_s
            self._warn(f"page: {text} (not repeated for a minute)")
