"""Repeatable randomness: one generator for each robot and each of its sensors and actuators."""

from __future__ import annotations

import hashlib
import random

__all__ = ["Noise"]


class Noise:
    """The random numbers of one user. Invariant: they depend on (seed, robot, user) alone, not on other users."""

    __slots__ = ("_enabled", "_random")

    def __init__(self, seed: int, robot: str, user: str, *, enabled: bool = True) -> None:
        digest = hashlib.blake2b(f"{seed}/{robot}/{user}".encode(), digest_size=8).digest()
        self._random = random.Random(int.from_bytes(digest, "big"))
        self._enabled = enabled

    def gauss(self, sigma: float) -> float:
        """Normal around 0; exactly 0 when noise is off."""
        return self._random.gauss(0.0, sigma) if self._enabled else 0.0

    def uniform(self, low: float, high: float) -> float:
        """Even between low and high; their middle when noise is off."""
        return low + (high - low) * self._random.random() if self._enabled else (low + high) / 2
