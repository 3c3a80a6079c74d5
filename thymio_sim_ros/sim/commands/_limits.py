"""Limits of the numbers in a command."""

from __future__ import annotations

__all__ = ["check"]


def check(command: object, low: float, high: float, *fields: str) -> None:
    """ValueError unless these fields lie in a range (NaN does not)."""
    for field in fields:
        value = getattr(command, field)
        if not low <= value <= high:
            raise ValueError(f"{type(command).__name__}: {field} {value} found, expected {low:g} to {high:g}")
