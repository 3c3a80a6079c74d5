"""XML text as a small tree with line numbers; external references and most entities are rejected.

The encoding of a file is that of its byte order mark or its XML declaration, else UTF-8. A file that is not valid in it
is read as Windows-1252, as older programs wrote their files.

Used for `.playground` files and SVG images, which are untrusted: nothing is ever loaded from elsewhere, and depth and
number of elements are limited. Entities that stand for plain text, as Illustrator declares them for namespaces, are
replaced by it; a document type that declares others is an error.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from xml.parsers import expat

from aseba_vm.aesl.text_decoding import decode
from aseba_vm.errors import TextError
from thymio_sim_ros.errors import ThymioSimError

__all__ = ["Element", "XmlError", "parse", "text_of"]

MAX_DEPTH = 200
MAX_ELEMENTS = 100_000


MAX_REPLACED = 100_000
"""Largest number of characters that entities stand for in a file."""
_PLAIN_ENTITY = r"<!ENTITY\s+(?P<name>[A-Za-z_][\w.-]*+)\s+(?P<value>\"[^\"'<&%]*+\"|'[^\"'<&%]*+')\s*>"
"""An entity that stands for text without markup, quotes or references: it cannot be nested."""
_DECLARATIONS = re.compile(
    r"(?P<type><!DOCTYPE\s+[^\s\[>]+(?:\s+(?:SYSTEM|PUBLIC|\"[^\"]*+\"|'[^']*+'))*+)\s*"
    r"\[(?P<subset>(?:\s|<!--(?:(?!-->).)*+-->|" + re.sub(r"\?P<\w+>", "?:", _PLAIN_ENTITY) + r")*+)\]\s*>",
    re.DOTALL,
)
"""A document type that declares such entities only."""

OTHER_ENCODING = "Windows-1252"
"""Of files that are not in the encoding that they should have."""
_SPACE = " "
"""Separates namespace and name; no name contains a space."""
_KNOWN = {f"http://www.w3.org/1999/xlink{_SPACE}href": "xlink:href"}
_SVG = f"http://www.w3.org/2000/svg{_SPACE}"


class XmlError(ThymioSimError):
    """Rejected XML: the line (from 1), what was found, what was expected."""

    def __init__(self, line: int, found: str, expected: str) -> None:
        super().__init__(f"line {line}: found {found}, expected {expected}")
        self.line = line
        self.found = found
        self.expected = expected


@dataclass(slots=True)
class Element:
    """An element: its name without namespace, attributes, children, text directly in it.

    Attributes are those without a namespace, `xlink:href` with any prefix, and those in the namespace of SVG as
    `svg:name`; others are ignored.
    """

    tag: str
    attributes: Mapping[str, str]
    line: int
    offset: int
    """Offset of its first character in bytes of the text in UTF-8."""
    end: int = 0
    """Offset of the character after its last one."""
    children: list[Element] = field(default_factory=list)
    text: str = ""

    def walk(self) -> Iterator[Element]:
        """This element and everything below it, in the order of the text."""
        waiting = [self]
        while waiting:
            element = waiting.pop()
            yield element
            waiting.extend(reversed(element.children))


def text_of(data: bytes) -> tuple[str, str | None]:
    """The text of an XML file without byte order mark, and the encoding that it should have and has not.

    Entities that stand for plain text are replaced; lines stay where they are.

    Raises XmlError for an unknown encoding.
    """
    try:
        return _with_plain_entities(decode(data).text), None
    except TextError as error:
        if error.kind != "text-undecodable":
            raise XmlError(1, "an unknown encoding", "UTF-8") from error
        return _with_plain_entities(data.decode(OTHER_ENCODING, "replace")), str(error.arguments[1])


def _with_plain_entities(text: str) -> str:
    """The text without such entities and their declarations; others stay, and are rejected by `parse`."""
    declared = _DECLARATIONS.search(text)
    if declared is None:
        return text
    values: dict[str, str] = {}
    for entity in re.finditer(_PLAIN_ENTITY, re.sub(r"<!--.*?-->", "", declared["subset"], flags=re.DOTALL)):
        values.setdefault(entity["name"], entity["value"][1:-1])
    reference = re.compile(r"&([A-Za-z_][\w.-]*+);")
    behind = text[declared.end() :]
    if sum(len(values.get(found[1], "")) for found in reference.finditer(behind)) > MAX_REPLACED:
        return text
    replaced = reference.sub(lambda found: values.get(found[1], found[0]), behind)
    lines = "\n" * declared[0].count("\n", len(declared["type"]))
    return f"{text[: declared.start()]}{declared['type']}{lines}>{replaced}"


def parse(data: bytes | str) -> Element:
    """The root of a document. Raises XmlError for text that is not XML, declares entities, or is too large."""
    return _Builder(_with_plain_entities(data) if isinstance(data, str) else text_of(data)[0]).build()


class _Builder:
    """Parses one document."""

    def __init__(self, text: str) -> None:
        self._data = text.encode("utf-8", "surrogatepass")
        self._parser = expat.ParserCreate("utf-8", namespace_separator=_SPACE)
        self._open: list[Element] = []
        self._root: Element | None = None
        self._count = 0
        self._texts: list[list[str]] = []
        """Text of each open element so far, in the pieces from the parser."""
        self._parser.buffer_text = True
        self._parser.StartElementHandler = self._start
        self._parser.EndElementHandler = self._end
        self._parser.CharacterDataHandler = self._text
        self._parser.EntityDeclHandler = self._entity
        self._parser.ExternalEntityRefHandler = self._external

    def build(self) -> Element:
        try:
            self._parser.Parse(self._data, True)
        except expat.ExpatError as error:
            raise XmlError(error.lineno, expat.ErrorString(error.code), "XML") from error
        assert self._root is not None
        return self._root

    def _start(self, name: str, attributes: dict[str, str]) -> None:
        line = self._parser.CurrentLineNumber
        self._count += 1
        if len(self._open) >= MAX_DEPTH or self._count > MAX_ELEMENTS:
            raise XmlError(line, "too many or too deeply nested elements", f"at most {MAX_ELEMENTS}, {MAX_DEPTH} deep")
        named = ((_attribute(key), value) for key, value in attributes.items())
        own = {key: value for key, value in named if key is not None}
        element = Element(name.rpartition(_SPACE)[2], own, line, self._parser.CurrentByteIndex)
        if self._open:
            self._open[-1].children.append(element)
        else:
            self._root = element
        self._open.append(element)
        self._texts.append([])

    def _end(self, _name: str) -> None:
        element = self._open.pop()
        element.text = "".join(self._texts.pop())
        place = self._parser.CurrentByteIndex
        # after <name/>, else at the start of </name>
        is_short = not element.children and not element.text and self._data[place - 2 : place] == b"/>"
        element.end = place if is_short else self._data.index(b">", place) + 1

    def _text(self, data: str) -> None:
        self._texts[-1].append(data)

    def _entity(self, name: str, *_declaration: object) -> None:
        raise XmlError(
            self._parser.CurrentLineNumber, f"a declaration of the entity '{name}'", "no entity declarations"
        )

    def _external(self, *_reference: object) -> int:
        raise XmlError(self._parser.CurrentLineNumber, "an external reference", "a self-contained file")


def _attribute(key: str) -> str | None:
    """The name of an attribute in `Element.attributes`; None for one that is ignored."""
    if _SPACE not in key:
        return key
    return f"svg:{key.removeprefix(_SVG)}" if key.startswith(_SVG) else _KNOWN.get(key)
