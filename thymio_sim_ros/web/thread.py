"""The thread of all servers of a process: its event loop, its ports, and the application behind them."""

from __future__ import annotations

import asyncio
import contextlib
import functools
import ssl
import threading
import traceback
from collections.abc import Awaitable, Callable, Coroutine, Mapping
from socket import socket, socketpair
from typing import TYPE_CHECKING, Any

from thymio_sim_ros.access import TrustedProxies
from thymio_sim_ros.bridge.listening import listen
from thymio_sim_ros.bridge.report_limiter import ReportLimiter
from thymio_sim_ros.web.content import Content
from thymio_sim_ros.web.settings import Settings, max_connections

if TYPE_CHECKING:
    from thymio_sim_ros.bridge.server import BridgeServer
    from thymio_sim_ros.web.application import Application
    from thymio_sim_ros.web.http_connections import HttpConnections

__all__ = ["MAX_OWN", "ServerThread"]

MAX_OWN = 32
"""Connections of processes of this program."""
_CLOSE_TIMEOUT_S = 3.0
"""Longest time that `close` waits; the thread is a daemon."""


class ServerThread:
    """A thread with one application on any number of ports. The methods may be called in any thread.

    Each node that uses it calls `close`; the thread ends with the last call.
    """

    def __init__(self, *, warn: Callable[[str], object], connections: int | None = None) -> None:
        """Start the thread; it serves nothing until something is mounted and `listen` is called.

        `warn` is called in the thread, at most once a minute for each kind of problem. `connections`: their maximum
        number on the ports of `listen`, by default as many as this process can have.
        """
        self._warn = warn
        self._report = ReportLimiter(lambda text: warn(f"servers: {text} (not repeated for a minute)"))
        self._max_connections = max_connections() if connections is None else connections
        # Not the default loop of Windows: it has no `add_reader` and `add_writer`, and its socket stays the wakeup
        # descriptor of signals when a thread other than the main thread, which made the loop, closes it.
        self.loop = asyncio.SelectorEventLoop()
        """The event loop of the thread."""
        self.loop.set_exception_handler(lambda _loop, context: self._report(_kind(context), _description(context)))
        self._listeners: list[socket] = []
        self._closers: list[Callable[[], Awaitable[None]]] = []
        """Close what has been mounted."""
        self._stop = asyncio.Event()
        self._users = 1
        self._lock = threading.Lock()
        """Guards `_users`."""
        self._thread = threading.Thread(target=self._run, name="servers", daemon=True)
        self._thread.start()

    def share(self) -> ServerThread:
        """This thread, for one more node."""
        with self._lock:
            self._users += 1
        return self

    def trust(self, proxies: TrustedProxies) -> None:
        """Believe these proxies on all ports of `listen`; none changes nothing."""

        def trust() -> None:
            self.application.trusted_proxies = proxies

        if proxies:
            self.call(trust)

    def listen(self, address: str, port: int, tls: ssl.SSLContext | None = None) -> tuple[str, int]:
        """Serve on a port; return the numeric address and the actual port. Raises OSError if it cannot be bound."""
        listeners = listen(address, port)
        self._listeners += listeners
        self.call(lambda: self._connections.accept(listeners, tls))
        found = listeners[0].getsockname()
        return str(found[0]), int(found[1])

    def listen_for_own(self) -> int:
        """Serve a port of loopback, without TLS and time limits, for processes of this program; return its number."""
        listeners = listen("127.0.0.1", 0)
        self._listeners += listeners
        self.call(lambda: self._own_connections.accept(listeners))
        return int(listeners[0].getsockname()[1])

    def connect_own(self) -> socket:
        """One end of a connection, without TLS and time limits, for a process of this program that can make none.

        It leads to this thread alone, where a connection of TCP could be connected anew with another server.
        """
        ours, theirs = socketpair()
        self.call(lambda: self._own_connections.add(ours))
        return theirs

    def mount_bridge(self, bridge: BridgeServer) -> None:
        """Serve a bridge, whose loop must be that of the thread, to clients that ask for a WebSocket at `/`."""

        def mount() -> None:
            from thymio_sim_ros.bridge.websocket import BridgeSockets

            sockets = BridgeSockets(bridge)
            self.application.websockets["/"] = sockets.handle
            self._closers.append(sockets.close)

        self.call(mount)

    def mount_page(self, content: Content, settings: Settings) -> None:
        """Serve a page."""

        def mount() -> None:
            from thymio_sim_ros.web.server import Page

            page = Page(content, settings, self._report)
            self.application.page = page.answer
            self._closers.append(page.close)

        self.call(mount)

    def at_close(self, close: Callable[[], Awaitable[None]]) -> None:
        """Have a function called when the servers end. Only in this thread."""
        self._closers.append(close)

    def call(self, function: Callable[..., object], *arguments: Any) -> None:
        """Call a function in the thread; does nothing once the thread has ended."""
        with contextlib.suppress(RuntimeError):
            self.loop.call_soon_threadsafe(function, *arguments)

    def run(self, work: Coroutine[Any, Any, None]) -> None:
        """Run a coroutine in the thread, and wait for its end for at most `_CLOSE_TIMEOUT_S`."""
        try:
            done = asyncio.run_coroutine_threadsafe(work, self.loop)
        except RuntimeError:  # the thread has ended
            work.close()
            return
        with contextlib.suppress(TimeoutError):
            done.result(_CLOSE_TIMEOUT_S)

    def close(self) -> None:
        """Stop the servers, their connections and the thread, when nothing else uses it."""
        with self._lock:
            self._users -= 1
            is_last = self._users == 0
        if is_last:
            self.call(self._stop.set)
            self._thread.join(_CLOSE_TIMEOUT_S)

    @functools.cached_property
    def application(self) -> Application:
        """What the ports of `listen` answer; only in this thread."""
        # aiohttp is imported in this thread, so that it does not delay the start of the nodes, and only if it is used.
        from thymio_sim_ros.web.application import Application

        return Application()

    @functools.cached_property
    def _connections(self) -> HttpConnections:
        from thymio_sim_ros.web.http_connections import HttpConnections

        return HttpConnections(self.application.answer, self._max_connections, self._report, self.loop)

    @functools.cached_property
    def _own_connections(self) -> HttpConnections:
        from thymio_sim_ros.web.http_connections import HttpConnections

        connections = HttpConnections(self.application.answer, MAX_OWN, self._report, self.loop, is_patient=True)
        self._closers.append(connections.close)
        return connections

    def _run(self) -> None:
        try:
            self.loop.run_until_complete(self._serve())
        except Exception:
            self._warn(f"the servers have ended, internal error (please report):\n{traceback.format_exc()}")
        finally:
            for listener in self._listeners:
                listener.close()
            self.loop.run_until_complete(self.loop.shutdown_asyncgens())
            self.loop.close()

    async def _serve(self) -> None:
        await self._stop.wait()
        for close in self._closers:
            await close()
        if "_connections" in self.__dict__:
            await self._connections.close()
        others = asyncio.all_tasks() - {asyncio.current_task()}
        for task in others:
            task.cancel()
        await asyncio.gather(*others, return_exceptions=True)


def _kind(context: Mapping[str, Any]) -> str:
    return type(context.get("exception")).__name__


def _description(context: Mapping[str, Any]) -> str:
    error = context.get("exception")
    text = "".join(traceback.format_exception(error)) if isinstance(error, BaseException) else ""
    return f"{context.get('message', 'a connection failed')}, internal error (please report):\n{text}"
