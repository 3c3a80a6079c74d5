"""Exceptions of the Thymio Device Manager's messages."""

from __future__ import annotations

from thymio_sim_ros.errors import ThymioSimError

__all__ = ["TdmFrameError", "ValueTypeError"]


class TdmFrameError(ThymioSimError):
    """A buffer that is not a message: `where` in it, what was `expected` and what was `found`."""

    def __init__(self, where: str, expected: str, found: str) -> None:
        super().__init__(f"message for the Thymio Device Manager, {where}: expected {expected}, found {found}")
        self.where = where
        self.expected = expected
        self.found = found


class ValueTypeError(ThymioSimError):
    """A value of a variable or event that is not made of 16-bit integers."""
