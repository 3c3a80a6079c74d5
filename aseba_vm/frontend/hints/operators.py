"""Operators of other languages, and comparison confused with assignment."""

from __future__ import annotations

import re

from aseba_vm.errors import Edit, Hint
from aseba_vm.frontend.hints.context import CONDITIONS, ErrorContext, spaced

_DOUBLED = {("&", "&"): "and", ("|", "|"): "or"}
_COMPARISONS = {("<", ">"): "!=", ("==", "="): "==", ("!=", "="): "!="}
_SWAPPED = {">": ">=", "<": "<="}
_OPERAND = re.compile(r"![ \t]*([^\W\d][\w.]*(?:\[[0-9]+\])?)(?=[ \t]*(?:\)|then\b|do\b|and\b|or\b|&&|\|\|))")


def equals_in_condition(context: ErrorContext) -> Hint | None:
    """Recognize `if a = 1` and `if a => 1`."""
    if context.kind() != "=" or not context.condition():
        return None
    if context.is_adjacent(0) and context.kind(1) in _SWAPPED:
        right = _SWAPPED[context.kind(1)]
        return context.replaced("hint-comparison", 0, 1, right, right)
    return context.replaced("hint-equals-in-condition", 0, 0, "==")


def doubled_operator(context: ErrorContext) -> Hint | None:
    """Recognize `&&`, `||`, `<>`, `===` and `!==`, whose second half was rejected."""
    if not context.is_adjacent(-1):
        return None
    pair = (context.kind(-1), context.kind())
    if pair in _DOUBLED:
        word = _DOUBLED[pair]
        first, second = context.word(-1), context.word()
        text = spaced(context.source, first.start, second.end, word)
        return Hint(f"hint-{word}", (), Edit(first.start, second.end, text))
    if pair in _COMPARISONS:
        return context.replaced("hint-comparison", -1, 0, _COMPARISONS[pair], _COMPARISONS[pair])
    return None


def comparison_as_statement(context: ErrorContext) -> Hint | None:
    """Recognize `a == 1` or `a := 1` in place of an assignment."""
    if context.kind() == "==":
        return context.replaced("hint-assignment", 0, 0, "=")
    if context.kind() == ":" and context.kind(1) == "=" and context.is_adjacent(0):
        return context.replaced("hint-assignment", 0, 1, "=")
    return None


def comparison_in_declaration(context: ErrorContext) -> Hint | None:
    """Recognize `var a == 1` and `const A := 1`."""
    return comparison_as_statement(context) if context.kind(-1) in ("identifier", "]") else None


def step_in_front(context: ErrorContext) -> Hint | None:
    """Recognize `++i`."""
    if context.kind() not in ("++", "--") or context.kind(1) != "identifier" or not context.is_statement_expected:
        return None
    name, mark = context.word(1), context.word()
    return context.replaced("hint-step", 0, 1, f"{name.text}{mark.kind}", f"{name.text}{mark.kind}")


def negation(context: ErrorContext) -> Hint | None:
    """Recognize `!` in a condition, or `! =`."""
    source, at = context.source, context.offset
    spaced = re.match(r"![ \t]+=(?!=)", source[at:])
    if spaced is not None:
        return Hint("hint-not-equal", (), Edit(at, at + spaced.end(), "!="))
    if not context.condition() or context.kind(-1) not in (*CONDITIONS, "and", "or", "not", "(", "&", "|"):
        return None
    value = _OPERAND.match(source, at)
    if value is not None:
        return Hint("hint-not", (), Edit(at, value.end(), f"{value[1]} == 0"))
    return Hint("hint-not", (), Edit(at, at + 1, "not " if source[at + 1 : at + 2] == "(" else "not"))


def number_as_condition(context: ErrorContext) -> Hint | None:
    """Recognize `if a then` where `a` is a number."""
    if context.kind() not in CONDITIONS or context.error.arguments != ("boolean", "integer"):
        return None
    size = 1
    if context.kind(size) != "identifier":
        return None
    size += 3 if (context.kind(2), context.kind(3), context.kind(4)) == ("[", "integer", "]") else 0
    if context.kind(size + 1) not in ("then", "do"):
        return None
    last = context.word(size)
    shown = context.source[context.word(1).start : last.end]
    return Hint("hint-truth-of-number", (shown,), Edit(last.end, last.end, " != 0"))
