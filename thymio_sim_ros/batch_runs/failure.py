"""The failure of a task that has no result."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["Failure"]


@dataclass(frozen=True, slots=True)
class Failure:
    """A task without a result, and the reason on one line."""

    reason: str
