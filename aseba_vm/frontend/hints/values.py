"""Values of the wrong form: a variable where only a constant can be, a whole array where one value is needed."""

from __future__ import annotations

from aseba_vm.errors import Hint
from aseba_vm.frontend.hints.context import CONNECTORS, STATEMENTS, ErrorContext

_EXPRESSION_ENDS = STATEMENTS | frozenset(("then", "do", "else", "elseif", "end", "onevent", "sub", "var", "const"))
_EXAMPLE_INDEX = 2
"""The element that a hint gives as example: the front sensor of `prox.horizontal`."""


def variable_as_bound(context: ErrorContext) -> Hint | None:
    """Recognize `for i in 0:n do` with a variable `n`."""
    return _needs_constant(context, "bound", 0, 1)


def variable_as_size(context: ErrorContext) -> Hint | None:
    """Recognize `var a[n]` and `const A = n` with a variable `n`."""
    if context.kind() == "[":
        return _needs_constant(context, "size", 1, context.bracket(0))
    return _needs_constant(context, "value", 2, _expression_end(context, 2))


def later_variable_as_size(context: ErrorContext) -> Hint | None:
    """Recognize the same with a variable that is declared below, which is unknown there."""
    if context.word().text not in context.declared:
        return None
    first = context.at
    while first > 0 and context.words[first].kind not in ("var", "const"):
        first -= 1
    distance = first - context.at
    if context.kind(distance) == "const":
        return _needs_constant(context, "value", 0, 1)
    close = context.bracket(distance + 2) if context.kind(distance + 2) == "[" else None
    return _needs_constant(context, "size", 0, 1) if close is not None and close > 0 else None


def variable_in_slice(context: ErrorContext) -> Hint | None:
    """Recognize `a[0:n]` and `a[n:3]`."""
    if context.kind() != ":" or context.error.arguments not in ((), ("]", ":")):
        return None
    if context.error.arguments:
        first = 0
        while context.kind(first) not in ("[", ""):
            first -= 1
        return _needs_constant(context, "slice", first + 1, 0)
    return _needs_constant(context, "slice", 1, _expression_end(context, 1))


def calculated_bound(context: ErrorContext) -> Hint | None:
    """Recognize `for i in 0:N-1 do` and `for i in 0:-n do`."""
    first = 0
    while context.kind(first - 1) not in (*_EXPRESSION_ENDS, "in", ""):
        first -= 1
    if context.kind(first - 1) != "in" or context.kind(first - 3) != "for":
        return None
    if context.kind() not in (*CONNECTORS, "(", "[", "abs", "~") and context.kind(-1) != "-":
        return None
    return _needs_constant(context, "bound", 0, 1) or Hint("hint-calculated-bound")


def whole_array(context: ErrorContext) -> Hint | None:
    """Recognize `if prox.horizontal > 2000 then` and other places where an array has to be one value."""
    first, end = 1, _expression_end(context, 1)
    size = 0
    match context.error.kind, context.error.arguments:
        case "size-mismatch", (1, int(size)):
            pass
        case "size-mismatch", (int(size), 1):
            first, end = -context.at, 0
            if _is_declaration(context):
                return None
        case "event-argument-size" | "event-argument-too-large", (_, 1, int(size)):
            first, end = 2, _expression_end(context, 2)
        case "argument-size" | "argument-size-template", (_, _, _, int(size), 1):
            first, end = 0, _expression_end(context, 0)
    names = _whole_names(context, first, end)
    fitting = [found for found in names if found[1] > 1 and size in (0, found[1])]
    if not fitting:
        return None
    shown, count, element = fitting[-1 if end == 0 else 0]
    return Hint("hint-whole-array", (shown, count, element))


def _needs_constant(context: ErrorContext, place: str, first: int, end: int | None) -> Hint | None:
    """The hint about the first variable between two distances."""
    for distance in range(first, len(context.words) - context.at if end is None else end):
        name = context.word(distance).text
        if context.kind(distance) != "identifier" or name in context.symbols.constants:
            continue
        if name in context.declared or name in context.symbols.variables:
            example = name if name in context.declared else "N"
            return Hint(f"hint-constant-{place}", (name, example))
    return None


def _expression_end(context: ErrorContext, first: int) -> int:
    """The distance after an expression: that of the next keyword, comma or second value."""
    depth, distance = 0, first
    while context.kind(distance) not in (*_EXPRESSION_ENDS, "end-of-input", ""):
        kind = context.kind(distance)
        depth += (kind in ("(", "[")) - (kind in (")", "]"))
        is_next = kind in ("identifier", "integer") and context.kind(distance - 1) in (
            "identifier",
            "integer",
            "]",
            ")",
        )
        if depth < 0 or (depth == 0 and distance > first and (kind == "," or is_next)):
            break
        distance += 1
    return distance


def _is_declaration(context: ErrorContext) -> bool:
    """Whether the error is at the `=` of the declaration of an array."""
    distance = -1
    if context.kind(-1) == "]":
        while context.kind(distance) not in ("[", ""):
            distance -= 1
        distance -= 1
    return context.kind(distance - 1) == "var"


def _whole_names(context: ErrorContext, first: int, end: int) -> list[tuple[str, int, str]]:
    """Text, size and an element of each array and slice between two distances, outside indexes and lists."""
    found = []
    distance = first
    while distance < end:
        if context.kind(distance) == "[":
            distance = context.bracket(distance) or end
        elif context.kind(distance) == "identifier" and context.word(distance).text in context.symbols.variables:
            name = context.word(distance).text
            size = context.symbols.variables[name].size
            if context.kind(distance + 1) != "[":
                found.append((name, size, f"{name}[{min(_EXAMPLE_INDEX, size - 1)}]"))
            else:
                close = context.bracket(distance + 1) or end
                inside = [context.word(index) for index in range(distance + 2, close)]
                limits = [context.source[word.start : word.end] for word in inside]
                if [word.kind for word in inside] == ["integer", ":", "integer"]:
                    shown = context.source[context.word(distance).start : context.word(close).end]
                    found.append((shown, int(limits[2], 0) - int(limits[0], 0) + 1, f"{name}[{limits[0]}]"))
                distance = close
        distance += 1
    return found
