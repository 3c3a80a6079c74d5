"""Hashes of types."""

from __future__ import annotations

from typing import ClassVar

from thymio_sim_ros.portable_ros.rclpy_parts.checked_field import checked_field

__all__ = ["TypeHash"]

_SIZE = 32


class TypeHash:
    """A hash with the version of its rules. Raises AssertionError for values of other types."""

    __slots__: ClassVar[list[str]] = ["_version", "_value"]  # noqa: RUF023  # in the order of the arguments

    version = checked_field("version", int)
    value = checked_field("value", bytes)

    def __init__(self, version: int = -1, value: bytes = bytes(_SIZE)) -> None:
        self.version, self.value = version, value

    def __eq__(self, other: object) -> bool:
        return isinstance(other, TypeHash) and (self.version, self.value) == (other.version, other.value)

    __hash__ = None  # type: ignore[assignment]  # as rclpy's

    def __str__(self) -> str:
        if self.version <= 0 or len(self.value) != _SIZE:
            return "INVALID"
        return f"RIHS{self.version:02}_{self.value.hex()}"
