"""Parts of a layout, independent of the application: panels, split areas and tabs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal, TypeAlias

__all__ = ["Node", "Panel", "Split", "Tabs", "panels_of"]


@dataclass(frozen=True, slots=True)
class Panel:
    """A panel: `kind` is Lichtblick's name of its type, `key` its own name, unique in the layout.

    `config` is its configuration in both applications, `newer` has additional keys for the present Foxglove app.
    """

    kind: str
    key: str
    title: str = ""
    config: Mapping[str, Any] = field(default_factory=dict)
    newer: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Split:
    """Areas side by side (`row`) or one above the other (`column`), each with its share in percent."""

    direction: Literal["row", "column"]
    parts: tuple[tuple[float, Node], ...]


@dataclass(frozen=True, slots=True)
class Tabs:
    """Areas of which one is visible at a time, each with its title."""

    key: str
    tabs: tuple[tuple[str, Node], ...]


Node: TypeAlias = "Panel | Split | Tabs"


def panels_of(node: Node) -> Iterator[Panel]:
    """All panels, in reading order."""
    if isinstance(node, Panel):
        yield node
        return
    for _, part in node.parts if isinstance(node, Split) else node.tabs:
        yield from panels_of(part)
