"""Decoding of untrusted JSON at a bounded cost: any text takes a few milliseconds at most.

Four megabytes of `[],[],…` take 0.4 s to decode, during which no other thread can run Python, while a string of that
length takes 5 ms. A long text is therefore decoded only if nearly all of it is inside strings, as in a playground with
images.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from json.decoder import scanstring  # type: ignore[attr-defined]  # not in typeshed
from typing import Any

from thymio_sim_ros.errors import ThymioSimError

__all__ = ["MAX_STRUCTURE", "TooMuchStructureError", "loads"]

MAX_STRUCTURE = 128 << 10
"""Characters outside strings, including quotes: enough for some 4000 subscriptions in one message."""


class TooMuchStructureError(ThymioSimError, ValueError):
    """More than `MAX_STRUCTURE` characters outside of strings."""


def loads(text: str, parse_constant: Callable[[str], Any] | None = None) -> Any:
    """Decode JSON like `json.loads`. Raises ValueError, also for too much structure, or RecursionError."""
    if len(text) > MAX_STRUCTURE:
        _check_structure(text)
    return json.loads(text, parse_constant=parse_constant)


def _check_structure(text: str) -> None:
    """Raise TooMuchStructureError. `scanstring`, in C, skips each string; only the text between strings is counted."""
    size, end = 0, 0
    while (quote := text.find('"', end)) >= 0:
        size += quote - end + 2
        if size > MAX_STRUCTURE:
            break
        _, end = scanstring(text, quote + 1, True)
    else:
        size += len(text) - end
    if size > MAX_STRUCTURE:
        raise TooMuchStructureError(f"more than {MAX_STRUCTURE} characters outside of strings")
