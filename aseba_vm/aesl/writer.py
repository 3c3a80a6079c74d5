"""Writer of .aesl files: unchanged parts as they were read, new ones in the format of the reference."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from xml.sax.saxutils import escape, quoteattr

from aseba_vm.aesl.network import Network, Node, Piece

_HEADINGS = {
    "event": "<!--list of global events-->",
    "constant": "<!--list of constants-->",
    "keywords": "<!--show keywords state-->",
    "node": "",
}
_ORDER = tuple(_HEADINGS)


def write(network: Network) -> str:
    """The text of a file."""
    return "".join(_edited(network)) if network.pieces else _new(network)


def _new(network: Network) -> str:
    lines = ["<!DOCTYPE aesl-source>", "<network>"]
    for kind, values in _values(network).items():
        if values or kind in ("event", "constant"):
            lines += _section(kind, values)
    return "\n".join([*lines, "", "", "</network>", ""])


def _values(network: Network) -> dict[str, Sequence[object]]:
    """The contents of a network by kind of piece."""
    return {
        "event": network.events,
        "constant": network.constants,
        "keywords": () if network.keywords is None else (network.keywords,),
        "node": network.nodes,
    }


def _section(kind: str, values: Sequence[object]) -> list[str]:
    """The lines of all elements of a kind with the comments that editors write."""
    if kind != "node":
        return ["", "", _HEADINGS[kind], *(_element(value, kind) for value in values)]
    lines: list[str] = []
    for node in values:
        assert isinstance(node, Node)
        lines += ["", "", f"<!--node {_comment(node.name)}-->", _element(node, kind)]
    return lines


def _element(value: object, kind: str, was: Piece | None = None, line_end: str = "\n") -> str:
    """The text of one element; unchanged parts of a node that was read are kept."""
    match kind, value:
        case "event", (str(name), int(size)):
            return f"<event size={quoteattr(str(size))} name={_quoted(name)}/>"
        case "constant", (str(name), int(number)):
            return f"<constant value={quoteattr(str(number))} name={_quoted(name)}/>"
        case "keywords", bool(flag):
            return f'<keywords flag="{"true" if flag else "false"}"/>'
        case "node", Node() as node:
            return _node(node, was, line_end)
    raise TypeError(f"not a {kind}: {value!r}")


def _node(node: Node, was: Piece | None, line_end: str) -> str:
    opening = f"<node nodeId={_quoted(str(node.node_id))} name={_quoted(node.name)}>"
    xml = "".join(plugin.xml for plugin in node.plugins)
    others, tools = "", f"<toolsPlugins>{xml}</toolsPlugins>" if xml else ""
    if was is not None and isinstance(was.value, Node):
        others = was.others
        if (node.name, node.node_id) == (was.value.name, was.value.node_id):
            opening = f"{was.opening[:-2]}>" if was.opening.endswith("/>") else was.opening
        if node.plugins == was.value.plugins:
            tools = was.tools
    code = _text(node.code).replace("\n", line_end)
    return f"{opening}{code}{others}{tools}</node>"


# -- changes to a file that was read


def _edited(network: Network) -> Iterator[str]:
    """The pieces of the file in order; an element is unchanged, rewritten or omitted, and new ones are around it."""
    pieces = network.pieces
    line_end = "\r\n" if any("\r\n" in piece.xml for piece in pieces) else "\n"
    texts: dict[int, str] = {}
    before: dict[int, str] = {}
    for kind, values in _values(network).items():
        old = [(at, piece) for at, piece in enumerate(pieces) if piece.kind == kind]
        if kind == "keywords":
            old = old[-1:]  # the last one counts
        if old:
            texts |= _replaced(kind, old, values, line_end)
        elif values:
            _insert(kind, values, pieces, texts, before)
    if texts or before:
        texts |= _opened(pieces)
    for at, piece in enumerate(pieces):
        yield before.get(at, "").replace("\n", line_end)
        yield texts.get(at, piece.xml)


def _replaced(kind: str, old: list[tuple[int, Piece]], new: Sequence[object], line_end: str) -> dict[int, str]:
    """The new texts of the pieces of a kind, by index; `old` are its pieces with their indexes.

    Equal elements at the beginning and at the end stay unchanged.
    """
    shorter = min(len(old), len(new))
    first = next((at for at in range(shorter) if old[at][1].value != new[at]), shorter)
    rest = shorter - first
    kept = next((at for at in range(rest) if old[-at - 1][1].value != new[-at - 1]), rest)
    changed = list(new[first : len(new) - kept])
    result: dict[int, str] = {}
    for at, piece in old[first : len(old) - kept]:
        result[at] = _element(changed.pop(0), kind, piece, line_end) if changed else ""
    if changed:
        last = len(old) - kept
        at, piece = old[max(last - 1, 0)]
        texts = [_element(value, kind) for value in changed]
        text = result.get(at, piece.xml)
        result[at] = line_end.join([text, *texts] if last else [*texts, text])
    return result


def _insert(
    kind: str, values: Sequence[object], pieces: Sequence[Piece], texts: dict[int, str], before: dict[int, str]
) -> None:
    """Insert the first elements of a kind below its heading if there is one, else before the kinds that follow it."""
    heading = _HEADINGS[kind]
    for at, piece in enumerate(pieces):
        text = texts.get(at, piece.xml)
        if heading and piece.kind == "text" and heading in text:
            elements = [heading, *(_element(value, kind) for value in values)]
            texts[at] = text.replace(heading, "\n".join(elements), 1)
            return
    later = _ORDER[_ORDER.index(kind) + 1 :]
    at = next((at for at, piece in enumerate(pieces) if piece.kind in (*later, "closing")), len(pieces) - 1)
    before[at] = before.get(at, "") + "\n".join([*_section(kind, values), ""])


def _opened(pieces: Sequence[Piece]) -> dict[int, str]:
    """The texts that split an empty root tag into two, since it has content now."""
    at = next(at for at, piece in enumerate(pieces) if piece.kind == "opening")
    tag, closing = pieces[at].xml, pieces[-1].xml
    if not tag.endswith("/>"):
        return {}
    return {at: f"{tag[:-2]}>", len(pieces) - 1: f"</{tag[1:-2].split()[0]}>{closing}"}


def _quoted(text: str) -> str:
    return quoteattr(text, {"\n": "&#10;", "\r": "&#13;", "\t": "&#9;"})


def _text(text: str) -> str:
    return escape(text, {"\r": "&#13;"})


def _comment(text: str) -> str:
    return text.replace("--", "- -").rstrip("-")
