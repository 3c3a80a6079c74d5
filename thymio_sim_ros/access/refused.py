"""Requests that are not answered as asked."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from thymio_sim_ros.errors import ThymioSimError

__all__ = ["RefusedError"]

_NO_HEADERS: Mapping[str, str] = MappingProxyType({})


class RefusedError(ThymioSimError):
    """A request that is answered with an HTTP status, a reason and headers."""

    def __init__(self, status: int, text: str, headers: Mapping[str, str] = _NO_HEADERS) -> None:
        super().__init__(text)
        self.status, self.headers = status, headers
