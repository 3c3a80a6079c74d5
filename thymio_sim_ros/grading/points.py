"""Points of tests: `@pytest.mark.points(3)`, shared by the parameters of a test function."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from fractions import Fraction

import pytest

__all__ = ["points_of"]

MARK = "points"


def points_of(items: Sequence[pytest.Item]) -> list[Fraction]:
    """Points of each test: those of its function, divided by the number of its parameters; 1 without a mark.

    The nearest mark counts. Raises pytest.UsageError for a mark with anything but one number from 0 on.
    """
    functions = [_function(item) for item in items]
    sizes = Counter(functions)
    return [_marked(item) / sizes[function] for item, function in zip(items, functions, strict=True)]


def _function(item: pytest.Item) -> str:
    return item.nodeid.partition("[")[0]


def _marked(item: pytest.Item) -> Fraction:
    mark = item.get_closest_marker(MARK)
    if mark is None:
        return Fraction(1)
    value = mark.args[0] if len(mark.args) == 1 and not mark.kwargs else None
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value) or value < 0:
        found = ", ".join(map(repr, mark.args)) or "nothing"
        raise pytest.UsageError(f"{item.nodeid}: mark {MARK}: found {found}, expected one number from 0 on")
    return Fraction(str(value))
