"""Names that are misspelt or incomplete, and names of variables where their value is not known yet."""

from __future__ import annotations

from collections.abc import Iterable

from aseba_vm.errors import Hint
from aseba_vm.frontend.hints.context import ErrorContext

_SHOWN = 5
"""Most names in a hint."""
_SHORTEST = 3
"""Letters of a name that is corrected: any name of two letters is similar to any other."""
_BEFORE_NAME = {"unknown-function": 1, "unknown-subroutine": 1}
"""Distance of the name from the position of the error, if it is not 0."""


def longer_names(context: ErrorContext) -> Hint | None:
    """Recognize the first part of longer names, as ``leds.bottom``; the edit writes the only one."""
    kind = context.error.kind.removesuffix("-hint")
    if kind == "unknown-event" and context.kind(-1) in ("emit", "_emit"):
        return None  # those of the robot cannot be emitted
    at, name = _BEFORE_NAME.get(kind, 0), str(context.error.arguments[0])
    known: dict[str, Iterable[str]] = {
        "unknown-variable": context.variables,
        "unknown-function": context.natives,
        "unknown-event": context.events,
        "unknown-subroutine": context.subs,
    }
    found = sorted(one for one in known[kind] if one.startswith(f"{name}."))
    if not found:
        return None
    if len(found) == 1:
        return context.replaced("hint-spelling", at, at, found[0], found[0])
    return Hint("hint-longer-names", (name, ", ".join(found[:_SHOWN]) + (", …" if len(found) > _SHOWN else "")))


def spelling(context: ErrorContext) -> Hint | None:
    """Recognize a name that differs from a known one by a letter or two."""
    name = str(context.error.arguments[0])
    if not context.error.kind.endswith("-hint") or len(name) < _SHORTEST:
        return None
    at, right = _BEFORE_NAME.get(context.error.kind.removesuffix("-hint"), 0), str(context.error.arguments[1])
    return context.replaced("hint-spelling", at, at, right, right)


def variable_as_limit(context: ErrorContext) -> Hint | None:
    """Recognize ``for i in 0:n do`` where ``n`` is a variable."""
    name = context.word().text
    return Hint("hint-loop-constant", (name,)) if name in context.variables else None


def variable_as_constant(context: ErrorContext) -> Hint | None:
    """Recognize a variable in a size, in the value of a constant, and in the range of a slice."""
    if context.error.kind == "expected-token" and context.error.arguments != ("]", ":"):
        return None
    return _not_constant(context, range(context.at - 1, context.at + 1)) or _not_constant(
        context, range(context.at, len(context.words))
    )


def _not_constant(context: ErrorContext, places: Iterable[int]) -> Hint | None:
    """Return the hint for the first variable at these indices of tokens, up to the end of the expression."""
    depth = 0
    for index in places:
        word = context.words[index]
        depth += {"[": 1, "]": -1}.get(word.kind, 0)
        if depth < 0 or word.kind in ("var", "onevent", "sub", "end-of-input"):
            return None
        if word.kind == "identifier" and word.text in context.variables:
            return Hint("hint-constant", (word.text,))
    return None
