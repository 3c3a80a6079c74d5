"""The connection with a rosbridge server: one thread, which connects again whenever the connection is lost."""

from __future__ import annotations

import asyncio
import contextlib
import socket
import threading
from collections.abc import Callable

from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import InvalidHandshake, InvalidStatus, InvalidURI, WebSocketException

from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.portable_ros.graph.graph import Graph
from thymio_sim_ros.portable_ros.graph.protocols import PublisherEnd, Sample
from thymio_sim_ros.portable_ros.rosbridge.payloads import JsonCodec
from thymio_sim_ros.portable_ros.rosbridge.session import Session

__all__ = ["RosbridgeError", "RosbridgeTransport"]

_SEND_BUFFER = 128 * 1024
"""What the system keeps of a connection, bytes: only before that do senders take turns."""
_RETRY_S, _POLL_S = 1.0, 2.0
"""Time between attempts to connect, and between looks at a graph that the server does not send."""
_PING_S, _PONG_S = 10.0, 30.0
"""Time between pings, and until a server without an answer counts as lost; long, for a machine under load."""
_CLOSE_S = 2.0
"""Longest wait for the server when the connection is closed."""


class RosbridgeError(ThymioSimError):
    """The server rejects the connection; the text is one line."""


class RosbridgeTransport:
    """Makes the nodes of a graph members of the graph of a server. Its thread is a daemon."""

    def __init__(
        self,
        graph: Graph,
        url: str,
        codec: JsonCodec,
        report: Callable[[str], None],
        *,
        token: str = "",
        waits: bool = True,
        link: socket.socket | None = None,
    ) -> None:
        """`codec`: for servers that take no serialized messages; `report` gets lines for the user, from any thread.

        `waits`: whether `start` waits for a server if there is none. `link`: a connection with the server, which
        is used first.
        """
        self._graph, self._url, self._codec, self._report, self._token = graph, url, codec, report, token
        self._waits, self._link = waits, link
        self._loop: asyncio.AbstractEventLoop | None = None
        self._wake_event = asyncio.Event()
        self._is_woken = False
        self._session: Session | None = None
        self._is_closing = False
        self._is_lost = self._is_rejected = False
        self._is_ready = threading.Event()
        self._rejection: RosbridgeError | None = None
        self._thread = threading.Thread(target=self._run_thread, name="rosbridge", daemon=True)
        self._task: asyncio.Task[None] | None = None

    @property
    def is_connected(self) -> bool:
        """Whether there is a server that delivers messages."""
        return self._session is not None and self._session.is_ready

    def start(self) -> None:
        """Attach the graph and connect; return once the remote graph is known.

        Waits until there is a server, which is said once. Raises RosbridgeError if it rejects the connection, and
        without a server if it shall not wait.
        """
        self._graph.attach(self)
        self._thread.start()
        self._is_ready.wait()
        if self._rejection is not None:
            raise self._rejection

    def close(self) -> None:
        """Send what is queued, and disconnect; an attempt to connect is given up."""
        self._is_closing = True
        self.wake()
        if self._session is None and self._loop is not None and self._task is not None:
            with contextlib.suppress(RuntimeError):  # the loop is closed
                self._loop.call_soon_threadsafe(self._task.cancel)
        self._thread.join()
        self._graph.attach(None)

    def graph_changed(self) -> None:
        """Announce what has changed."""
        if self._session is not None:
            self._session.graph_changed()

    def publish(self, publisher: PublisherEnd, sample: Sample) -> bool:
        """Send a message; return whether there is a server that delivers it."""
        session = self._session
        return session is not None and session.publish(publisher, sample)

    def wake(self) -> None:
        """Have the thread send what is queued."""
        if not self._is_woken and self._loop is not None:
            self._is_woken = True
            with contextlib.suppress(RuntimeError):  # the loop is closed
                self._loop.call_soon_threadsafe(self._wake_event.set)

    def _run_thread(self) -> None:
        with contextlib.suppress(asyncio.CancelledError):
            asyncio.run(self._run())

    async def _run(self) -> None:
        self._loop, self._task = asyncio.get_running_loop(), asyncio.current_task()
        while not self._is_closing:
            try:
                await self._connect()
            except (OSError, WebSocketException) as error:
                if not self._is_closing:
                    self._note_failure(error)
            if self._rejection is not None:
                return
            if not self._is_closing:
                await asyncio.sleep(_RETRY_S)

    async def _next_wake(self) -> None:
        await self._wake_event.wait()
        self._is_woken = False
        self._wake_event.clear()

    async def _connect(self) -> None:
        headers = {"Authorization": f"Bearer {self._token}"} if self._token else {}
        link, self._link = self._link, None
        async with connect(
            self._url,
            sock=link,
            additional_headers=headers,
            compression=None,
            max_size=None,
            proxy=None,
            ping_interval=_PING_S,
            ping_timeout=_PONG_S,
            close_timeout=_CLOSE_S,
        ) as connection:
            connection.transport.get_extra_info("socket").setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, _SEND_BUFFER)
            session = self._session = Session(self._graph, self._codec, self.wake, self._report)
            self.wake()
            tasks = [asyncio.create_task(part(connection, session)) for part in (self._read, self._write, self._poll)]
            try:
                done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
                for task in done:
                    task.result()
            finally:
                self._session = None
                session.end()
                for task in tasks:
                    task.cancel()
                await asyncio.gather(*tasks, return_exceptions=True)
        if not self._is_closing:
            self._note_failure(ConnectionError("the server has closed it"))

    async def _read(self, connection: ClientConnection, session: Session) -> None:
        async for frame in connection:
            session.receive(frame)
            if session.is_ready and not self._is_ready.is_set():
                self._is_ready.set()
            if session.is_ready and self._is_lost:
                self._is_lost = self._is_rejected = False
                self._report(f"connected to {self._shown}")

    async def _write(self, connection: ClientConnection, session: Session) -> None:
        while True:
            await self._next_wake()
            for frame in session.frames():
                await connection.send(frame)
            if self._is_closing:
                await connection.close()
                return

    async def _poll(self, connection: ClientConnection, session: Session) -> None:
        while True:
            await asyncio.sleep(_POLL_S)
            if session.needs_polls:
                session.poll()

    @property
    def _shown(self) -> str:
        """The address without a token."""
        return self._url.partition("?")[0]

    def _note_failure(self, error: Exception) -> None:
        """Report once that there is no connection; the first time a server may reject it for good."""
        if not self._is_ready.is_set() and isinstance(error, (InvalidHandshake, InvalidURI)):
            self._rejection = RosbridgeError(f"{self._shown}: {_reason(error)}")
            self._is_ready.set()
        elif not self._is_ready.is_set() and not self._waits:
            what = f"found no server at {self._shown} ({_reason(error)}), expected one"
            self._rejection = RosbridgeError(f"{what}: start `thymio-sim`, or give its address")
            self._is_ready.set()
        elif not self._is_lost:
            self._is_lost = True
            what = f"connection with {self._shown} lost" if self._is_ready.is_set() else f"no server at {self._shown}"
            self._report(f"{what} ({_reason(error)}); waiting for it")
        elif isinstance(error, InvalidStatus) and not self._is_rejected:
            self._is_rejected = True
            self._report(f"{self._shown}: {_reason(error)}; waiting for another answer")


def _reason(error: Exception) -> str:
    """One line about an error."""
    if isinstance(error, InvalidStatus):
        response = error.response
        if (response.body or b"").strip() and response.headers.get("Content-Type", "").startswith("text/plain"):
            return (response.body or b"").decode(errors="replace").strip().splitlines()[0]
        return f"found HTTP status {response.status_code}, expected a rosbridge server"
    if isinstance(error, OSError) and error.strerror:
        return error.strerror
    return str(error).splitlines()[0] if str(error) else type(error).__name__
