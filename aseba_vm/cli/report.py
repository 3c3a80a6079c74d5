"""What the command line reports about files: findings as data, and their text and JSON."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from aseba_vm.cli.inputs import Source
from aseba_vm.cli.source_snippet import source_snippet
from aseba_vm.errors import CompileError, Edit, Hint, TextError
from aseba_vm.messages import LANGUAGES, MESSAGES, format_message

PROGRAM_ENDINGS = (".aesl", ".aseba")
"""Files of a folder that are programs."""

ERROR, WARNING, NOTE = "error", "warning", "note"


@dataclass(frozen=True, slots=True)
class Finding:
    """Something about a file: place from 1 or None, severity (error, warning, note), kind, sentence; hint and edit.

    ``edit`` is (line, column, end line, end column, text), all from 1, the end exclusive, the text that of the program.
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
        """The sentence after the file, the place and what is no error."""
        place = self.file if self.line is None else f"{self.file}:{self.line}:{self.column}"
        severity = "" if self.severity == ERROR else f"{self.severity}: "
        return f"{place}: {severity}{self.message}"

    def text(self, source: str, *, label: str, is_colored: bool) -> str:
        """Return the finding for people: one line, the line of the file with a mark, the hint."""
        lines = [self.located]
        if source and self.line is not None and self.column is not None and self.severity != NOTE:
            lines.append(source_snippet(source, self.line - 1, self.column - 1, is_colored=is_colored))
        if self.hint:
            lines.append(f"{label}: {self.hint}")
        return "\n".join(lines)

    def data(self) -> dict[str, object]:
        """Return the finding for programs."""
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
    """Return the finding for a program that is refused."""
    line, column = (None, None) if error.pos is None else _from_1(source.place(error.pos.offset))
    message = format_message(error.kind, error.arguments, messages)
    hint, edit = _hint(source, error.hint, messages)
    return Finding(source.name, line, column, ERROR, error.kind, message, hint, edit)


def finding_of_text_error(file: str, error: TextError, messages: Mapping[str, str]) -> Finding:
    """Return the finding for a file that cannot be read as text or as an .aesl file."""
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
    """Return the programs below a folder in order of their paths, or the name itself of anything else.

    Hidden folders are left out and links to folders are not followed. Raises FileNotFoundError for a folder without
    programs.
    """
    if name == "-" or not os.path.isdir(name):
        return [name]
    found = []
    for home, folders, names in os.walk(name):
        folders[:] = [each for each in folders if not each.startswith(".")]
        found += [str(Path(home) / each) for each in names if each.lower().endswith(PROGRAM_ENDINGS)]
    if not found:
        raise FileNotFoundError(0, f"no program ({', '.join(PROGRAM_ENDINGS)}) in this folder", name)
    return sorted(found)


def user_language(environment: Mapping[str, str]) -> str:
    """Return the language of the user's messages, as the locale variables say; English if it is not translated."""
    locale = next((value for key in ("LC_ALL", "LC_MESSAGES", "LANG") if (value := environment.get(key))), "")
    choices = environment.get("LANGUAGE", "").split(":") if locale not in ("", "C", "POSIX", "C.UTF-8") else []
    for choice in (*choices, locale):
        language = choice[:2].lower()
        if language in LANGUAGES and not choice[2:3].isalpha():
            return language
    return "en"


def table_of(language: str) -> Mapping[str, str]:
    """Return the sentences of a language."""
    return LANGUAGES.get(language, MESSAGES)


def is_colored() -> bool:
    """Return whether the standard error takes colors."""
    return sys.stderr.isatty() and "NO_COLOR" not in os.environ
