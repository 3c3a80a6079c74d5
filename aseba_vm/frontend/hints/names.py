"""Unknown names: spelling mistakes, parts of longer names, and misspelled words of the language."""

from __future__ import annotations

from collections.abc import Iterable

from aseba_vm.errors import Hint
from aseba_vm.frontend.hints.context import ErrorContext
from aseba_vm.frontend.lexer import KEYWORDS
from aseba_vm.frontend.parser import COMPOUND
from aseba_vm.frontend.suggestions import suggestion

_AFTER_VARIABLE = frozenset(("=", "==", "[", "++", "--", ".")) | COMPOUND
"""Tokens after the first word of a statement that show that the word is the name of a variable."""
_SHORTEST_BEGINNING = 3
"""Letters that the beginning of a part of a name needs."""
_MOST_NAMES = 6
"""Most names that a hint lists."""
_LETTERS_PER_MISTAKE = 3
"""A misspelled word has at most one wrong letter in this number of letters; other words are probably not misspelled."""


def misspelled_keyword(context: ErrorContext) -> Hint | None:
    """Recognize `whlie` and `onevnt` at the beginning of a statement, and `nto` before a value."""
    if context.kind() != "identifier":
        return None
    is_statement = context.is_statement()
    if is_statement and context.kind(1) in _AFTER_VARIABLE:
        return None
    return _as_keyword(context, KEYWORDS if is_statement else ("not", "abs"))


def misspelled_connector(context: ErrorContext) -> Hint | None:
    """Recognize `thne`, `adn` or `stpe` where the grammar expects such a word."""
    if context.kind() != "identifier":
        return None
    wanted = (word for word in context.error.arguments[:1] if isinstance(word, str) and word in KEYWORDS)
    return _as_keyword(context, (*wanted, "and", "or", "step"))


def spelling(context: ErrorContext) -> Hint | None:
    """Recognize a name with another capitalization or with one or two wrong letters."""
    at = _unknown_name(context)
    if at is None:
        return None
    name = context.word(at).text
    known = _known_names(context, at)
    same = sorted(other for other in known if other.lower() == name.lower())
    meant = same[0] if same else suggestion(name, known)
    if meant is None or not (same or _is_close(name, meant)):
        return None
    return context.replaced("hint-name", at, at, meant, name, meant)


def part_of_name(context: ErrorContext) -> Hint | None:
    """Recognize a name that lacks parts of a longer one, such as `leds.bottom` and `motor.target`."""
    at = _unknown_name(context)
    if at is None:
        return None
    name = context.word(at).text
    longer = sorted(other for other in _known_names(context, at) if "_" not in other and _is_part(name, other))
    if not longer:
        return None
    if len(longer) == 1:
        return context.replaced("hint-name", at, at, longer[0], name, longer[0])
    return Hint("hint-part-of-name", (name, tuple(longer[:_MOST_NAMES])))


def _unknown_name(context: ErrorContext) -> int | None:
    """The distance of the unknown name: the error is at the name or at the keyword before it."""
    name = context.error.arguments[0]
    return next((at for at in (0, 1) if context.kind(at) == "identifier" and context.word(at).text == name), None)


def _known_names(context: ErrorContext, at: int) -> Iterable[str]:
    """The names that could be meant at the place of an unknown one."""
    symbols = context.symbols
    match context.error.kind.removesuffix("-hint"):
        case "unknown-function":
            return symbols.natives.keys()
        case "unknown-constant":
            return symbols.constants.keys()
        case "unknown-subroutine":
            return context.subs
        case "unknown-event" if context.kind(at - 1) == "onevent":
            return symbols.events.keys() | symbols.local_events.keys()
        case "unknown-event":
            return symbols.events.keys()
    if context.kind(at + 1) == "(" and context.is_statement(at):
        return symbols.natives.keys()
    return symbols.variables.keys() | symbols.constants.keys()


def _is_part(name: str, other: str) -> bool:
    """Whether a name begins as another one and its further parts, or their beginnings, follow there in order."""
    first, *parts = name.split(".")
    begin, *remaining = other.split(".")
    wholes = iter(remaining)
    return first == begin and all(
        any(part == whole or (len(part) >= _SHORTEST_BEGINNING and whole.startswith(part)) for whole in wholes)
        for part in parts
    )


def _as_keyword(context: ErrorContext, keywords: Iterable[str]) -> Hint | None:
    """The hint that names the most similar of some words of the language."""
    name = context.word().text
    known = tuple(keywords)
    swapped = (word for word in sorted(known) if _is_swapped(name, word))
    meant = next(swapped, None) or suggestion(name, known)
    if meant is None or not _is_close(name, meant):
        return None
    return context.replaced("hint-name", 0, 0, meant, name, meant)


def _is_close(name: str, other: str) -> bool:
    """Whether two words differ by a swap of two letters, or by few letters for their length."""
    most = max(len(name), len(other)) // _LETTERS_PER_MISTAKE
    return _is_swapped(name, other) or suggestion(name, (other,), most) is not None


def _is_swapped(name: str, other: str) -> bool:
    """Whether two neighboring letters are swapped."""
    wrong = [index for index, letters in enumerate(zip(name, other, strict=False)) if letters[0] != letters[1]]
    if len(name) != len(other) or not wrong:
        return False
    first = wrong[0]
    return name[:first] + name[first : first + 2][::-1] + name[first + 2 :] == other
