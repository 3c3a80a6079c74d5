"""Limits of the numbers in a command."""

from __future__ import annotations

__all__ = ["check", "check_counts"]


def check(command: object, low: float, high: float, *fields: str) -> None:
    """Raise ValueError unless these fields are in a range; NaN is not."""
    for field in fields:
        value = getattr(command, field)
        if not low <= value <= high:
            raise ValueError(f"{type(command).__name__}: {field} {value} found, expected {low:g} to {high:g}")


def check_counts(command: object, counts: tuple[int, ...], number: int, high: int) -> None:
    """Raise ValueError unless there are `number` counts from 0 to `high`, or -1 for a measured one."""
    name = type(command).__name__
    if len(counts) != number:
        raise ValueError(f"{name}: {len(counts)} counts found, expected {number}")
    for index, count in enumerate(counts):
        if not -1 <= count <= high:
            raise ValueError(f"{name}: counts[{index}] {count} found, expected 0 to {high}, or -1")
