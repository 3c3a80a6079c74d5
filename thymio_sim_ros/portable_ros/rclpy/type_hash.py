"""Hashes of types."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["TypeHash"]

_SIZE = 32


@dataclass(slots=True)
class TypeHash:
    """A hash with the version of its rules."""

    version: int = -1
    value: bytes = bytes(_SIZE)

    def __str__(self) -> str:
        if self.version <= 0 or len(self.value) != _SIZE:
            return "INVALID"
        return f"RIHS{self.version:02}_{self.value.hex()}"
