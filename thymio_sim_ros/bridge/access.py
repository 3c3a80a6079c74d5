"""Access control for all servers: tokens, their roles, and a limit on attempts with wrong tokens.

A server without a token serves every client that can reach its address. Tokens travel in addresses and headers, never
in messages, parameters or logs, which every client may read.
"""

from __future__ import annotations

import asyncio
import base64
import binascii
import hmac
import ipaddress
import re
import secrets
import time
import urllib.parse
from collections import OrderedDict
from collections.abc import Callable, Collection, Iterable
from dataclasses import dataclass, field

from thymio_sim_ros.bridge.origin_policy import is_allowed, is_same_local_name
from thymio_sim_ros.bridge.protocol.constants import Role
from thymio_sim_ros.errors import ThymioSimError

__all__ = [
    "READ_ONLY_VARIABLE",
    "TOKEN",
    "TOKEN_VARIABLE",
    "AttemptLimiter",
    "TokenCheck",
    "Tokens",
    "TooManyAttemptsError",
    "given_token",
    "is_loopback",
    "is_random",
    "new_token",
]

TOKEN_VARIABLE, READ_ONLY_VARIABLE = "THYMIO_SIM_TOKEN", "THYMIO_SIM_READ_ONLY_TOKEN"
"""Environment variables with tokens. Unlike arguments of a command, other users of the computer cannot read them."""

TOKEN = re.compile(r"[A-Za-z0-9._~-]{4,200}")
"""Form of a token: it needs no escapes in an address; shorter ones could be guessed."""

_RANDOM_BYTES = 16
"""Size of a random token."""
_BURST = 30
"""Wrong tokens that an address may try without waiting."""
_PER_S = 1.0
"""Attempts that an address regains per second."""
_MAX_WAIT_S = 5.0
"""Longest time that an attempt waits; handshakes time out after 10 s."""
_MAX_ADDRESSES = 1000
"""Addresses that are remembered."""


@dataclass(frozen=True, slots=True)
class Tokens:
    """The tokens of a server. Without `full`, all clients have all rights, except those with the read-only token."""

    full: str = field(default="", repr=False)
    read_only: str = field(default="", repr=False)

    @property
    def is_required(self) -> bool:
        """Whether a client needs a token."""
        return bool(self.full)

    def role(self, given: str | None) -> Role | None:
        """The role of a client that gives this token; None if it may not connect."""
        # Both comparisons are always made, in constant time: the response time reveals nothing about the tokens.
        token = (given or "").encode("utf-8", "surrogatepass")
        is_full = bool(self.full) and hmac.compare_digest(token, self.full.encode())
        is_read_only = bool(self.read_only) and hmac.compare_digest(token, self.read_only.encode())
        if is_full:
            return Role.FULL
        if is_read_only:
            return Role.READ_ONLY
        return None if self.is_required else Role.FULL

    @classmethod
    def for_address(cls, address: str, full: str = "", read_only: str = "", *, is_proxied: bool = False) -> Tokens:
        """The given tokens; random ones replace empty ones if others reach the address, by network or by a proxy."""
        if full or is_proxied or not is_loopback(address):
            return cls(full or new_token(), read_only or new_token())
        return cls("", read_only)


def new_token() -> str:
    """A random token of 128 bits."""
    return secrets.token_urlsafe(_RANDOM_BYTES)


def is_random(token: str) -> bool:
    """Whether a token has the form of `new_token`: all of its bits, in letters of both cases and digits.

    A few random tokens have no digit and count as chosen; an attempt to guess them is limited without need.
    """
    try:
        octets = base64.urlsafe_b64decode(token + "==")
    except (binascii.Error, ValueError):
        return False
    is_canonical = len(octets) == _RANDOM_BYTES and base64.urlsafe_b64encode(octets).decode().rstrip("=") == token
    return is_canonical and all(any(map(kind, token)) for kind in (str.isupper, str.islower, str.isdigit))


def is_loopback(address: str) -> bool:
    """Whether an address to listen on is reachable only from this computer."""
    if address == "localhost":
        return True
    try:
        return ipaddress.ip_address(address).is_loopback
    except ValueError:
        return False


def given_token(target: str, authorizations: Iterable[str]) -> str | None:
    """The token of a request, from `?token=` of its target or from `Authorization: Bearer`; None without either."""
    query = urllib.parse.parse_qs(target.partition("?")[2], errors="replace")
    if query.get("token"):
        return query["token"][-1]
    for value in authorizations:
        scheme, _, token = value.partition(" ")
        if scheme.lower() == "bearer":
            return token.strip()
    return None


class TooManyAttemptsError(ThymioSimError):
    """Too many tokens from an address wait to be checked; this one was not."""

    def __init__(self) -> None:
        super().__init__("too many wrong tokens from this address; try again in a minute")


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


class TokenCheck:
    """Checks the tokens that clients of one server give. Only for the thread of its event loop.

    Random tokens cannot be guessed and need no limit, so that wrong ones never lock out the right one. Chosen ones are
    limited by `AttemptLimiter`. Foreign web pages in a browser share an allowance of their own: otherwise any page that
    the owner visits could use up that of the owner's address.
    """

    def __init__(
        self, tokens: Tokens, allowed_origins: Collection[str] = (), *, now_s: Callable[[], float] = time.monotonic
    ) -> None:
        self.tokens = tokens
        self._allowed_origins = allowed_origins
        self._is_limited = not all(map(is_random, filter(None, (tokens.full, tokens.read_only))))
        self._programs, self._pages = AttemptLimiter(now_s), AttemptLimiter(now_s)

    async def role(
        self, given: str | None, address: str, *, origin: str | None = None, host: str | None = None
    ) -> Role | None:
        """The role of a client, after a pause if its address has tried many tokens; None if it may not connect.

        `origin` and `host` are those of its request. Raises TooManyAttemptsError.
        """
        if given is None or not self.tokens.is_required or not self._is_limited:
            return self.tokens.role(given)
        is_own = is_allowed(origin, host, self._allowed_origins) or is_same_local_name(origin, host)
        limiter = self._programs if is_own else self._pages
        pause_s = limiter.begin(address)
        if pause_s > 0.0:
            await asyncio.sleep(pause_s)
        role = self.tokens.role(given)
        if role is not None:
            limiter.succeed(address)
        return role


def _network(address: str) -> str:
    """The address itself, or the /64 network of an IPv6 address: one computer can use any address of its network."""
    try:
        number = ipaddress.ip_address(address.partition("%")[0])
    except ValueError:
        return address
    return address if number.version == 4 else str(ipaddress.ip_network((number, 64), strict=False))
