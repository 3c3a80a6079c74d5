"""Conversion of a layout to the files of the applications (docs/spec/foxglove.md sections 3 and 4).

Lichtblick and older versions of Studio have a table of panels by their IDs, and a binary tree of areas. The present
Foxglove app has one tree that contains the panels, and other names for some types of panels.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from thymio_sim_ros.studio_layout.panels import Node, Panel, Tabs
from thymio_sim_ros.studio_layout.thymio import describe

__all__ = ["APPS", "SHIPPED", "render"]

_RENAMED = {
    "3D": "ThreeDee",
    "CallService": "ServiceCall",
    "DiagnosticSummary": "DiagnosticsSummary",
    "RosOut": "Log",
}
"""Types of panels with another name in the present Foxglove app."""

_TITLES = ("lichtblickPanelTitle", "foxglovePanelTitle")
"""Keys of the title of a panel in Lichtblick and in older versions of Studio."""


def render(app: str, robot: str = "", namespace: str = "") -> str:
    """The layout file for an application of `APPS`, as JSON text; `namespace` is that of the whole suite.

    Raises KeyError for an unknown application.
    """
    return json.dumps(APPS[app](describe(robot, namespace)), indent=1, ensure_ascii=False) + "\n"


def _lichtblick(root: Node) -> dict[str, Any]:
    configs: dict[str, Any] = {}
    layout = _mosaic(root, configs)
    return {
        "configById": configs,
        "globalVariables": {},
        "userNodes": {},
        "playbackConfig": {"speed": 1},
        "layout": layout,
    }


def _mosaic(node: Node, configs: dict[str, Any]) -> Any:
    """The area as a node of the binary tree; the configurations of its panels are added to `configs`."""
    if isinstance(node, Panel):
        panel = f"{node.kind}!{node.key}"
        configs[panel] = dict(node.config) | (dict.fromkeys(_TITLES, node.title) if node.title else {})
        return panel
    if isinstance(node, Tabs):
        panel = f"Tab!{node.key}"
        configs[panel] = {}  # reserves its place in the table before the panels of its tabs
        tabs = [{"title": title, "layout": _mosaic(part, configs)} for title, part in node.tabs]
        configs[panel] = {"activeTabIdx": 0, "tabs": tabs}
        return panel
    return _halves(node.direction, node.parts, configs)


def _halves(direction: str, parts: Sequence[tuple[float, Node]], configs: dict[str, Any]) -> Any:
    (share, first), *rest = parts
    if not rest:
        return _mosaic(first, configs)
    return {
        "direction": direction,
        "first": _mosaic(first, configs),
        "second": _halves(direction, rest, configs),
        "splitPercentage": round(100 * share / sum(share for share, _ in parts), 1),
    }


def _foxglove(root: Node) -> dict[str, Any]:
    return {"version": 1, "content": _tree(root)}


def _tree(node: Node) -> dict[str, Any]:
    if isinstance(node, Panel):
        panel = {"type": "panel", "panelType": _RENAMED.get(node.kind, node.kind), "version": 1}
        return panel | ({"title": node.title} if node.title else {}) | {"config": {**node.config, **node.newer}}
    if isinstance(node, Tabs):
        tabs = [{"title": title, "content": _tree(part)} for title, part in node.tabs]
        return {"type": "tabs", "selectedTabIndex": 0, "tabs": tabs}
    items = [{"proportion": round(share, 1), "content": _tree(part)} for share, part in node.parts]
    return {"type": "split", "direction": node.direction, "items": items}


APPS: dict[str, Callable[[Node], dict[str, Any]]] = {"foxglove": _foxglove, "lichtblick": _lichtblick}

SHIPPED = {app: Path(__file__).parent / f"thymio_{app}.json" for app in APPS}
"""The files for a robot without a namespace, by application."""
