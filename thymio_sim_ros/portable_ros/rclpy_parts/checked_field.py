"""Attributes that refuse values of other types, as the records of rclpy have them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

__all__ = ["checked_field"]


def checked_field(name: str, kind: type[Any], convert: Callable[[Any], Any] = lambda value: value) -> property:
    """A property that keeps its value in the slot `_name`.

    `convert` makes a value of what is assigned. Raises AssertionError for a value that is then not of the type `kind`.
    """
    slot = f"_{name}"

    def assign(record: object, value: Any) -> None:
        converted = convert(value)
        if not isinstance(converted, kind):
            raise AssertionError(f"{name}: found {value!r}, expected {kind.__name__}")
        object.__setattr__(record, slot, converted)

    return property(lambda record: getattr(record, slot), assign, doc=f"The field `{name}`.")
