"""The failure of a task that has no result."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeVar

__all__ = ["Failure", "attempt", "line_of"]

Task = TypeVar("Task")
Result = TypeVar("Result")


@dataclass(frozen=True, slots=True)
class Failure:
    """A task without a result, and the reason on one line."""

    reason: str


def attempt(function: Callable[[Task], Result], task: Task) -> Result | Failure:
    """Call a function with a task; an exception is a failure."""
    try:
        return function(task)
    except Exception as error:
        return Failure(f"{type(error).__name__}: {line_of(error)}")


def line_of(error: BaseException) -> str:
    """The text of an exception on one line."""
    return " ".join(str(error).split()) or type(error).__name__
