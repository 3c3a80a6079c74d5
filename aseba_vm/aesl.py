"""The .aesl file: definitions and code of the nodes of one network (language spec, section 13).

Reading keeps what a compiler and an editor need: events, constants, the keyword flag, the code of each node, the data
of its editor plug-ins, and elements that we do not know. Declared entities are refused, as they can grow without limit.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from xml.parsers import expat
from xml.sax.saxutils import escape, quoteattr

from aseba_vm.errors import AeslError


@dataclass(frozen=True, slots=True)
class Plugin:
    """Data of an editor plug-in: its name, the name of its data element (empty if it has none), and its XML text."""

    name: str
    element: str
    xml: str


@dataclass(frozen=True, slots=True)
class Node:
    """A program: name of the node type, number of the node (0: any; the 2.x fork writes a UUID), code, plug-in data.

    ``row`` and ``col`` (from 0) say where the code begins in the file, for messages; they do not count in comparisons.
    """

    name: str
    node_id: int | str = 0
    code: str = ""
    plugins: tuple[Plugin, ...] = ()
    row: int = field(default=0, compare=False)
    col: int = field(default=0, compare=False)


@dataclass(frozen=True, slots=True)
class Network:
    """A whole file: global events (name, words), constants (name, value), keyword flag, nodes, other elements (XML)."""

    events: tuple[tuple[str, int], ...] = ()
    constants: tuple[tuple[str, int], ...] = ()
    keywords: bool | None = None
    nodes: tuple[Node, ...] = ()
    others: tuple[str, ...] = ()

    def node(self, name: str, node_id: int | str = 0) -> Node | None:
        """Return the program for a node: its number and name if both match, else the first of that name."""
        same_name = [node for node in self.nodes if node.name == name]
        exact = [node for node in same_name if node.node_id == node_id]
        return next(iter(exact or same_name), None)


def loads(text: str | bytes) -> Network:
    """Read a file; bytes are decoded as their XML declaration says. Raises AeslError with line and column."""
    return _Reader(text).read()


_NUMBER = re.compile(r"\s*[+-]?[0-9]{1,10}\s*")


class _Reader:
    """Collects the parts of a file while expat walks through it."""

    def __init__(self, text: str | bytes) -> None:
        self.data = text.encode("utf-8", "surrogatepass") if isinstance(text, str) else text
        self.parser = expat.ParserCreate("utf-8" if isinstance(text, str) else None)
        self.parser.buffer_text = False  # so that the place of a text is that of its first character
        self.parser.StartElementHandler = self.start
        self.parser.EndElementHandler = self.end
        self.parser.CharacterDataHandler = self.characters
        self.parser.EntityDeclHandler = self.entity
        self.path: list[str] = []
        self.starts: list[int] = []
        self.events: list[tuple[str, int]] = []
        self.constants: list[tuple[str, int]] = []
        self.keywords: bool | None = None
        self.nodes: list[Node] = []
        self.others: list[str] = []
        self.attributes: Mapping[str, str] = {}
        self.code: list[str] = []
        self.place: tuple[int, int] = (0, 0)
        self.plugins: list[Plugin] = []
        self.plugin_element = ""
        self.is_untouched = False  # nothing has come since the last start of an element

    def read(self) -> Network:
        try:
            self.parser.Parse(self.data, True)
        except expat.ExpatError as err:
            raise AeslError(expat.errors.messages[err.code], err.lineno, err.offset + 1) from err
        except (LookupError, ValueError) as err:
            raise AeslError(f"unknown encoding: {err}", 1, 1) from err
        return Network(tuple(self.events), tuple(self.constants), self.keywords, tuple(self.nodes), tuple(self.others))

    # -- what expat finds

    def start(self, name: str, attributes: dict[str, str]) -> None:
        depth = len(self.path)
        if depth == 1:
            self.definition(name, attributes)
        elif depth == 3 and self.path[1:] == ["node", "toolsPlugins"]:
            self.plugin_element = ""
        elif depth == 4 and self.path[1:3] == ["node", "toolsPlugins"]:
            self.plugin_element = self.plugin_element or name
        self.is_untouched = True
        self.path.append(name)
        self.starts.append(self.parser.CurrentByteIndex)

    def end(self, name: str) -> None:
        self.path.pop()
        start = self.starts.pop()
        depth = len(self.path)
        if depth == 3 and self.path[1:] == ["node", "toolsPlugins"]:
            self.plugins.append(Plugin(name, self.plugin_element, self.raw(start)))
        elif depth == 1 and name == "node":
            self.finish_node()
        elif depth == 1 and name not in ("event", "constant", "keywords"):
            self.others.append(self.raw(start))
        self.is_untouched = False

    def characters(self, text: str) -> None:
        self.is_untouched = False
        if len(self.path) == 2 and self.path[1] == "node":
            if not self.code:
                self.place = (self.parser.CurrentLineNumber - 1, self.parser.CurrentColumnNumber)
            self.code.append(text)

    def entity(self, *_: object) -> None:
        raise self.error("a declared entity is not allowed")

    # -- our elements

    def definition(self, name: str, attributes: Mapping[str, str]) -> None:
        if name == "event":
            size = self.number(attributes, "size")
            if size < 0:
                raise self.error("attribute size is negative")
            self.events.append((self.attribute(attributes, "name"), size))
        elif name == "constant":
            self.constants.append((self.attribute(attributes, "name"), self.number(attributes, "value")))
        elif name == "keywords":
            self.keywords = attributes.get("flag", "").strip() == "true"
        elif name == "node":
            self.attribute(attributes, "name")
            self.attributes, self.code, self.plugins = attributes, [], []

    def finish_node(self) -> None:
        node_id = self.attributes.get("nodeId", "0")
        self.nodes.append(
            Node(
                self.attributes["name"],
                int(node_id) if _NUMBER.fullmatch(node_id) else node_id,
                "".join(self.code),
                tuple(self.plugins),
                *self.place,
            )
        )

    def attribute(self, attributes: Mapping[str, str], name: str) -> str:
        if name not in attributes:
            raise self.error(f"attribute {name} is missing")
        return attributes[name]

    def number(self, attributes: Mapping[str, str], name: str) -> int:
        text = self.attribute(attributes, name)
        if not _NUMBER.fullmatch(text):
            raise self.error(f"attribute {name} is not a number: {text[:20]!r}")
        return int(text)

    def raw(self, start: int) -> str:
        """Return the XML text from ``start`` to the end of the element that ends here."""
        at = self.parser.CurrentByteIndex
        is_empty = self.is_untouched and self.data.endswith(b"/>", start, at)
        end = at if is_empty else self.data.index(b">", at) + 1
        return self.data[start:end].decode("utf-8", "replace")

    def error(self, reason: str) -> AeslError:
        return AeslError(reason, self.parser.CurrentLineNumber, self.parser.CurrentColumnNumber + 1)


def dumps(network: Network) -> str:
    """Return the text of a file: events, constants, keywords, nodes, with the comments that editors write."""
    lines = ["<!DOCTYPE aesl-source>", "<network>", "", "", "<!--list of global events-->"]
    lines += [f"<event size={quoteattr(str(size))} name={_quoted(name)}/>" for name, size in network.events]
    lines += ["", "", "<!--list of constants-->"]
    lines += [f"<constant value={quoteattr(str(value))} name={_quoted(name)}/>" for name, value in network.constants]
    if network.keywords is not None:
        flag = "true" if network.keywords else "false"
        lines += ["", "", "<!--show keywords state-->", f'<keywords flag="{flag}"/>']
    for node in network.nodes:
        plugins = "".join(plugin.xml for plugin in node.plugins)
        if plugins:
            plugins = f"<toolsPlugins>{plugins}</toolsPlugins>"
        opening = f"<node nodeId={_quoted(str(node.node_id))} name={_quoted(node.name)}>"
        lines += ["", "", f"<!--node {_comment(node.name)}-->", f"{opening}{_text(node.code)}{plugins}</node>"]
    lines += network.others
    return "\n".join([*lines, "", "", "</network>", ""])


def _quoted(text: str) -> str:
    return quoteattr(text, {"\n": "&#10;", "\r": "&#13;", "\t": "&#9;"})


def _text(text: str) -> str:
    return escape(text, {"\r": "&#13;"})


def _comment(text: str) -> str:
    return text.replace("--", "- -").rstrip("-")
