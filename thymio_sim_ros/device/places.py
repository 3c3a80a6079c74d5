"""From a place in a node's code back to the place in the .aesl file that its author sees.

The code is the node's text after XML has had its way (aseba-language.md section 13): an entity is one character, CDATA
marks, comments and child elements are none. Rows, columns and offsets count from 0; lines end with "\\n".
"""

from __future__ import annotations

import re

_CDATA = "<![CDATA["
_MARKUP = re.compile(
    r"<!\[CDATA\[(?P<cdata>.*?)\]\]>|(?P<end></)|(?P<entity>&[^;]*;)"
    r"|<!--.*?-->|<(?P<child>[^\s/>]+)[^>]*?(/>|>.*?</(?P=child)\s*>)",
    re.DOTALL,
)


def place_in_file(text: str, row: int, col: int, offset: int) -> tuple[int, int]:
    """Row and column of character `offset` of a node's code, whose first character is at (row, col) of the text."""
    at = sum(len(line) + 1 for line in text.split("\n")[:row]) + col
    if text.endswith(_CDATA, 0, at):
        at -= len(_CDATA)
    while found := _MARKUP.search(text, at):
        plain = found.start() - at
        if offset < plain or found["end"]:
            return _place(text, at + min(offset, plain))
        offset -= plain
        if found["cdata"] is not None:
            if offset < len(found["cdata"]):
                return _place(text, found.start("cdata") + offset)
            offset -= len(found["cdata"])
        elif found["entity"]:
            if offset == 0:
                return _place(text, found.start())
            offset -= 1
        at = found.end()
    return _place(text, min(at + offset, len(text)))


def _place(text: str, index: int) -> tuple[int, int]:
    return text.count("\n", 0, index), index - (text.rfind("\n", 0, index) + 1)
