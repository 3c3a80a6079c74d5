"""Access control without I/O: tokens, their roles, and a limit on attempts with wrong tokens.

A server without a token serves every client that can reach its address. Tokens travel in addresses and headers, never
in messages, parameters or logs, which every client may read.
"""

from __future__ import annotations

import hmac
import ipaddress
import re
import secrets
import urllib.parse
from collections import OrderedDict
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

from thymio_sim_ros.bridge.protocol.constants import Role

__all__ = [
    "READ_ONLY_VARIABLE",
    "TOKEN",
    "TOKEN_VARIABLE",
    "AttemptLimiter",
    "Tokens",
    "given_token",
    "is_loopback",
    "new_token",
]

TOKEN_VARIABLE, READ_ONLY_VARIABLE = "THYMIO_SIM_TOKEN", "THYMIO_SIM_READ_ONLY_TOKEN"
"""Environment variables with tokens. Unlike arguments of a command, other users of the computer cannot read them."""

TOKEN = re.compile(r"[A-Za-z0-9._~-]{4,200}")
"""Form of a token: it needs no escapes in an address; shorter ones could be guessed."""

_BURST = 30
"""Wrong tokens that an address may try without waiting."""
_PER_S = 1.0
"""Attempts that an address regains per second."""
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
        found = (given or "").encode("utf-8", "surrogatepass")
        is_full = bool(self.full) and hmac.compare_digest(found, self.full.encode())
        is_read_only = bool(self.read_only) and hmac.compare_digest(found, self.read_only.encode())
        if is_full:
            return Role.FULL
        if is_read_only:
            return Role.READ_ONLY
        return None if self.is_required else Role.FULL

    @classmethod
    def for_address(cls, address: str, full: str = "", read_only: str = "") -> Tokens:
        """The given tokens; random ones replace empty ones if the address is reachable from the network."""
        if full or not is_loopback(address):
            return cls(full or new_token(), read_only or new_token())
        return cls("", read_only)


def new_token() -> str:
    """A random token of 128 bits."""
    return secrets.token_urlsafe(16)


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


class AttemptLimiter:
    """Limits how often an address may try a wrong token: `_BURST` times immediately, then `_PER_S` times per second."""

    def __init__(self, now_s: Callable[[], float]) -> None:
        """`now_s` is a monotonic clock, s."""
        self._now_s = now_s
        self._remaining_by_network: OrderedDict[str, tuple[float, float]] = OrderedDict()
        """Network → remaining attempts and the time of this number, s; the most recently used last."""

    def is_allowed_to_try(self, address: str) -> bool:
        """Whether a token from this address is checked."""
        return self._remaining(_network(address)) >= 1.0

    def record_failure(self, address: str) -> None:
        """Count a wrong token from this address."""
        network = _network(address)
        self._remaining_by_network[network] = (self._remaining(network) - 1.0, self._now_s())
        self._remaining_by_network.move_to_end(network)
        if len(self._remaining_by_network) > _MAX_ADDRESSES:
            self._remaining_by_network.popitem(last=False)

    def _remaining(self, network: str) -> float:
        remaining, since_s = self._remaining_by_network.get(network, (float(_BURST), 0.0))
        return min(float(_BURST), remaining + (self._now_s() - since_s) * _PER_S)


def _network(address: str) -> str:
    """The address itself, or the /64 network of an IPv6 address: one computer can use any address of its network."""
    try:
        number = ipaddress.ip_address(address.partition("%")[0])
    except ValueError:
        return address
    return address if number.version == 4 else str(ipaddress.ip_network((number, 64), strict=False))
