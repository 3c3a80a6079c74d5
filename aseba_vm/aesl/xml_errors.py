"""Errors of malformed XML: position and a message for readers who do not know XML."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from xml.parsers.expat import errors

from aseba_vm.errors import AeslError, Argument

_KINDS: Mapping[int, str] = {
    errors.codes[message]: kind
    for message, kind in (
        (errors.XML_ERROR_SYNTAX, "xml-start"),
        (errors.XML_ERROR_INVALID_TOKEN, "xml-character"),
        (errors.XML_ERROR_UNCLOSED_TOKEN, "xml-unfinished"),
        (errors.XML_ERROR_PARTIAL_CHAR, "xml-unfinished"),
        (errors.XML_ERROR_UNCLOSED_CDATA_SECTION, "xml-unfinished"),
        (errors.XML_ERROR_TAG_MISMATCH, "xml-closing-tag"),
        (errors.XML_ERROR_DUPLICATE_ATTRIBUTE, "xml-attribute-twice"),
        (errors.XML_ERROR_JUNK_AFTER_DOC_ELEMENT, "xml-after-end"),
        (errors.XML_ERROR_UNDEFINED_ENTITY, "xml-entity"),
        (errors.XML_ERROR_BAD_CHAR_REF, "xml-entity"),
        (errors.XML_ERROR_NO_ELEMENTS, "xml-empty"),
    )
}


def position_at(data: bytes, at: int) -> tuple[int, int]:
    """Row and column, from 0, of a byte of UTF-8 text."""
    before = data[: max(at, 0)]
    return before.count(b"\n"), len(before[before.rfind(b"\n") + 1 :].decode("utf-8", "replace"))


def error_of_xml(code: int, data: bytes, at: int, open_elements: Sequence[tuple[str, int]]) -> AeslError:
    """The error for an expat error code at byte `at`.

    `open_elements` are the name and the first byte of each element that is open there.
    """
    kind = _KINDS.get(code, "xml-other")
    arguments: tuple[Argument, ...] = ()
    at = min(at, len(data)) if at >= 0 else len(data)
    if kind in ("xml-start", "xml-after-end", "xml-character"):
        kind, at, arguments = _unexpected(kind, data, at)
    elif kind == "xml-closing-tag":
        at = data.rfind(b"</", 0, at + 1)
        found = data[at + 2 : data.find(b">", at)].decode("utf-8", "replace").strip()
        name, start = open_elements[-1]
        arguments = (found, name, position_at(data, start)[0] + 1)
    elif kind == "xml-empty" and open_elements:
        name, start = open_elements[-1]
        kind, arguments = "xml-unclosed", (name, position_at(data, start)[0] + 1)
    elif kind == "xml-other":
        arguments = (errors.messages[code],)
    row, col = position_at(data, at)
    return AeslError(kind, arguments, row + 1, col + 1)


def _unexpected(kind: str, data: bytes, at: int) -> tuple[str, int, tuple[Argument, ...]]:
    """Report the bare `<` or `&` before an invalid character, if there is one, instead of the character."""
    if kind == "xml-character":
        before = data[max(at - 200, 0) : at]
        mark = max(before.rfind(b"<"), before.rfind(b"&"))
        if data[at : at + 1] in (b"<", b"&") and b"=" in before[mark:]:  # in the value of an attribute
            mark = len(before)
        is_inside_tag = mark >= 0 and not any(end in before[mark:] for end in (b">", b";"))
        if is_inside_tag and data[at : at + 1] != b"\0":
            at += mark - len(before)
            return "xml-bare-mark", at, (chr(data[at]),)
    letter = data[at : at + 4].decode("utf-8", "replace")[:1]
    shown = f"'{letter}'" if letter.isprintable() else f"U+{ord(letter or chr(0)):04X}"
    return kind, at, (shown,)
