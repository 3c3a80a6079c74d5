"""Pages of the documentation as text: their blocks of code, the files that readers save, the commands that they type.

A fenced block after a paragraph that ends with "`name.ext`:" is a file. A fenced block of `console` holds lines
`$ command`, each followed by what it prints; tests/terminals.py executes them. In what is printed, a line `...` stands
for any lines, and `...` within a line for any text. A `console` block is for terminal 1, unless its first line is
`# terminal 2`. `$ ^C` is Ctrl-C. Lines before the first command continue what that terminal's running command prints.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"
INTERRUPT = "^C"
GAP = "..."

_FENCE = re.compile(r"^```(?P<language>[^`\n]*)\n(?P<text>.*?)^```$", re.DOTALL | re.MULTILINE)
_FILE_NAME = re.compile(r"`([\w./]+\.\w+)`[^`]*:\s*\Z")
_TERMINAL = re.compile(r"# terminal (\d+)")


class PageError(Exception):
    """A page that breaks the convention; the message names the page and the line."""


@dataclass(frozen=True)
class Block:
    """A fenced block of code: its language, text and line in the page, and the paragraph before it."""

    language: str
    text: str
    line: int
    before: str

    @property
    def file_name(self) -> str:
        """The name under which readers save it; empty if it is no file."""
        found = _FILE_NAME.search(self.before)
        return found[1] if found and self.language != "console" else ""


@dataclass(frozen=True)
class Command:
    """A command of a terminal, with the lines that it prints; without text, further lines of the running command."""

    terminal: int
    text: str
    printed: tuple[str, ...]
    line: int


def read(page: Path | str) -> str:
    """The text of a page; a name is one of the folder `docs`."""
    return (DOCS / page).read_text(encoding="utf-8")


def all_blocks(text: str) -> list[Block]:
    """Every fenced block in order."""
    found, end = [], 0
    for match in _FENCE.finditer(text):
        paragraphs = text[end : match.start()].strip().rsplit("\n\n", 1)
        line = text.count("\n", 0, match.start()) + 1
        found.append(Block(match["language"], match["text"], line, paragraphs[-1]))
        end = match.end()
    return found


def blocks(text: str, language: str) -> list[str]:
    """The blocks in a language, in order."""
    return [block.text for block in all_blocks(text) if block.language == language]


def files(text: str) -> dict[str, str]:
    """Name → text of every file that the page shows. Raises PageError if a name has two texts."""
    shown: dict[str, str] = {}
    for block in all_blocks(text):
        if block.file_name and shown.setdefault(block.file_name, block.text) != block.text:
            raise PageError(f"line {block.line}: a second text for {block.file_name}, expected one for each name")
    return shown


def commands(block: Block) -> list[Command]:
    """The commands of a `console` block. Raises PageError if it begins with neither a command nor a terminal."""
    lines = block.text.splitlines()
    named = _TERMINAL.fullmatch(lines[0]) if lines else None
    terminal = int(named[1]) if named else 1
    found: list[Command] = []
    for at, line in enumerate(lines[1:] if named else lines, block.line + 1 + bool(named)):
        if line.startswith("$ "):
            found.append(Command(terminal, line[2:], (), at))
        elif found and found[-1].text.endswith("\\") and line.startswith("> ") and not found[-1].printed:
            found[-1] = Command(terminal, f"{found[-1].text}\n{line[2:]}", (), found[-1].line)
        elif found:
            found[-1] = Command(terminal, found[-1].text, (*found[-1].printed, line), found[-1].line)
        elif named:
            found.append(Command(terminal, "", (line,), at))
        else:
            raise PageError(f"line {at}: found {line!r}, expected '$ ' and a command, or '# terminal 2'")
    return found


def pattern(printed: Sequence[str]) -> str:
    """A regular expression for these lines, each of which ends with a line break."""
    return "".join(r"(?:.*\n)*?" if line.strip() == GAP else _line_pattern(line) for line in printed)


def _line_pattern(line: str) -> str:
    parts = re.split(r"\.{3}(?!\.)", line.rstrip())  # in "0....", the first point is that of the number
    return ".*".join(re.escape(part) for part in parts) + r"\n"
