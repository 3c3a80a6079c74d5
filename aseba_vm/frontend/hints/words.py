"""Words that Aseba spells differently or does not have: `elif`, `If`, `true`."""

from __future__ import annotations

from aseba_vm.errors import Hint
from aseba_vm.frontend.hints.context import BEFORE_VALUE, CONDITIONS, ErrorContext
from aseba_vm.frontend.lexer import KEYWORDS

_ELSEIF = frozenset(("elif", "elsif", "elseIf", "elseif", "ELSEIF", "ElseIf", "Elseif"))
_TRUTH = {"true": "1", "false": "0"}


def keyword_spelling(context: ErrorContext) -> Hint | None:
    """Recognize `elif` and `If`."""
    name = context.word().text
    if name in _ELSEIF:
        return context.replaced("hint-elseif", 0, 0, "elseif", name)
    small = name.lower()
    if name not in KEYWORDS and small in KEYWORDS:
        return context.replaced("hint-small-letters", 0, 0, small, name, small)
    return None


def truth_value(context: ErrorContext) -> Hint | None:
    """Recognize `true` and `false`; the edit writes 1 or 0 unless the word is a condition by itself."""
    value = _TRUTH.get(context.word().text.lower())
    if value is None or context.kind(-1) not in BEFORE_VALUE:
        return None
    is_compared = context.kind(-1) not in (*CONDITIONS, "and", "or", "not")
    if is_compared and context.kind(1) not in ("==", "!="):
        return context.replaced("hint-truth", 0, 0, value, context.word().text)
    return Hint("hint-truth", (context.word().text,))
