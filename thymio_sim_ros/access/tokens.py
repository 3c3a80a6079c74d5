"""Tokens and the roles that they give.

A server without a token serves every client that can reach its address. Tokens travel in addresses and headers, never
in messages, parameters or logs, which every client may read.
"""

from __future__ import annotations

import base64
import binascii
import hmac
import re
import secrets
from dataclasses import dataclass, field
from enum import StrEnum

from thymio_sim_ros.access.hosts import is_loopback

__all__ = ["READ_ONLY_VARIABLE", "TOKEN", "TOKEN_VARIABLE", "Role", "Tokens", "is_random", "new_token"]

TOKEN_VARIABLE, READ_ONLY_VARIABLE = "THYMIO_SIM_TOKEN", "THYMIO_SIM_READ_ONLY_TOKEN"
"""Environment variables with tokens. Unlike arguments of a command, other users of the computer cannot read them."""

TOKEN = re.compile(r"[A-Za-z0-9._~-]{4,200}")
"""Form of a token: it needs no escapes in an address; shorter ones could be guessed."""

_RANDOM_BYTES = 16
"""Size of a random token."""


class Role(StrEnum):
    """The permissions of a client; read-only clients get theirs in the metadata of serverInfo (key `access`)."""

    FULL = "full"
    READ_ONLY = "read_only"


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
