"""Contents of an .aesl file: events, constants and programs that the nodes of a network share.

Source: docs/spec/aseba-language.md section 13.
"""

from __future__ import annotations

import re
from bisect import bisect_left, bisect_right
from collections.abc import Collection
from dataclasses import dataclass, field, replace

_OTHER_DEVICES = re.compile(r"e-?puck|dummynode|marxbot|handbot|smartrob", re.IGNORECASE)
"""Node names that identify devices other than Thymios; any other unknown name may belong to one Thymio."""
_VPL_PLUGINS = frozenset(("ThymioVisualProgramming", "ThymioVPL"))
_VPL_DATA = "vplroot"
_VPL_EVENTS = (("pair_run", 1), ("debug_log", 14))


@dataclass(frozen=True, slots=True)
class Plugin:
    """Data of an editor plug-in: its name, the name of its data element (empty if there is none), and its XML text."""

    name: str
    element: str
    xml: str


@dataclass(frozen=True, slots=True)
class Node:
    """A program: name of the node type, number of the node (0: any; the 2.x fork writes a UUID), code, plug-in data.

    `anchors` map the code to the file: an offset in the code with its row and column in the file, all from 0,
    wherever the two stop being contiguous: after entities, CDATA marks, comments and child elements.
    """

    name: str
    node_id: int | str = 0
    code: str = ""
    plugins: tuple[Plugin, ...] = ()
    anchors: tuple[tuple[int, int, int], ...] = field(default=(), compare=False, repr=False)

    def place(self, offset: int) -> tuple[int, int]:
        """Row and column in the file, from 0, of a character of the code (or of its end)."""
        offset = min(max(offset, 0), len(self.code))
        at = bisect_right(self.anchors, offset, key=lambda anchor: anchor[0])
        start, row, col = self.anchors[at - 1] if at else (0, 0, 0)
        between = self.code[start:offset]
        rows = between.count("\n")
        return (row + rows, len(between) - between.rfind("\n") - 1) if rows else (row, col + len(between))

    def rows_in_file(self) -> tuple[int, ...]:
        """For each row of the code, the row of the file in which it starts, from 0."""
        ends = [at for at, letter in enumerate(self.code) if letter == "\n"]
        rows: list[int] = []
        for row, offset in enumerate((0, *(end + 1 for end in ends))):
            at = bisect_right(self.anchors, offset, key=lambda anchor: anchor[0])
            start, first, _ = self.anchors[at - 1] if at else (0, 0, 0)
            rows.append(first + row - bisect_left(ends, start))
        return tuple(rows)


@dataclass(frozen=True, slots=True)
class Piece:
    """A part of a file as it was written.

    `kind` is `event`, `constant`, `keywords` or `node`, with its `value`, or `text` for everything
    between them, including comments and unknown elements. For a node, `opening` is its tag, `others` its comments
    and unknown elements, `tools` its plug-in element.
    """

    kind: str
    xml: str
    value: object = None
    opening: str = ""
    others: str = ""
    tools: str = ""


@dataclass(frozen=True, slots=True)
class Network:
    """A whole file: global events (name, words), constants (name, value), keyword flag, nodes.

    `pieces` are the parts of the file that was read. They are ignored in comparisons; `dumps` uses them to change
    only the parts that differ.
    """

    events: tuple[tuple[str, int], ...] = ()
    constants: tuple[tuple[str, int], ...] = ()
    keywords: bool | None = None
    nodes: tuple[Node, ...] = ()
    pieces: tuple[Piece, ...] = field(default=(), compare=False, repr=False)

    def node(self, name: str, node_id: int | str = 0) -> Node | None:
        """The program for a node: with its number and name if there is one, else the first with its name."""
        same_name = [node for node in self.nodes if node.name == name]
        exact = [node for node in same_name if node.node_id == node_id]
        return next(iter(exact or same_name), None)


@dataclass(frozen=True, slots=True)
class Selection:
    """The nodes of a file that one kind of device can run.

    `named` are named after the device. `guessed` have another name (that of one robot, or none). `others` are for
    other devices.
    """

    named: tuple[Node, ...]
    guessed: tuple[Node, ...]
    others: tuple[Node, ...]

    @property
    def nodes(self) -> tuple[Node, ...]:
        """All nodes to be run, the named ones first."""
        return (*self.named, *self.guessed)


def select(network: Network, names: Collection[str]) -> Selection:
    """Sort the nodes of a network for devices with these names.

    Editors name a node after the device it was connected to (`Thymio_4 on LAPTOP`), so an unknown name says nothing
    about the program. Only nodes named after another kind of device, such as `e-puck`, are left out, and only if the
    file has other nodes.
    """
    named = tuple(node for node in network.nodes if node.name in names)
    unknown = tuple(node for node in network.nodes if node.name not in names)
    others = tuple(node for node in unknown if is_other_device(node))
    guessed = tuple(node for node in unknown if not is_other_device(node))
    return Selection(named, guessed, others) if named or guessed else Selection((), others, ())


def is_other_device(node: Node) -> bool:
    """Whether a node is named after a kind of device that is not a Thymio."""
    return _OTHER_DEVICES.match(node.name.strip()) is not None


def with_vpl_events(network: Network) -> Network:
    """Add the events that VPL declares implicitly if a node has VPL data and the file does not declare them."""
    plugins = [plugin for node in network.nodes for plugin in node.plugins]
    if not any(plugin.name in _VPL_PLUGINS or plugin.element == _VPL_DATA for plugin in plugins):
        return network
    declared = {name for name, _ in network.events}
    missing = tuple(event for event in _VPL_EVENTS if event[0] not in declared)
    return replace(network, events=(*network.events, *missing))
