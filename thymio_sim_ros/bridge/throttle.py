"""Limits the share of an event loop's time that busy clients of a server get, so that no client delays the others."""

from __future__ import annotations

import asyncio
import contextlib
import heapq
import itertools
import time
import weakref
from collections.abc import AsyncIterator, Iterator

__all__ = ["ClientTime", "Throttle"]

_BUSY_SHARE = 0.5
"""Share of the loop's time that busy clients get together."""
_SMALL_PART = 0.5
"""Part of an equal share of that time below which a client is not paused: it must not wait behind the busy ones."""


class Throttle:
    """Pauses the busy clients of one server. Only for the thread of its event loop."""

    def __init__(self, slice_s: float) -> None:
        """`slice_s`: processor time in s after which a busy client is paused for as long."""
        self._slice_s = slice_s
        self._turns = _Turns()
        self._clients: weakref.WeakSet[ClientTime] = weakref.WeakSet()

    @property
    def small_share(self) -> float:
        """Share of the loop's time below which a client is not paused.

        It depends on the number of clients: thirty of them occupy the loop with three hundredths each.
        """
        return _SMALL_PART * _BUSY_SHARE / max(len(self._clients), 1)

    async def pause(self, spent_s: float, share: float = 0.0) -> None:
        """Pause for the processor time that a client used, one client after the other, that with the least share first.

        All busy clients together therefore use at most half of the loop's time, and other clients are served between
        two of them, regardless of their number.
        """
        async with self._turns.take(share):
            await asyncio.sleep(spent_s)

    def client(self) -> ClientTime:
        """Begin to count the time of a client."""
        client = ClientTime(self, self._slice_s)
        self._clients.add(client)
        return client


class ClientTime:
    """The processor time that a loop spends on one client."""

    def __init__(self, throttle: Throttle, slice_s: float) -> None:
        self._throttle, self._slice_s = throttle, slice_s
        self._spent_s, self._since_s = 0.0, time.monotonic()

    @contextlib.contextmanager
    def measured(self) -> Iterator[None]:
        """Count the processor time of a block, in which nothing is awaited."""
        began_s = time.thread_time()
        try:
            yield
        finally:
            self._spent_s += time.thread_time() - began_s

    async def pause_if_busy(self) -> None:
        """Pause after each slice of processor time, unless the client's share of the loop's time is small."""
        if self._spent_s >= self._slice_s:
            if self._share > self._throttle.small_share:
                await self._throttle.pause(self._spent_s, self._share)
            self._spent_s, self._since_s = 0.0, time.monotonic()

    async def pause_at_end(self) -> None:
        """Pause for the rest of the time, when the client has left: it may connect again at once."""
        await self._throttle.pause(self._spent_s, self._share)

    @property
    def _share(self) -> float:
        """Share of the loop's time since the last pause."""
        return self._spent_s / max(time.monotonic() - self._since_s, self._spent_s, 1e-9)


class _Turns:
    """A lock that goes to the one with the least share of those that wait for it."""

    def __init__(self) -> None:
        self._is_taken = False
        self._waiting: list[tuple[float, int, asyncio.Future[None]]] = []
        """A heap of shares; the numbers keep the order of equal ones."""
        self._numbers = itertools.count()

    @contextlib.asynccontextmanager
    async def take(self, share: float) -> AsyncIterator[None]:
        """Keep others that take the lock out of a block."""
        if self._is_taken:
            turn: asyncio.Future[None] = asyncio.get_running_loop().create_future()
            heapq.heappush(self._waiting, (share, next(self._numbers), turn))
            try:
                await turn
            except asyncio.CancelledError:
                if not turn.cancelled():  # canceled after it got the lock
                    self._pass_on()
                raise
        self._is_taken = True
        try:
            yield
        finally:
            self._pass_on()

    def _pass_on(self) -> None:
        """Give the lock to the next one, or free it."""
        while self._waiting:
            _, _, turn = heapq.heappop(self._waiting)
            if not turn.done():
                turn.set_result(None)
                return
        self._is_taken = False
