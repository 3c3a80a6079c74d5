"""Accepts TCP connections. Each is closed at the end, at whatever moment of its beginning that comes.

`asyncio.start_server` and `loop.sock_accept` forget connections that they are accepting when they are ended (measured
with Python 3.11); their clients then wait for ever.
"""

from __future__ import annotations

import asyncio
import socket
from collections.abc import Callable, Coroutine, Iterable
from typing import Any

__all__ = ["Acceptor"]

_RETRY_S = 0.05
"""Time until the next try after an error, such as too many open files."""

Serve = Callable[[socket.socket, str], Coroutine[Any, Any, None]]
"""Serves a connection, of a client with this address, until it ends; the socket is closed afterwards."""


class Acceptor:
    """Listening sockets, and a task for each connection. Only for the thread of the event loop."""

    def __init__(self, listeners: Iterable[socket.socket], serve: Serve, report: Callable[[OSError], None]) -> None:
        """Accept from now on. `report` takes errors of accepting."""
        self._listeners, self._serve, self._report = tuple(listeners), serve, report
        self._loop = asyncio.get_running_loop()
        self._tasks: set[asyncio.Task[None]] = set()
        self._is_closed = False
        for listener in self._listeners:
            listener.setblocking(False)
            self._listen(listener)

    @property
    def count(self) -> int:
        """Connections that have not ended."""
        return len(self._tasks)

    def close(self) -> None:
        """Accept no more, and cancel the tasks of all connections."""
        self._is_closed = True
        for listener in self._listeners:
            self._loop.remove_reader(listener)
            listener.close()
        for task in self._tasks:
            task.cancel()

    async def wait_closed(self) -> None:
        """Wait for the end of all connections."""
        await asyncio.gather(*self._tasks, return_exceptions=True)

    def _listen(self, listener: socket.socket) -> None:
        if not self._is_closed:
            self._loop.add_reader(listener, self._accept, listener)

    def _accept(self, listener: socket.socket) -> None:
        try:
            accepted, peer = listener.accept()
        except (BlockingIOError, InterruptedError):  # the client has disconnected
            return
        except OSError as error:
            self._report(error)
            self._loop.remove_reader(listener)
            self._loop.call_later(_RETRY_S, self._listen, listener)
            return
        accepted.setblocking(False)
        task = self._loop.create_task(self._serve(accepted, str(peer[0])))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)
        task.add_done_callback(lambda _task: accepted.close())  # also of a task that was cancelled before it began
