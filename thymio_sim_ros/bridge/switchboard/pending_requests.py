"""Limits on the requests of one client that the data source has not answered yet."""

from __future__ import annotations

from enum import Enum

__all__ = ["MAX_PENDING_CALLS", "MAX_PENDING_PARAMETER_REQUESTS", "MAX_PENDING_SIZE", "PendingRequests", "RequestKind"]

MAX_PENDING_CALLS = 64
"""Service calls of one client without an answer."""

MAX_PENDING_PARAMETER_REQUESTS = 64
"""Requests of one client to get or to set parameters without an answer."""

MAX_PENDING_SIZE = 16 << 20
"""Bytes of all pending requests of one client; a request may be larger if it is the only one with data."""


class RequestKind(Enum):
    """Requests that are counted separately."""

    CALL = "calls"
    PARAMETERS = "requests"


_LIMITS = {RequestKind.CALL: MAX_PENDING_CALLS, RequestKind.PARAMETERS: MAX_PENDING_PARAMETER_REQUESTS}


class PendingRequests:
    """The pending requests of one client: their number by kind, and their size in total."""

    def __init__(self) -> None:
        self._counts = dict.fromkeys(RequestKind, 0)
        self._size = 0

    def add(self, kind: RequestKind, size: int) -> str | None:
        """Count a request with `size` bytes of data; return the reason if it is rejected instead."""
        if self._counts[kind] >= _LIMITS[kind]:
            return f"{_LIMITS[kind]} {kind.value} of this client are pending: wait for their answers"
        if self._size and self._size + size > MAX_PENDING_SIZE:
            return f"{MAX_PENDING_SIZE >> 20} MiB of requests of this client are pending: wait for their answers"
        self._counts[kind] += 1
        self._size += size
        return None

    def remove(self, kind: RequestKind, size: int) -> None:
        """Discount an answered request; additional answers have no effect."""
        self._counts[kind] = max(0, self._counts[kind] - 1)
        self._size = max(0, self._size - size)
