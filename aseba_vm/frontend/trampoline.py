"""Recursion without the depth limit of Python: a function that descends is a generator run on a list.

``child = yield self.rule()`` reads like a call. The depth is bounded by the length of the text alone, and the
recursion limit of the surrounding program neither matters nor changes.
"""

from __future__ import annotations

from collections.abc import Generator
from typing import Any, TypeAlias, TypeVar

T = TypeVar("T")

Task: TypeAlias = Generator["Task[Any]", Any, T]


def run(task: Task[T]) -> T:
    """Run a task and those it yields, and return its result; exceptions pass through."""
    stack: list[Task[Any]] = [task]
    push, pop = stack.append, stack.pop
    value: Any = None
    while True:
        try:
            push(stack[-1].send(value))
            value = None
        except StopIteration as stop:
            value = stop.value
            pop()
            if not stack:
                return value  # type: ignore[no-any-return]  # the result of the first task, a T
