"""Arrays where one value is needed."""

from __future__ import annotations

from collections.abc import Iterable

from aseba_vm.errors import Hint
from aseba_vm.frontend.hints.context import HANDLER_ENDS, STATEMENTS, ErrorContext

_ENDS = frozenset((*STATEMENTS, *HANDLER_ENDS, "then", "do", "else", "elseif", "end", "var", "const", ""))
"""Tokens that no expression contains."""
_EXAMPLE = 2
"""Number of the value in a hint, if there are so many: the middle of ``prox.horizontal``, the vertical of ``acc``."""


def array_as_operand(context: ErrorContext) -> Hint | None:
    """Recognize ``prox.horizontal > 2000`` and ``motor.left.target = prox.horizontal``."""
    left, right = context.error.arguments
    if right == 1:
        return _whole_array(context, range(-1, -context.at - 1, -1), left)
    return _whole_array(context, range(len(context.words) - context.at), right) if left == 1 else None


def array_as_condition(context: ErrorContext) -> Hint | None:
    """Recognize ``if acc == 3`` where both sides are arrays, and ``if acc then``."""
    return _whole_array(context, range(1, len(context.words) - context.at), None)


def array_as_argument(context: ErrorContext) -> Hint | None:
    """Recognize ``call sound.freq(acc, 3)``."""
    *_, found, expected = context.error.arguments
    return _whole_array(context, range(1), found) if expected == 1 else None


def _whole_array(context: ErrorContext, distances: Iterable[int], size: object) -> Hint | None:
    """Return the hint for the first array of a size (None: of any) without an index in these tokens."""
    for distance in distances:
        if context.kind(distance) in _ENDS:
            return None
        if context.kind(distance) != "identifier" or context.kind(distance + 1) == "[":
            continue
        name = context.word(distance).text
        values = context.variables.get(name, 1)
        if values != 1 and size in (None, values):
            return Hint("hint-whole-array", (name, values, min(_EXAMPLE, values - 1)))
    return None
