"""Limits the share of an event loop's time that busy clients of a server get, so that no client delays the others."""

from __future__ import annotations

import asyncio
import contextlib
import time
from collections.abc import Iterator

__all__ = ["ClientTime", "Throttle"]

_SMALL_SHARE = 0.05
"""Share of the loop's time below which a client is not paused: it must not wait behind the busy ones."""


class Throttle:
    """Pauses the busy clients of one server. Only for the thread of its event loop."""

    def __init__(self, slice_s: float) -> None:
        """`slice_s`: processor time in s after which a busy client is paused for as long."""
        self._slice_s = slice_s
        self._pausing = asyncio.Lock()

    async def pause(self, spent_s: float) -> None:
        """Pause for the processor time that a client used, one client after the other.

        All busy clients together therefore use at most half of the loop's time, and other clients are served between
        two of them, regardless of their number.
        """
        async with self._pausing:
            await asyncio.sleep(spent_s)

    def client(self) -> ClientTime:
        """Begin to count the time of a client."""
        return ClientTime(self, self._slice_s)


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
            if self._spent_s > _SMALL_SHARE * (time.monotonic() - self._since_s):
                await self._throttle.pause(self._spent_s)
            self._spent_s, self._since_s = 0.0, time.monotonic()
