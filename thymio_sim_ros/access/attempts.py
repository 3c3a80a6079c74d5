"""A limit on attempts with wrong tokens."""

from __future__ import annotations

import ipaddress
from collections import OrderedDict
from collections.abc import Callable
from http import HTTPStatus

from thymio_sim_ros.access.refused import RefusedError

__all__ = ["AttemptLimiter", "TooManyAttemptsError"]

_BURST = 30
"""Wrong tokens that an address may try without waiting."""
_PER_S = 1.0
"""Attempts that an address regains per second."""
_MAX_WAIT_S = 5.0
"""Longest time that an attempt waits; handshakes time out after 10 s."""
_MAX_ADDRESSES = 1000
"""Addresses that are remembered."""


class TooManyAttemptsError(RefusedError):
    """Too many tokens from an address wait to be checked; this one was not."""

    def __init__(self) -> None:
        super().__init__(HTTPStatus.TOO_MANY_REQUESTS, "too many wrong tokens from this address; try again in a minute")


class AttemptLimiter:
    """Limits how often an address may try a token: `_BURST` times immediately, then `_PER_S` times per second.

    Further attempts wait for their turn. An attempt with a right token does not count, and its address is remembered:
    it gets an allowance of its own, apart from that of its network.
    """

    def __init__(self, now_s: Callable[[], float]) -> None:
        """`now_s` is a monotonic clock, s."""
        self._now_s = now_s
        self._remaining_by_key: OrderedDict[str, tuple[float, float]] = OrderedDict()
        """Network, or address that is known → remaining attempts, below 0 while some wait, and the time of this number,
        s; the most recently used last."""
        self._known: OrderedDict[str, None] = OrderedDict()
        """Addresses that have given a right token; the most recently used last."""

    def begin(self, address: str) -> float:
        """Count an attempt; return the time, s, after which its token may be checked. Raises TooManyAttemptsError."""
        remaining = self._remaining(self._key(address)) - 1.0
        if remaining < -_MAX_WAIT_S * _PER_S:
            raise TooManyAttemptsError
        self._set_remaining(self._key(address), remaining)
        return max(-remaining / _PER_S, 0.0)

    def succeed(self, address: str) -> None:
        """Take back an attempt, because its token was right."""
        key = self._key(address)
        self._set_remaining(key, min(self._remaining(key) + 1.0, float(_BURST)))
        self._known[address] = None
        self._known.move_to_end(address)
        if len(self._known) > _MAX_ADDRESSES:
            self._known.popitem(last=False)

    def _key(self, address: str) -> str:
        return f"known {address}" if address in self._known else _network(address)

    def _set_remaining(self, key: str, remaining: float) -> None:
        self._remaining_by_key[key] = (remaining, self._now_s())
        self._remaining_by_key.move_to_end(key)
        if len(self._remaining_by_key) > _MAX_ADDRESSES:
            self._remaining_by_key.popitem(last=False)

    def _remaining(self, key: str) -> float:
        remaining, since_s = self._remaining_by_key.get(key, (float(_BURST), 0.0))
        return min(float(_BURST), remaining + (self._now_s() - since_s) * _PER_S)


def _network(address: str) -> str:
    """The address itself, or the /64 network of an IPv6 address: one computer can use any address of its network."""
    try:
        number = ipaddress.ip_address(address.partition("%")[0])
    except ValueError:
        return address
    return address if number.version == 4 else str(ipaddress.ip_network((number, 64), strict=False))
