"""Formatter: normalizes indentation and spaces; words, symbols and comments stay as they are."""

from __future__ import annotations

import re
from bisect import bisect_right

from aseba_vm.frontend.lexer import tokenize
from aseba_vm.frontend.token_spacing import space_line

_COMMENT = re.compile(r"\#\*[\s\S]*?\*\#|\#[^\r\n]*")
_OPENING = frozenset(("if", "when", "while", "for"))
_MIDDLE = frozenset(("else", "elseif"))
_MARKERS = frozenset(("onevent", "sub"))
_BRACKETS = {"(": 1, "[": 1, ")": -1, "]": -1}


def format_program(source: str, indent: str = "\t") -> str:
    """A program with each line indented by its depth, normalized spaces, and no repeated empty lines.

    The tokens and therefore the bytecode stay the same. Lines that start inside a block comment are kept. Raises
    CompileError if the text cannot be tokenized.
    """
    text = source.replace("\r\n", "\n").replace("\r", "\n")
    tokens = tokenize(text)[:-1]
    kept = _rows_inside_comments(text)
    lines: list[str] = []
    section = depth = brackets = start = first = 0
    for row, line in enumerate(text.split("\n")):
        last = bisect_right(tokens, row, first, key=lambda token: token.pos.row)
        kinds = [token.kind for token in tokens[first:last]]
        if kinds and kinds[0] in _MARKERS:
            section = depth = 0
        if row in kept:
            lines.append(line)
        else:
            level = section + depth - _closers(kinds) + (1 if brackets > 0 else 0)
            regular = space_line(text, start, start + len(line), tokens, first, last)
            lines.append(indent * max(level, 0) + regular if regular else "")
        for kind in kinds:
            depth += (kind in _OPENING) - (kind == "end")
            brackets = max(brackets + _BRACKETS.get(kind, 0), 0)
        if any(kind in _MARKERS for kind in kinds):
            section = 1
        start, first = start + len(line) + 1, last
    return _without_repeated_blanks(lines, kept)


def _closers(kinds: list[str]) -> int:
    """Number of levels by which the first words of a line reduce its indentation."""
    count = 0
    for kind in kinds:
        if kind != "end":
            return count + (kind in _MIDDLE)
        count += 1
    return count


def _rows_inside_comments(text: str) -> set[int]:
    """The rows that start inside a block comment."""
    rows: set[int] = set()
    row = at = 0
    for comment in _COMMENT.finditer(text):
        row += text.count("\n", at, comment.start())
        at = comment.start()
        inside = comment.group().count("\n")
        rows.update(range(row + 1, row + inside + 1))
    return rows


def _without_repeated_blanks(lines: list[str], kept: set[int]) -> str:
    result: list[str] = []
    for row, line in enumerate(lines):
        if line or row in kept or (result and result[-1]):
            result.append(line)
    while result and not result[-1]:
        result.pop()
    return "".join(f"{line}\n" for line in result)
