"""Access control: tokens, their roles, and a limit for attempts with wrong tokens. Without sockets.

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
"""Environment variables: what a command is started with, every user of the computer may see."""

TOKEN = re.compile(r"[A-Za-z0-9._~-]{4,200}")
"""A token needs no escapes in an address; shorter ones are guessed."""

_BURST = 30
_PER_S = 1.0
_MAX_ADDRESSES = 1000


@dataclass(frozen=True, slots=True)
class Tokens:
    """The tokens of a server. Without `full` everyone may do everything, but for a client with the read-only one."""

    full: str = field(default="", repr=False)
    read_only: str = field(default="", repr=False)

    @property
    def is_required(self) -> bool:
        """Whether a client needs one."""
        return bool(self.full)

    def role(self, given: str | None) -> Role | None:
        """The role of a client that gives this token; None: it may not connect."""
        # Each comparison takes the same time whatever is given.
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
        """These tokens; where the network reaches the address, new ones in place of those that are empty."""
        if full or not is_loopback(address):
            return cls(full or new_token(), read_only or new_token())
        return cls("", read_only)


def new_token() -> str:
    """A random token of 128 bits."""
    return secrets.token_urlsafe(16)


def is_loopback(address: str) -> bool:
    """Whether an address to listen on is reached from this computer only."""
    if address == "localhost":
        return True
    try:
        return ipaddress.ip_address(address).is_loopback
    except ValueError:
        return False


def given_token(target: str, authorizations: Iterable[str]) -> str | None:
    """The token of a request: `?token=` of its target, or `Authorization: Bearer`; None where it has neither."""
    query = urllib.parse.parse_qs(target.partition("?")[2], errors="replace")
    if query.get("token"):
        return query["token"][-1]
    for value in authorizations:
        scheme, _, token = value.partition(" ")
        if scheme.lower() == "bearer":
            return token.strip()
    return None


class AttemptLimiter:
    """Limits how often an address may try a wrong token: `_BURST` times at once, then `_PER_S`."""

    def __init__(self, now_s: Callable[[], float]) -> None:
        self._now_s = now_s
        self._left: OrderedDict[str, tuple[float, float]] = OrderedDict()
        """Network → attempts that are left, and since when; the most recent last."""

    def is_allowed_to_try(self, address: str) -> bool:
        """Whether a token from this address is looked at."""
        return self._left_of(_network(address)) >= 1.0

    def record_failure(self, address: str) -> None:
        """A token from this address was wrong."""
        network = _network(address)
        self._left[network] = (self._left_of(network) - 1.0, self._now_s())
        self._left.move_to_end(network)
        if len(self._left) > _MAX_ADDRESSES:
            self._left.popitem(last=False)

    def _left_of(self, network: str) -> float:
        left, since_s = self._left.get(network, (float(_BURST), 0.0))
        return min(float(_BURST), left + (self._now_s() - since_s) * _PER_S)


def _network(address: str) -> str:
    """The number itself; of IPv6 the network, in which one computer has as many numbers as it likes."""
    try:
        number = ipaddress.ip_address(address.partition("%")[0])
    except ValueError:
        return address
    return address if number.version == 4 else str(ipaddress.ip_network((number, 64), strict=False))
