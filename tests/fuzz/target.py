"""A target: a reader of untrusted bytes, and what it may raise."""

from __future__ import annotations

import atexit
import tempfile
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

__all__ = ["FOLDER", "HOSTILE", "Target", "lines", "text"]

_kept = tempfile.TemporaryDirectory(prefix="thymio-fuzz-")
atexit.register(_kept.cleanup)
FOLDER = Path(_kept.name)
"""Readers that need a file read it here."""

HOSTILE = (
    b"",
    b"[" * 3000,
    b"a = " + b"[" * 3000,
    b'{"a":' * 800,
    b"(" * 3000,
    b"<a>" * 1300,
    b"9" * 4095,
    b"\0" * 4095,
)
"""Inputs for every target besides its own: nothing, and much of the same."""


@dataclass(frozen=True)
class Target:
    """One reader.

    Attributes:
        name: name on the command line and of the file of its corpus.
        run: reads an input, and asserts what holds for all that is accepted, such as a round trip.
        rejects: the documented exceptions for an input that is rejected; any other is a finding.
        seeds: valid inputs, from which others are made.
        words: parts of its language, which are inserted into inputs.
        max_bytes: longest input.
    """

    name: str
    run: Callable[[bytes], object]
    rejects: tuple[type[Exception], ...]
    seeds: Callable[[], Iterable[bytes]]
    words: tuple[str, ...] = ()
    max_bytes: int = 4096

    def accepts(self, data: bytes) -> bool:
        """Whether an input is accepted. Raises what the reader must not raise, and AssertionError."""
        try:
            self.run(data)
        except self.rejects:
            return False
        return True


def text(data: bytes) -> str:
    """The text of an input, with half of a surrogate pair for each byte that is not UTF-8, as JSON may contain it."""
    return data.decode("utf-8", "surrogateescape")


def lines(data: bytes, count: int) -> list[bytes]:
    """An input in this many parts: the first ones end at a line break, the last one at the end."""
    parts = data.split(b"\n", count - 1)
    return parts + [b""] * (count - len(parts))
