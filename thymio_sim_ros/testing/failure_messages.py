"""Texts of conditions and counts for failure messages."""

from __future__ import annotations

import ast
import inspect
import textwrap
from collections.abc import Callable
from typing import Any

__all__ = ["describe_condition", "pluralized"]

_LONGEST = 160


def describe_condition(condition: Callable[[], Any]) -> str:
    """Describe a condition: a check by its text, a lambda by its source, another function by its name."""
    code = getattr(condition, "__code__", None)
    if code is None:
        return repr(condition)
    if code.co_name != "<lambda>":
        return str(getattr(condition, "__qualname__", code.co_name)).rpartition(".")[2]
    line = code.co_firstlineno
    return textwrap.shorten(_lambda(condition, line) or f"the lambda of line {line}", _LONGEST)


def pluralized(number: int, noun: str) -> str:
    """A count with its noun in singular or plural."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def _lambda(condition: Callable[[], Any], line: int) -> str:
    """The text of a lambda in its statement, or "" where that cannot be read."""
    try:
        lines, begin = inspect.getsourcelines(condition)
    except (OSError, TypeError):
        return ""
    source = textwrap.dedent("".join(lines))
    for text in (source, source.rstrip().rstrip(":") + ":\n    pass"):
        try:
            tree = ast.parse(text)
        except SyntaxError:
            continue
        found = [node for node in ast.walk(tree) if isinstance(node, ast.Lambda) and node.lineno + begin - 1 == line]
        segment = ast.get_source_segment(text, found[0].body) if found else None
        return segment or ""  # another text of that name, as that of `python -c`
    return source.strip()
