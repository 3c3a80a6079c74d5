"""Where and why a text is refused: source positions and the exceptions of the package.

An error is data (kind, arguments, position); its wording comes from :mod:`aseba_vm.messages`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from aseba_vm.messages import MESSAGES, wording

Argument = int | str | tuple[int | str, ...]


@dataclass(frozen=True, slots=True)
class SourcePos:
    """A place in a text: index of the code point, row and column, all from 0.

    Source: docs/spec/aseba-language.md section 2.
    """

    offset: int
    row: int
    col: int

    def __str__(self) -> str:
        return f"{self.row + 1}:{self.col + 1}"

    def moved(self, row: int, col: int) -> SourcePos:
        """Return the place in a file in which the text begins at a row and column."""
        return SourcePos(self.offset, self.row + row, self.col + col if self.row == 0 else self.col)


@dataclass(frozen=True, slots=True)
class Edit:
    """Replace the characters of a program from offset ``start`` to ``end`` (exclusive) by ``text``."""

    start: int
    end: int
    text: str

    def applied(self, source: str) -> str:
        """Return a program with the edit."""
        return source[: self.start] + self.text + source[self.end :]


@dataclass(frozen=True, slots=True)
class Hint:
    """What was probably meant where a program is refused, as data.

    ``kind`` is a stable identifier, ``arguments`` its ordered values, ``edit`` a change that repairs the place, ``row``
    a row of the program, from 0, that the sentence names after the arguments.
    """

    kind: str
    arguments: tuple[Argument, ...] = ()
    edit: Edit | None = None
    row: int | None = None

    def __str__(self) -> str:
        return self.worded()

    def worded(self, messages: Mapping[str, str] = MESSAGES, rows: Sequence[int] = ()) -> str:
        """Return the sentence; ``rows`` leads from rows of the program to rows of its file, both from 0."""
        lines = () if self.row is None else ((rows[self.row] if rows else self.row) + 1,)
        return wording(self.kind, (*self.arguments, *lines), messages)


class AsebaError(Exception):
    """Base of everything this package raises about other people's input."""


class CompileError(AsebaError):
    """A program that is refused: the first error met, in the order of docs/spec/aseba-language.md section 11.

    ``kind`` is a stable identifier, ``arguments`` its ordered values, ``pos`` the place or None; ``hint`` says what was
    probably meant, if that is known (:mod:`aseba_vm.frontend.hints`).
    """

    def __init__(self, kind: str, arguments: tuple[Argument, ...] = (), pos: SourcePos | None = None) -> None:
        super().__init__(kind, arguments, pos)
        self.kind = kind
        self.arguments = arguments
        self.pos = pos
        self.hint: Hint | None = None

    def __str__(self) -> str:
        return wording(self.kind, self.arguments)

    def located(self, name: str) -> str:
        """Return the message after the name of the file and the place, counted from 1."""
        return f"{name}: {self}" if self.pos is None else f"{name}:{self.pos}: {self}"


class TextError(AsebaError):
    """A file that is not text. ``line`` and ``column`` count from 1; kind and arguments as in a CompileError."""

    def __init__(self, kind: str, arguments: tuple[Argument, ...], line: int, column: int) -> None:
        super().__init__(kind, arguments, line, column)
        self.kind = kind
        self.arguments = arguments
        self.line = line
        self.column = column

    def __str__(self) -> str:
        return wording(self.kind, self.arguments)

    def located(self, name: str) -> str:
        """Return the message after the name of the file and the place."""
        return f"{name}:{self.line}:{self.column}: {self}"


class AeslError(TextError):
    """A text that is not an .aesl file, or one that breaks its rules."""


class TargetError(AsebaError):
    """A target description that contradicts itself or lacks a field."""
