"""Spacing between the tokens of one line; words, symbols and comments stay as they are.

Two or more spaces before a comment, after a comma or before a list are taken as manual alignment and kept.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from aseba_vm.frontend.identifiers import LETTER_OR_DIGIT
from aseba_vm.frontend.lexer import Token

_WORD = re.compile(rf"[{LETTER_OR_DIGIT}_.]+")
_OPERANDS = frozenset(("identifier", "integer", ")", "]"))
_TIGHT_BEFORE = frozenset((")", "]", ",", ":", "++", "--"))
_TIGHT_AFTER = frozenset(("(", "[", ":", "~"))
_SHIFTS = frozenset(("<<", ">>", "<<=", ">>="))


def space_line(text: str, start: int, end: int, tokens: Sequence[Token], first: int, last: int) -> str:
    """The line text[start:end], which has the tokens first..last-1 of the program, with normalized spaces."""
    parts: list[str] = []
    at = start
    for index in range(first, last):
        begin = token_begin(tokens[index])
        comment = text[at:begin].strip()
        if comment:
            parts += [" " if parts else "", comment, " "]
        elif index > first:
            parts.append(_kept(text[at:begin], tokens, index) or _gap(tokens, index))
        at = token_end(text, tokens[index])
        parts.append(text[begin:at])
    rest = text[at:end].rstrip()
    comment = rest.lstrip()
    before = rest[: len(rest) - len(comment)]
    return "".join([*parts, (before if _is_column(before) else " ") if parts and comment else "", comment])


def token_begin(token: Token) -> int:
    """The start offset of a token; the position of a shift operator is its second character.

    Source: docs/spec/aseba-language.md section 3.
    """
    return token.pos.offset - (token.kind in _SHIFTS)


def token_end(text: str, token: Token) -> int:
    """The offset after the last character of a token."""
    begin = token_begin(token)
    word = _WORD.match(text, begin)
    return word.end() if word else begin + len(token.kind)


def _is_column(space: str) -> bool:
    return len(space) > 1 and not space.strip(" ")


def _kept(space: str, tokens: Sequence[Token], at: int) -> str:
    """The space before a token if it aligns the token in a column, else nothing."""
    before, token = tokens[at - 1].kind, tokens[at].kind
    is_cell = before == "," or (before == "=" and token == "[")
    return space if is_cell and token not in _TIGHT_BEFORE and _is_column(space) else ""


def _gap(tokens: Sequence[Token], at: int) -> str:
    """The space between a token and the one before it."""
    before, token = tokens[at - 1].kind, tokens[at].kind
    if token in _TIGHT_BEFORE or before in _TIGHT_AFTER:
        return ""
    if before == "-" and token != "-" and _is_sign(tokens, at - 1):
        return ""
    if token == "[" and before == "identifier":
        return " " if _is_emitted(tokens, at - 1) else ""
    return "" if token == "(" and at >= 2 and tokens[at - 2].kind == "call" else " "


def _is_sign(tokens: Sequence[Token], at: int) -> bool:
    """Whether a `-` has no left operand."""
    return at == 0 or tokens[at - 1].kind not in _OPERANDS or _is_emitted(tokens, at - 1)


def _is_emitted(tokens: Sequence[Token], at: int) -> bool:
    """Whether an identifier is the event of an `emit`, which a value may follow."""
    return at >= 1 and tokens[at - 1].kind in ("emit", "_emit")
