"""The parser of docstrings for Sphinx: Markdown, with the sections Args, Attributes, Raises and Returns as lists."""

from __future__ import annotations

import re
from typing import Any

from myst_parser.sphinx_ import Parser as MystParser

__all__ = ["Parser", "with_lists"]

_SECTION = re.compile(r"(Args|Attributes|Raises|Returns):")
_INDENT = 4


def with_lists(docstring: str) -> str:
    """A docstring with its sections as Markdown; the number of lines stays the same, for the positions of warnings."""
    lines = []
    section = ""
    for line in docstring.splitlines():
        if match := _SECTION.fullmatch(line):
            section = match[1]
            lines.append(f"**{section}**")
        elif section and line.startswith(" " * _INDENT):
            entry = line[_INDENT:]
            name, colon, text = entry.partition(": ")
            is_name = section != "Returns" and colon and not entry.startswith(" ")
            # Returns has no names: its text is one item.
            is_item = is_name or (section == "Returns" and lines[-1] == "**Returns**")
            lines.append(f"- `{name}`: {text}" if is_name else f"- {entry}" if is_item else f"  {entry.strip()}")
        else:
            section = section if not line.strip() else ""
            lines.append(line)
    return "\n".join(lines)


class Parser(MystParser):
    """Used by the name of its module in `autodoc2_docstring_parser_regexes`."""

    def parse(self, inputstring: str, document: Any) -> None:
        """Add the nodes of a docstring to a document."""
        super().parse(with_lists(inputstring), document)
