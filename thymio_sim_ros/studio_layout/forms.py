"""A layout as a file of either application.

Lichtblick and older versions of Studio: panels by id in one table, and a binary tree of areas. The present Foxglove
app: one tree with the panels in it, some types renamed (docs/spec/foxglove.md sections 3 and 4).
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
"""Types of panels that the present Foxglove app calls otherwise."""

_TITLES = ("lichtblickPanelTitle", "foxglovePanelTitle")
"""Where Lichtblick keeps the title of a panel, and where Studio before it did."""


def render(app: str, robot: str = "", namespace: str = "") -> str:
    """The file for an application of `APPS`, as JSON text; `namespace`: of the whole suite."""
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
    """The area's node in the tree; what its panels are goes into `configs`."""
    if isinstance(node, Panel):
        panel = f"{node.kind}!{node.key}"
        configs[panel] = dict(node.config) | (dict.fromkeys(_TITLES, node.title) if node.title else {})
        return panel
    if isinstance(node, Tabs):
        panel = f"Tab!{node.key}"
        configs[panel] = {}  # its place in the table is before those of its tabs
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
