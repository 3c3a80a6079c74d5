"""Recognizes files of other programs by their content, so that an error says what the file is and what to do.

Each kind has a sentence, `foreign-<kind>`, in `languages/<code>/compiler.json`. Text is recognized only by what no
program in Aseba contains, outside of comments.
"""

from __future__ import annotations

import json
import re
from pathlib import Path

from aseba_vm.errors import AeslError, TextError

_HEAD = 20_000
"""Characters or bytes at each end of a file that are searched."""

_KINDS = json.loads(Path(__file__).with_name("foreign_kinds.json").read_text(encoding="utf-8"))
"""The beginning or content of each kind, as regular expressions; the page reads them, too (browser/foreign_files.js).

`bytes` are matched with letters for bytes, `xml` from the root element on. Those of `code` are searched in each line.
"""
_BYTES = [(kind, re.compile(pattern.encode("latin-1"), re.DOTALL)) for kind, pattern in _KINDS["bytes"]]
_PROLOGUE = re.compile(r"(?:\s++|<\?[^>]*>|<!--(?:(?!-->).)*-->)*+", re.DOTALL)
_NETWORK = re.compile(_KINDS["network"])
_XML = [(kind, re.compile(pattern, re.IGNORECASE)) for kind, pattern in _KINDS["xml"]]
_JSON = [(kind, [re.compile(pattern) for pattern in patterns]) for kind, patterns in _KINDS["json"]]
_CODE = {name: re.compile(pattern, re.MULTILINE) for name, pattern in _KINDS["code"].items()}
_COMMENTS = re.compile(_KINDS["code"]["comments"], re.DOTALL)


def refuse_foreign_bytes(data: bytes) -> None:
    """Raise TextError for the bytes of a file of another program that is no text."""
    ends = data if len(data) <= 2 * _HEAD else data[:_HEAD] + data[-_HEAD:]
    for kind, pattern in _BYTES:
        if pattern.match(ends):
            raise TextError(f"foreign-{kind}", (), 1, 1)


def refuse_foreign(text: str) -> None:
    """Raise AeslError for a text that is not a program in Aseba but the file of another program."""
    kind = _kind_of(text[:_HEAD].removeprefix("\ufeff"))
    if kind:
        raise AeslError(f"foreign-{kind}", (), 1, 1)


def looks_like_network(text: str) -> bool:
    """Whether a text is meant as an .aesl file, whatever the name of its file is."""
    return _NETWORK.match(_without_prologue(text)) is not None


def _kind_of(text: str) -> str:
    begin = text.lstrip()[:1]
    if begin == "<":
        root = _without_prologue(text)
        return next((kind for kind, pattern in _XML if pattern.match(root)), "")
    if begin in ("{", "["):
        return next((kind for kind, patterns in _JSON if all(pattern.search(text) for pattern in patterns)), "")
    code = _COMMENTS.sub("", text)
    if _CODE["ros"].search(code) and (_CODE["imports"].search(code) or "#include" in code):
        return "ros"
    if _CODE["imports"].search(code) or (_CODE["python"].search(code) and not _CODE["aseba"].search(code)):
        return "tdmclient" if _CODE["tdmclient"].search(code) else "python"
    return ""


def _without_prologue(text: str) -> str:
    head = text[:_HEAD].removeprefix("\ufeff")
    prologue = _PROLOGUE.match(head)
    return head[prologue.end() :] if prologue else head
