"""Inputs made from others, for a quick run without a fuzzer."""

from __future__ import annotations

import random
from collections.abc import Sequence

from tests.fuzz.target import Target

__all__ = ["mutated"]

_NUMBERS = (b"0", b"-1", b"1e999", b"65536", b"9" * 400, b"NaN", b"[" * 3000, b"{" * 50, b"\xff\xff\xff\xff", b"\0" * 8)
"""Values at the borders of what readers expect."""


def mutated(rng: random.Random, corpus: Sequence[bytes], target: Target) -> bytes:
    """Return an input of the corpus with one to four changes."""
    data = bytearray(rng.choice(corpus))
    for _ in range(rng.choice((1, 1, 2, 4))):
        at = rng.randrange(len(data) + 1)
        match rng.randrange(6):
            case 0 if at < len(data):
                data[at] ^= 1 << rng.randrange(8)
            case 1:
                del data[at : at + rng.choice((1, 2, 4, 50))]
            case 2:
                data[at:at] = rng.choice(_NUMBERS)
            case 3 if target.words:
                data[at:at] = rng.choice(target.words).encode("utf-8", "surrogateescape")
            case 4:
                other = rng.choice(corpus)
                data[at:] = other[rng.randrange(len(other) + 1) :]
            case _:
                data[at : at + 1] = data[at : at + 40] * 2
    return bytes(data[: target.max_bytes])
