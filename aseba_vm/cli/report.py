"""Findings about files as data, and their text and JSON forms."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from aseba_vm.cli.inputs import Source
from aseba_vm.cli.source_snippet import source_snippet
from aseba_vm.errors import CompileError, Edit, Hint, TextError
from aseba_vm.languages import LANGUAGES
from aseba_vm.messages import format_message

PROGRAM_ENDINGS = (".aesl", ".aseba")
"""Suffixes of program files in a folder."""

ERROR, WARNING, NOTE = "error", "warning", "note"


@dataclass(frozen=True, slots=True)
class Finding:
    """A message about a file: position from 1 or None, severity (error, warning, note), kind, text, hint and edit.

    `edit` is (line, column, end line, end column, text), all from 1, the end exclusive; the text is program text.
    """

    file: str
    line: int | None
    column: int | None
    severity: str
    kind: str
    message: str
    hint: str = ""
    edit: tuple[int, int, int, int, str] | None = None

    @property
    def located(self) -> str:
        """The message with the file, the position and the severity (unless it is an error) in front."""
        place = self.file if self.line is None else f"{self.file}:{self.line}:{self.column}"
        severity = "" if self.severity == ERROR else f"{self.severity}: "
        return f"{place}: {severity}{self.message}"

    def text(self, source: str, *, label: str, is_colored: bool) -> str:
        """The finding as text: the message, the line of the file with a caret, the hint."""
        lines = [self.located]
        if source and self.line is not None and self.column is not None and self.severity != NOTE:
            lines.append(source_snippet(source, self.line - 1, self.column - 1, is_colored=is_colored))
        if self.hint:
            lines.append(f"{label}: {self.hint}")
        return "\n".join(lines)

    def data(self) -> dict[str, object]:
        """The finding as JSON data."""
        keys = ("line", "column", "end_line", "end_column", "text")
        return {
            "file": self.file,
            "line": self.line,
            "column": self.column,
            "severity": self.severity,
            "kind": self.kind,
            "message": self.message,
            "hint": self.hint or None,
            "edit": None if self.edit is None else dict(zip(keys, self.edit, strict=True)),
        }


def finding_of_compile_error(source: Source, error: CompileError, messages: Mapping[str, str]) -> Finding:
    """The finding for a program with an error."""
    line, column = (None, None) if error.pos is None else _from_1(source.place(error.pos.offset))
    message = format_message(error.kind, error.arguments, messages)
    hint, edit = _hint(source, error.hint, messages)
    return Finding(source.name, line, column, ERROR, error.kind, message, hint, edit)


def finding_of_text_error(file: str, error: TextError, messages: Mapping[str, str]) -> Finding:
    """The finding for a file that cannot be read as text or as an .aesl file."""
    message = format_message(error.kind, error.arguments, messages)
    return Finding(file, error.line, error.column, ERROR, error.kind, message)


def _hint(
    source: Source, hint: Hint | None, messages: Mapping[str, str]
) -> tuple[str, tuple[int, int, int, int, str] | None]:
    if hint is None:
        return "", None
    sentence = hint.message(messages, source.node.rows_in_file())
    return sentence, None if hint.edit is None else _edit(source, hint.edit)


def _edit(source: Source, edit: Edit) -> tuple[int, int, int, int, str]:
    line, column = _from_1(source.place(edit.start))
    end_line, end_column = _from_1(source.place(edit.end))
    return line, column, end_line, end_column, edit.text


def _from_1(place: tuple[int, int]) -> tuple[int, int]:
    return place[0] + 1, place[1] + 1


# -- files and languages -----------------------------------------------------------------------------------------------


def files_in(name: str) -> Sequence[str]:
    """The programs in a folder and its subfolders in order of path, or the name itself if it is no folder.

    Hidden folders are skipped and links to folders are not followed. Raises FileNotFoundError for a folder without
    programs.
    """
    if name == "-" or not os.path.isdir(name):
        return [name]
    programs = []
    for home, folders, names in os.walk(name):
        folders[:] = [entry for entry in folders if not entry.startswith(".")]
        programs += [str(Path(home) / entry) for entry in names if entry.lower().endswith(PROGRAM_ENDINGS)]
    if not programs:
        raise FileNotFoundError(0, f"no program ({', '.join(PROGRAM_ENDINGS)}) in this folder", name)
    return sorted(programs)


def user_language(environment: Mapping[str, str]) -> str:
    """The language of messages from the locale variables; English if there is no translation."""
    locale = next((value for key in ("LC_ALL", "LC_MESSAGES", "LANG") if (value := environment.get(key))), "")
    choices = environment.get("LANGUAGE", "").split(":") if locale not in ("", "C", "POSIX", "C.UTF-8") else []
    for choice in (*choices, locale):
        language = choice[:2].lower()
        if language in LANGUAGES and not choice[2:3].isalpha():
            return language
    return "en"


def is_colored() -> bool:
    """Whether the standard error shows colors."""
    return sys.stderr.isatty() and "NO_COLOR" not in os.environ
