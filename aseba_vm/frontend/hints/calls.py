"""Calls of native functions and subroutines: `call` and `callsub` left out or confused, results, parentheses."""

from __future__ import annotations

from dataclasses import replace

from aseba_vm.errors import Edit, Hint
from aseba_vm.frontend.hints.context import BEFORE_VALUE, CONNECTORS, HANDLER_ENDS, STATEMENTS, ErrorContext


def native_as_statement(context: ErrorContext) -> Hint | None:
    """Recognize `sound.freq(440, 1)` without `call`."""
    at = _called_name(context)
    if context.kind(at) != "identifier" or context.kind(at + 1) != "(" or not context.is_statement(at):
        return None
    name = context.word(at)
    if name.text in context.natives:
        return Hint("hint-call", (name.text,), Edit(name.start, name.start, "call "))
    return None


def native_with_variable(context: ErrorContext) -> Hint | None:
    """Recognize a function without `call` where a variable has the same name, such as `leds.top`."""
    return native_as_statement(context) if context.kind() == "(" else None


def native_in_expression(context: ErrorContext) -> Hint | None:
    """Recognize `x = math.sqrt(y)`."""
    name = context.word()
    if name.text not in context.natives or context.kind(1) != "(" or context.kind(-1) not in BEFORE_VALUE:
        return None
    hint = Hint("hint-native-in-expression", (name.text,))
    close = context.closing(1)
    parameters = context.natives[name.text].parameters
    is_result = bool(parameters) and parameters[0].name == "dest"
    is_assigned = context.kind(-1) == "=" and context.kind(-2) == "identifier" and context.is_statement(-2)
    if close is None or not is_result or not is_assigned or context.kind(-3) in ("var", "const"):
        return hint
    if context.kind(close + 1) in CONNECTORS:
        return hint
    inside = context.source[context.word(1).end : context.word(close).start].strip()
    left = context.word(-2)
    text = f"call {name.text}({left.text}{', ' + inside if inside else ''})"
    return replace(hint, edit=Edit(left.start, context.word(close).end, text))


def call_without_parentheses(context: ErrorContext) -> Hint | None:
    """Recognize `call sound.freq 440, 1`."""
    if context.kind(-1) != "identifier" or context.kind(-2) != "call":
        return None
    name = context.word(-1)
    if name.text not in context.natives:
        return None
    hint = Hint("hint-parentheses", (name.text,))
    return hint if context.natives[name.text].parameters else replace(hint, edit=Edit(name.end, name.end, "()"))


def callsub_of_native(context: ErrorContext) -> Hint | None:
    """Recognize `callsub leds.top`."""
    if context.kind() != "callsub" or context.kind(1) != "identifier" or context.word(1).text not in context.natives:
        return None
    return Hint("hint-call", (context.word(1).text,))


def subroutine_as_statement(context: ErrorContext) -> Hint | None:
    """Recognize `turn` or `turn()` without `callsub`."""
    at = _called_name(context)
    if context.kind(at) != "identifier" or context.word(at).text not in context.subs or not context.is_statement(at):
        return None
    name = context.word(at).text
    if context.kind(at + 1) != "(":
        is_alone = context.kind(at + 1) in (*STATEMENTS, *HANDLER_ENDS, "identifier", "end", "else", "elseif")
        return context.replaced("hint-callsub", at, at, f"callsub {name}", name) if is_alone else None
    if context.kind(at + 2) == ")":
        return context.replaced("hint-callsub", at, at + 2, f"callsub {name}", name)
    return Hint("hint-sub-arguments", (name,))


def call_of_subroutine(context: ErrorContext) -> Hint | None:
    """Recognize `call turn` or `call turn()`."""
    if context.kind() != "call" or context.kind(1) != "identifier" or context.word(1).text not in context.subs:
        return None
    name = context.word(1).text
    if context.kind(2) == "(" and context.kind(3) == ")":
        return context.replaced("hint-callsub", 0, 3, f"callsub {name}", name)
    if context.kind(2) == "(":
        return Hint("hint-sub-arguments", (name,))
    return context.replaced("hint-callsub", 0, 0, "callsub", name)


def callsub_with_parentheses(context: ErrorContext) -> Hint | None:
    """Recognize `callsub turn()` and `callsub sound.freq(440, 1)`."""
    if context.kind() != "(" or context.kind(-1) != "identifier" or context.kind(-2) != "callsub":
        return None
    name = context.word(-1).text
    if name in context.subs:
        if context.kind(1) == ")":
            return context.replaced("hint-callsub-parentheses", 0, 1, "", name)
        return Hint("hint-sub-arguments", (name,))
    if name in context.natives:
        return context.replaced("hint-call", -2, -2, "call", name)
    return None


def _called_name(context: ErrorContext) -> int:
    """The distance of the rejected name, or of the name before the rejected parenthesis."""
    return -1 if context.kind() == "(" else 0
