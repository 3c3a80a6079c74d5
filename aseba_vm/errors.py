"""Source positions, hints and the exceptions of this package.

An error is data (kind, arguments, position); `aseba_vm.messages` has its text.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from aseba_vm.messages import MESSAGES, format_message

Argument = int | str | tuple[int | str, ...]


@dataclass(frozen=True, slots=True)
class SourcePos:
    """A position in a text: index of the code point, row and column, all from 0.

    Source: docs/spec/aseba-language.md section 2.
    """

    offset: int
    row: int
    col: int

    def __str__(self) -> str:
        return f"{self.row + 1}:{self.col + 1}"

    def moved(self, row: int, col: int) -> SourcePos:
        """The position in a file, given the row and column where the text begins in it."""
        return SourcePos(self.offset, self.row + row, self.col + col if self.row == 0 else self.col)


@dataclass(frozen=True, slots=True)
class Edit:
    """Replace the characters of a program from offset `start` to `end` (exclusive) by `text`."""

    start: int
    end: int
    text: str

    def applied(self, source: str) -> str:
        """The program with this edit applied."""
        return source[: self.start] + self.text + source[self.end :]


@dataclass(frozen=True, slots=True)
class Hint:
    """A probable correction of a rejected program, as data.

    `kind` is a stable identifier, `arguments` are its ordered values, `edit` is a change that corrects the
    program. `row` is a row of the program, from 0; the message states it after the arguments.
    """

    kind: str
    arguments: tuple[Argument, ...] = ()
    edit: Edit | None = None
    row: int | None = None

    def __str__(self) -> str:
        return self.message()

    def message(self, messages: Mapping[str, str] = MESSAGES, rows: Sequence[int] = ()) -> str:
        """The text of the hint in the language of `messages`.

        `rows` maps rows of the program to rows of its file, both from 0; without it they are the same.
        """
        lines = () if self.row is None else ((rows[self.row] if rows else self.row) + 1,)
        return format_message(self.kind, (*self.arguments, *lines), messages)


class AsebaError(Exception):
    """Base class of all errors that this package raises for invalid input."""


class CompileError(AsebaError):
    """A rejected program: the first error in the order of docs/spec/aseba-language.md section 11.

    `kind` is a stable identifier, `arguments` are its ordered values, `pos` is the position or None. `hint`
    suggests a correction, if one is known (`aseba_vm.frontend.hints.finder`).
    """

    def __init__(self, kind: str, arguments: tuple[Argument, ...] = (), pos: SourcePos | None = None) -> None:
        super().__init__(kind, arguments, pos)
        self.kind = kind
        self.arguments = arguments
        self.pos = pos
        self.hint: Hint | None = None

    def __str__(self) -> str:
        return format_message(self.kind, self.arguments)

    def located(self, name: str) -> str:
        """The message with the file name and the position (from 1) in front."""
        return f"{name}: {self}" if self.pos is None else f"{name}:{self.pos}: {self}"


class TextError(AsebaError):
    """A file that is not text. `line` and `column` count from 1; kind and arguments as in CompileError."""

    def __init__(self, kind: str, arguments: tuple[Argument, ...], line: int, column: int) -> None:
        super().__init__(kind, arguments, line, column)
        self.kind = kind
        self.arguments = arguments
        self.line = line
        self.column = column

    def __str__(self) -> str:
        return format_message(self.kind, self.arguments)

    def located(self, name: str) -> str:
        """The message with the file name and the position in front."""
        return f"{name}:{self.line}:{self.column}: {self}"


class AeslError(TextError):
    """A text that is not a valid .aesl file."""


class TargetError(AsebaError):
    """A target description that is inconsistent or incomplete."""
