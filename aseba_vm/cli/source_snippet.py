"""The line of a text that an error is about, with a mark under the place."""

from __future__ import annotations

_WIDTH = 100
_RED = "\x1b[31m"
_PLAIN = "\x1b[0m"


def source_snippet(text: str, row: int, col: int, *, is_colored: bool = False) -> str:
    """Return a line of ``text`` and, below it, a caret under the column; row and column count from 0.

    A very long line is cut around the place; a place after the end of the text shows its last line.
    """
    rows = text.split("\n", row + 1)
    line = rows[min(row, len(rows) - 1)].rstrip("\r")
    col = min(col, len(line))
    first = max(0, col - _WIDTH // 2) if len(line) > _WIDTH else 0
    shown = "".join(
        letter if letter.isprintable() or letter == "\t" else "?" for letter in line[first : first + _WIDTH]
    )
    indent = "".join("\t" if letter == "\t" else " " for letter in shown[: col - first])
    caret = f"{_RED}^{_PLAIN}" if is_colored else "^"
    return f"{shown}\n{indent}{caret}"
