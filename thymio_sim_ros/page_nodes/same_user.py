"""Whether a connection of loopback comes from a program of this user.

All users of a computer share its loopback address. Linux lists the connections with their users; elsewhere only a token
keeps other users out (SECURITY.md).
"""

from __future__ import annotations

import ipaddress
import os
import sys
from pathlib import Path

__all__ = ["is_same_user"]

_TABLES = {4: "/proc/net/tcp", 6: "/proc/net/tcp6"}
_LOCAL, _REMOTE, _USER = 1, 2, 7
"""Columns of a table (proc_pid_net(5))."""


def is_same_user(peer: tuple[str, int], own: tuple[str, int]) -> bool:
    """Whether the program at `peer`, connected with the address `own`, is of this user; true if that is unknown."""
    if not sys.platform.startswith("linux"):
        return True
    version = ipaddress.ip_address(peer[0].partition("%")[0]).version
    try:
        lines = Path(_TABLES[version]).read_text("ascii").splitlines()[1:]
    except OSError:
        return False
    ends = _hexadecimal(*peer), _hexadecimal(*own)
    found = [row for row in map(str.split, lines) if (row[_LOCAL], row[_REMOTE]) == ends]
    return any(int(row[_USER]) == os.geteuid() for row in found)


def _hexadecimal(address: str, port: int) -> str:
    """An address as the tables have it: words of 32 bits in the order of the machine."""
    packed = ipaddress.ip_address(address.partition("%")[0]).packed
    words = (packed[at : at + 4] for at in range(0, len(packed), 4))
    ordered = b"".join(word[::-1] if sys.byteorder == "little" else word for word in words)
    return f"{ordered.hex().upper()}:{port:04X}"
