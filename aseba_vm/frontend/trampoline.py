"""Recursion without the depth limit of Python: recursive functions are generators that run on an explicit stack.

`child = yield self.rule()` reads like a call. Only the length of the text limits the depth; the recursion limit of
the process neither matters nor changes. A function without a `yield` must still contain one to be a generator.
"""

from __future__ import annotations

from collections.abc import Generator
from typing import Any, TypeAlias, TypeVar

T = TypeVar("T")

Task: TypeAlias = Generator["Task[Any]", Any, T]


def run(task: Task[T]) -> T:
    """Run a task and the tasks it yields, and return its result. Exceptions propagate to the task that yielded."""
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
