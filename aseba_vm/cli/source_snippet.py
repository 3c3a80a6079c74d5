"""The source line of an error with a caret under the position."""

from __future__ import annotations

_WIDTH = 100
_RED = "\x1b[31m"
_PLAIN = "\x1b[0m"


def source_snippet(text: str, row: int, col: int, *, is_colored: bool = False) -> str:
    """A line of `text` and a caret under the column below it; row and column count from 0.

    A very long line is cut around the position; a position after the end of the text selects its last line.
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
