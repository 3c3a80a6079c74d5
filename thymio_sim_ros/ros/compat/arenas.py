"""The arenas of glibc's `malloc`: pools of memory, by default up to eight for each processor.

Memory that is free in one arena does not serve threads of another one. Fast DDS starts threads for each participant
and the bridge for each call, so that a suite of a class collected free memory in sixteen arenas (docs/reliability.md,
"Soak").
"""

from __future__ import annotations

import ctypes
import platform

__all__ = ["MOST_ARENAS", "limit_arenas"]

MOST_ARENAS = 2
"""One for the thread that executes ROS, one for all others."""

_M_ARENA_MAX = -8
"""Option of `mallopt`; source: mallopt(3)."""


def limit_arenas() -> None:
    """Limit the arenas of this process to `MOST_ARENAS`; those that exist already stay. Does nothing without glibc."""
    if platform.libc_ver()[0] == "glibc":
        ctypes.CDLL(None).mallopt(_M_ARENA_MAX, MOST_ARENAS)
