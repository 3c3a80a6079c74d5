"""Characters that start no token of Aseba: `;`, quotation marks, decimal points, look-alikes."""

from __future__ import annotations

import re

from aseba_vm.errors import Edit, Hint
from aseba_vm.frontend.hints.context import ErrorContext

_SPACE = ("", " ", "\t", "\r", "\n")
_QUOTES = frozenset("\"'“”„«»‘’‚")
_LOOK_ALIKE = {
    "\u00a0": " ", "\u2007": " ", "\u202f": " ", "\u200b": "", "\ufeff": "", "−": "-", "–": "-", "—": "-", "×": "*",
    "·": "*", "÷": "/", "≤": "<=", "≥": ">=", "≠": "!=",
}  # fmt: skip
"""Characters that word processors and web pages substitute for those of a program."""
_COMMENTS = re.compile(r"#\*.*?\*#|#[^\r\n]*", re.DOTALL)
_DECIMAL = re.compile(r"[0-9]+\.[0-9]+(?![\w.])")


def semicolon(context: ErrorContext) -> Hint | None:
    """Recognize `;`; the edit removes all of them."""
    source = context.source
    if source[context.offset] != ";" or sum((word.kind == "[") - (word.kind == "]") for word in context.words) > 0:
        return None
    code = _COMMENTS.sub(lambda comment: " " * len(comment[0]), source)
    first, last = code.index(";"), code.rindex(";")
    text = "".join(
        letter if code[at] != ";" else "" if source[at + 1 : at + 2] in _SPACE else " "
        for at, letter in enumerate(source[first : last + 1], start=first)
    )
    return Hint("hint-semicolon", (), Edit(first, last + 1, text))


def quotation_mark(context: ErrorContext) -> Hint | None:
    """Recognize a text in quotation marks."""
    return Hint("hint-text", ()) if context.source[context.offset] in _QUOTES else None


def look_alike(context: ErrorContext) -> Hint | None:
    """Recognize a typographic sign in place of an operator, and an unusual or invisible space."""
    letter = context.source[context.offset]
    right = _LOOK_ALIKE.get(letter)
    if right is None:
        return None
    edit = Edit(context.offset, context.offset + 1, right)
    if not right.strip():
        return Hint("hint-invisible", (f"U+{ord(letter):04X}",), edit)
    return Hint("hint-look-alike", (right,), edit)


def decimals(context: ErrorContext) -> Hint | None:
    """Recognize `1.5`."""
    number = _DECIMAL.match(context.source, context.offset)
    return Hint("hint-decimals", (number[0],)) if number is not None else None
