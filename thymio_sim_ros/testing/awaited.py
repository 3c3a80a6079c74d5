"""Awaited conditions: one that needs something that has not happened yet is false until then."""

from __future__ import annotations

from collections.abc import Callable
from typing import Generic, Literal, TypeVar

from thymio_sim_ros.errors import ThymioSimError

__all__ = ["Awaited", "NothingYetError"]


T = TypeVar("T")


class NothingYetError(ThymioSimError, IndexError):
    """There is nothing yet, such as no message on a topic; `until` waits for it."""


class Awaited(Generic[T]):
    """A condition of `until`."""

    def __init__(self, condition: Callable[[], T]) -> None:
        self._condition = condition
        self._missing = ""

    def __call__(self) -> T | Literal[False]:
        """The value of the condition; False while it raises NothingYetError."""
        try:
            value = self._condition()
        except NothingYetError as error:
            self._missing = str(error)
            return False
        self._missing = ""
        return value

    def missing(self) -> str:
        """The data that the condition lacks, as the end of a failure message; empty if it could be evaluated."""
        return f"\n({self._missing})" if self._missing else ""
