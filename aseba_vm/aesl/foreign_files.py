"""Recognizes files of other programs by their content, so that an error says what the file is and what to do.

Each kind has a sentence, `foreign-<kind>`, in `languages/<code>/compiler.json`. Text is recognized only by what no
program in Aseba contains, outside of comments.
"""

from __future__ import annotations

import re

from aseba_vm.errors import AeslError, TextError

_HEAD = 20_000
"""Characters or bytes at each end of a file that are searched."""

_BYTES = (
    ("scratch", rb"PK\x03\x04.*project\.json|ScratchV0\d"),
    ("document", rb"PK\x03\x04.*(?:word/|xl/|ppt/|vnd\.oasis\.opendocument|\.iwa)|\xd0\xcf\x11\xe0|\{\\rtf"),
    ("archive", rb"PK[\x03\x05]|\x1f\x8b|7z\xbc\xaf|Rar!|\xfd7zXZ"),
    ("pdf", rb"%PDF-"),
    (
        "picture",
        rb"\x89PNG|\xff\xd8\xff|GIF8|BM.{4}\x00{4}|RIFF.{4}WEBP|II\*\x00|MM\x00\*|\x00\x00\x01\x00[\x01-\x10]\x00",
    ),
    ("picture", rb".{4}ftyp(?:heic|heif|mif1|avif)"),
)
_PROLOGUE = re.compile(r"(?:\s++|<\?[^>]*>|<!--(?:(?!-->).)*-->)*+", re.DOTALL)
_NETWORK = re.compile(r"<!DOCTYPE\s+aesl-source\b|<network\b")
_XML = (
    ("web-page", r"<!doctype\s+html|<(?:html|head|body)\b"),
    ("playground", r"<(?:!DOCTYPE\s+)?aseba-playground\b"),
    ("blocks", r"<(?:\w+:)?xml[\s>/]"),
    ("picture", r"(?:<!DOCTYPE\s+svg[^>]*>\s*)?<svg\b"),
)
_JSON = (
    ("vpl3", (r'"(?:basicBlocks|advancedBlocks|disabledUI|basicMultiEvent|advancedMultiEvent)"\s*:',)),
    ("vpl3", (r'"program"\s*:\s*\[', r'"blocks"\s*:')),
    ("notebook", (r'"cells"\s*:', r'"cell_type"\s*:')),
    ("playground", (r'"(?:format"\s*:\s*\d|shapes"\s*:|robots"\s*:|planes"\s*:|thymios"\s*:)',)),
    ("json", (r'^\s*(?:\{\s*(?:"[^"\n]*"\s*:|\}\s*$)|\[\s*[\{\["])',)),
)
_IMPORT = re.compile(r"^(?:from\s+[\w.]+\s+import\b|import\s+[A-Za-z_][\w.]*)", re.MULTILINE)
_PYTHON = re.compile(
    r"^(?:@[\w.]+\s*(?:\(|$)|(?:async\s+)?def\s+\w+\s*\(|class\s+\w+.*:)"
    r"|^[ \t]*(?:if|elif|else|while|for|try|with)\b[^#\n]*:[ \t]*$"
    r"|^[ \t]*(?:print|await)\b[ (]",
    re.MULTILINE,
)
_ASEBA = re.compile(r"^[ \t]*(?:onevent|var|sub|call|callsub|emit|end|when)\b", re.MULTILINE)
_ROS = re.compile(r"\brclpy\b|\brospy\b|#include\s*<rclcpp/")
_TDMCLIENT = re.compile(r"\btdmclient\b|^@onevent\b|\b(?:motor|timer|prox|button|leds)_[a-z]+", re.MULTILINE)
_COMMENTS = re.compile(r"#\*.*?\*#", re.DOTALL)


def refuse_foreign_bytes(data: bytes) -> None:
    """Raise TextError for the bytes of a file of another program that is no text."""
    ends = data if len(data) <= 2 * _HEAD else data[:_HEAD] + data[-_HEAD:]
    for kind, pattern in _BYTES:
        if re.match(pattern, ends, re.DOTALL):
            raise TextError(f"foreign-{kind}", (), 1, 1)


def refuse_foreign(text: str) -> None:
    """Raise AeslError for a text that is not a program in Aseba but the file of another program."""
    kind = _kind_of(text[:_HEAD].removeprefix("\ufeff"))
    if kind:
        raise AeslError(f"foreign-{kind}", (), 1, 1)


def looks_like_network(text: str) -> bool:
    """Return whether a text is meant as an .aesl file, whatever the name of its file is."""
    return _NETWORK.match(_without_prologue(text)) is not None


def _kind_of(text: str) -> str:
    begin = text.lstrip()[:1]
    if begin == "<":
        root = _without_prologue(text)
        return next((kind for kind, pattern in _XML if re.match(pattern, root, re.IGNORECASE)), "")
    if begin in ("{", "["):
        return next((kind for kind, patterns in _JSON if all(re.search(each, text) for each in patterns)), "")
    code = _COMMENTS.sub("", text)
    if _ROS.search(code) and (_IMPORT.search(code) or "#include" in code):
        return "ros"
    if _IMPORT.search(code) or (_PYTHON.search(code) and not _ASEBA.search(code)):
        return "tdmclient" if _TDMCLIENT.search(code) else "python"
    return ""


def _without_prologue(text: str) -> str:
    head = text[:_HEAD].removeprefix("\ufeff")
    found = _PROLOGUE.match(head)
    return head[found.end() :] if found else head
