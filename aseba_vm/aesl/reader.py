"""Reader of .aesl files: expat events become a Network, or one error with a position."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from xml.parsers import expat

from aseba_vm.aesl.network import Network, Node, Piece, Plugin
from aseba_vm.aesl.xml_errors import error_of_xml, position_at
from aseba_vm.errors import AeslError, Argument
from aseba_vm.frontend.lexer import is_name

MAX_CHARACTERS = 1_000_000
"""Limit of this reader: a hundred times the longest program that fits into a Thymio."""
MAX_NODES = 64
"""Limit of this reader: more robots than a class has."""
MAX_EVENT_WORDS = 258
"""Words that fit into a message of the Aseba network (docs/spec/aseba-language.md sections 12 and 13)."""

_MARK = "\ufeff"  # byte order mark
_NUMBER = re.compile(r"\s*[+-]?[0-9]{1,10}\s*")
_UUID = re.compile(r"\{?[0-9A-Fa-f]{8}(-[0-9A-Fa-f]{4}){3}-[0-9A-Fa-f]{12}\}?")
_TAG = re.compile(rb"<(?:[^\"'>]|\"[^\"]*\"|'[^']*')*>")
_INSIDE_NODE = 2
_INSIDE_TOOLS = 3
_INSIDE_PLUGIN = 4


def checked_length(text: str) -> str:
    """The same text. Raises AeslError if it is longer than MAX_CHARACTERS."""
    if len(text) > MAX_CHARACTERS:
        row = text.count("\n", 0, MAX_CHARACTERS)
        col = MAX_CHARACTERS - text.rfind("\n", 0, MAX_CHARACTERS) - 1
        raise AeslError("aesl-too-long", (len(text), MAX_CHARACTERS), row + 1, col + 1)
    return text


def read(text: str, *, is_strict: bool) -> Network:
    """Parse a file; `is_strict` also rejects what the reference accepts. Raises AeslError."""
    network = _Reader(checked_length(text.removeprefix(_MARK)), is_strict=is_strict).read()
    return replace(network, pieces=(Piece("text", _MARK), *network.pieces)) if text.startswith(_MARK) else network


class _OpenNode:
    """A node whose end tag has not been read yet."""

    def __init__(self, name: str, node_id: int | str, row: int = 0, col: int = 0) -> None:
        self.name = name
        self.node_id = node_id
        self.code: list[str] = []
        self.size = 0
        self.anchors = [(0, row, col)]
        self.next_place = (row, col)
        self.plugins: list[Plugin] = []
        self.element = ""  # of the plug-in that is open
        self.others: list[str] = []  # XML of comments and unknown elements
        self.tools: list[str] = []  # XML of the plug-ins' elements

    def add(self, text: str, row: int, col: int) -> None:
        """Append text to the code; expat splits text at each line end and entity."""
        if (row, col) != self.next_place:
            if self.anchors[-1][0] == self.size:
                self.anchors.pop()
            self.anchors.append((self.size, row, col))
        self.code.append(text)
        self.size += len(text)
        self.next_place = (row + 1, 0) if text == "\n" else (row, col + len(text))

    def finish_plugin(self, name: str, xml: str) -> None:
        self.plugins.append(Plugin(name, self.element, xml))
        self.element = ""

    def finished(self) -> Node:
        return Node(self.name, self.node_id, "".join(self.code), tuple(self.plugins), tuple(self.anchors))


class _Reader:
    """Collects the parts of a file from the events of expat."""

    def __init__(self, text: str, *, is_strict: bool) -> None:
        self.data = text.encode("utf-8", "surrogatepass")
        self.is_strict = is_strict
        self.parser = expat.ParserCreate("utf-8")
        self.parser.buffer_text = False  # so the position of a text is that of its first character
        self.parser.StartDoctypeDeclHandler = self.document_type
        self.parser.EntityDeclHandler = self.entity
        self.parser.SkippedEntityHandler = self.unknown_entity
        self.parser.StartElementHandler = self.start
        self.parser.EndElementHandler = self.end
        self.parser.CommentHandler = lambda _: self.keep_markup(b"-->")
        self.parser.ProcessingInstructionHandler = lambda *_: self.keep_markup(b"?>")
        self.path: list[str] = []
        self.starts: list[int] = []  # byte offset of each open element
        self.pieces: list[Piece] = []
        self.consumed = 0  # bytes that are already in a piece
        self.first_uses: dict[tuple[object, ...], int] = {}  # byte offset of the first use of a name or number
        self.events: list[tuple[str, int]] = []
        self.constants: list[tuple[str, int]] = []
        self.keywords: bool | None = None
        self.nodes: list[Node] = []
        self.open_node = _OpenNode("", 0)

    def read(self) -> Network:
        try:
            self.parser.Parse(self.data, True)
        except expat.ExpatError as error:
            open_elements = list(zip(self.path, self.starts, strict=True))
            raise error_of_xml(error.code, self.data, self.parser.ErrorByteIndex, open_elements) from error
        if self.is_strict and not self.nodes:
            raise self.error("aesl-no-node", (), self.data.rfind(b"<"))
        return Network(tuple(self.events), tuple(self.constants), self.keywords, tuple(self.nodes), tuple(self.pieces))

    # -- expat handlers

    def document_type(self, name: str, system: str | None, public: str | None, _: object) -> None:
        if self.is_strict and (system is not None or public is not None):
            raise self.error("aesl-outer-document", (system or public or "",), self.data.find(b"<!DOCTYPE"))

    def entity(self, name: str, *_: object) -> None:
        at = self.data.rfind(b"<!ENTITY", 0, self.parser.CurrentByteIndex)
        raise self.error("aesl-entity", (name,), at)

    def unknown_entity(self, *_: object) -> None:
        """Reject an entity that another document might declare; no other document is ever read."""
        raise self.error("xml-entity", ())

    def start(self, name: str, attributes: dict[str, str]) -> None:
        depth = len(self.path)
        start = self.parser.CurrentByteIndex
        self.path.append(name)
        self.starts.append(start)
        if depth == 0:
            if self.is_strict and name != "network":
                raise self.error("aesl-root", (name,))
            self.piece("opening", start, self.tag_end(start))
        elif depth == 1:
            self.definition(name, attributes)
        elif depth == _INSIDE_NODE:
            self.parser.CharacterDataHandler = None
        elif depth == _INSIDE_PLUGIN and self.is_in_tools():
            self.open_node.element = self.open_node.element or name

    def definition(self, name: str, attributes: Mapping[str, str]) -> None:
        match name:
            case "event":
                self.events.append(self.event(attributes))
            case "constant":
                self.constants.append(self.constant(attributes))
            case "keywords":
                self.keywords = self.flag(attributes)
            case "node":
                self.open_node = self.node(attributes)
                self.parser.CharacterDataHandler = self.characters

    def end(self, name: str) -> None:
        self.path.pop()
        start = self.starts.pop()
        depth = len(self.path)
        if depth == 0:
            self.piece(
                "closing", self.parser.CurrentByteIndex if self.is_open(start) else self.consumed, len(self.data)
            )
        elif depth == 1:
            self.finish(name, start)
        elif depth == _INSIDE_NODE and self.path[1] == "node":
            kept = self.open_node.tools if name == "toolsPlugins" else self.open_node.others
            kept.append(self.text(start, self.element_end(start)))
            self.parser.CharacterDataHandler = self.characters
        elif depth == _INSIDE_TOOLS and self.is_in_tools():
            self.open_node.finish_plugin(name, self.text(start, self.element_end(start)))

    def finish(self, name: str, start: int) -> None:
        """Keep a definition with its text; unknown elements become part of the text between the pieces."""
        end = self.element_end(start)
        match name:
            case "event":
                self.piece(name, start, end, self.events[-1])
            case "constant":
                self.piece(name, start, end, self.constants[-1])
            case "keywords":
                self.piece(name, start, end, self.keywords)
            case "node":
                self.parser.CharacterDataHandler = None
                self.nodes.append(self.open_node.finished())
                opening = self.text(start, self.tag_end(start))
                others, tools = "".join(self.open_node.others), "".join(self.open_node.tools)
                self.piece(name, start, end, self.nodes[-1], opening, others, tools)

    def characters(self, text: str) -> None:
        self.open_node.add(text, self.parser.CurrentLineNumber - 1, self.parser.CurrentColumnNumber)

    def keep_markup(self, closing: bytes) -> None:
        """Keep a comment or a processing instruction that is inside a node."""
        if len(self.path) == _INSIDE_NODE and self.path[1] == "node":
            start = self.parser.CurrentByteIndex
            self.open_node.others.append(self.text(start, self.data.index(closing, start) + len(closing)))

    # -- known elements

    def event(self, attributes: Mapping[str, str]) -> tuple[str, int]:
        name = self.name("event", attributes)
        size = self.number(attributes, "size")
        if size < 0 or (self.is_strict and size > MAX_EVENT_WORDS):
            raise self.attribute_error("aesl-event-size", "size", (name, size, MAX_EVENT_WORDS))
        return name, size

    def constant(self, attributes: Mapping[str, str]) -> tuple[str, int]:
        name = self.name("constant", attributes)
        value = self.number(attributes, "value")
        if self.is_strict and not -0x8000 <= value <= 0x7FFF:
            raise self.attribute_error("aesl-constant-value", "value", (name, value))
        return name, value

    def flag(self, attributes: Mapping[str, str]) -> bool:
        flag = attributes.get("flag", "").strip()
        if self.is_strict and flag not in ("true", "false"):
            raise self.attribute_error("aesl-keywords", "flag", (flag,))
        return flag == "true"

    def node(self, attributes: Mapping[str, str]) -> _OpenNode:
        name = attributes.get("name", "")  # editors name a node after the device, or not at all
        written_id = attributes.get("nodeId", "").strip() or "0"
        node_id = int(written_id) if _NUMBER.fullmatch(written_id) else written_id
        if self.is_strict:
            if not (0 <= node_id <= 0xFFFF if isinstance(node_id, int) else _UUID.fullmatch(node_id)):
                raise self.attribute_error("aesl-node-id", "nodeId", (written_id,))
            if node_id != 0:
                self.check_unique("node", "nodeId", name, written_id)
            if len(self.nodes) == MAX_NODES:
                raise self.error("aesl-many-nodes", (MAX_NODES,))
        start = self.starts[-1]
        tag = self.text(start, self.tag_end(start))
        row, col = self.parser.CurrentLineNumber - 1, self.parser.CurrentColumnNumber
        rows = tag.count("\n")
        return _OpenNode(name, node_id, row + rows, len(tag) - tag.rfind("\n") - 1 if rows else col + len(tag))

    # -- attributes

    def name(self, kind: str, attributes: Mapping[str, str]) -> str:
        name = self.attribute(attributes, "name")
        if self.is_strict:
            if not is_name(name):
                raise self.attribute_error("aesl-name", "name", (name,))
            self.check_unique(kind, "name", name)
        return name

    def check_unique(self, kind: str, attribute: str, *names: str) -> None:
        """Reject a name or number that the file already uses."""
        first = self.first_uses.setdefault((kind, *names), self.starts[-1])
        if first != self.starts[-1]:
            line = position_at(self.data, first)[0] + 1
            raise self.attribute_error(f"aesl-{kind}-twice", attribute, (*names, line))

    def attribute(self, attributes: Mapping[str, str], name: str) -> str:
        if name not in attributes:
            raise self.error("aesl-attribute-missing", (self.path[-1], name), self.starts[-1])
        return attributes[name]

    def number(self, attributes: Mapping[str, str], name: str) -> int:
        """The value of an attribute; a missing one is 0, as in the reference."""
        text = attributes.get(name, "0")
        if not _NUMBER.fullmatch(text):
            raise self.attribute_error("aesl-number", name, (name, text))
        return int(text)

    # -- positions

    def is_in_tools(self) -> bool:
        return self.path[1:_INSIDE_TOOLS] == ["node", "toolsPlugins"]

    def tag_end(self, start: int) -> int:
        found = _TAG.match(self.data, start)
        return found.end() if found else start

    def is_open(self, start: int) -> bool:
        """Whether the element that ends here has a closing tag."""
        return not self.data.endswith(b"/>", start, self.tag_end(start))

    def element_end(self, start: int) -> int:
        if not self.is_open(start):
            return self.tag_end(start)
        return self.data.index(b">", self.parser.CurrentByteIndex) + 1

    def text(self, start: int, end: int) -> str:
        return self.data[start:end].decode("utf-8", "surrogatepass")

    def piece(self, kind: str, start: int, end: int, value: object = None, *parts: str) -> None:
        """Append a part of the file, preceded by the text since the part before it."""
        if start > self.consumed:
            self.pieces.append(Piece("text", self.text(self.consumed, start)))
        self.pieces.append(Piece(kind, self.text(start, end), value, *parts))
        self.consumed = end

    def error(self, kind: str, arguments: tuple[Argument, ...], at: int | None = None) -> AeslError:
        row, col = position_at(self.data, self.parser.CurrentByteIndex if at is None else max(at, 0))
        return AeslError(kind, arguments, row + 1, col + 1)

    def attribute_error(self, kind: str, attribute: str, arguments: tuple[Argument, ...]) -> AeslError:
        """An error at the value of an attribute of the current element."""
        start = self.starts[-1]
        tag = self.data[start : self.tag_end(start)]
        found = re.search(rb"\s" + attribute.encode() + rb"\s*=\s*[\"']", tag)
        return self.error(kind, arguments, start + found.end() if found else start)
