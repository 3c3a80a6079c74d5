"""One description as two files."""

from __future__ import annotations

import json
from typing import Any

import pytest

from thymio_sim_ros.studio_layout import APPS, SHIPPED, render
from thymio_sim_ros.studio_layout.panels import panels_of
from thymio_sim_ros.studio_layout.thymio import describe


def panels(node: Any) -> list[dict[str, Any]]:
    """Every panel of a Foxglove tree."""
    if node["type"] == "panel":
        return [node]
    parts = node["items"] if node["type"] == "split" else node["tabs"]
    return [panel for part in parts for panel in panels(part["content"])]


def leaves(node: Any, configs: dict[str, Any]) -> list[str]:
    """Every panel id of a Lichtblick tree, those of tabs included."""
    if isinstance(node, str):
        tabs = configs[node].get("tabs", [])
        return [node, *(leaf for tab in tabs for leaf in leaves(tab["layout"], configs))]
    return [*leaves(node["first"], configs), *leaves(node["second"], configs)]


@pytest.mark.parametrize("app", APPS)
def test_the_shipped_file_equals_the_description(app: str) -> None:
    hint = f"run: thymio-sim foxglove-layout --app {app} -o {SHIPPED[app]}"
    assert SHIPPED[app].read_text(encoding="utf-8") == render(app), hint


def test_in_lichtblicks_file_every_panel_has_one_place_and_one_configuration() -> None:
    layout = json.loads(render("lichtblick"))
    placed = leaves(layout["layout"], layout["configById"])
    assert sorted(placed) == sorted(layout["configById"])
    assert len(set(placed)) == len(placed)


def test_lichtblicks_file_uses_lichtblicks_names_of_panels() -> None:
    kinds = {panel.partition("!")[0] for panel in json.loads(render("lichtblick"))["configById"]}
    assert kinds == {
        "3D", "CallService", "DiagnosticSummary", "Indicator", "Parameters", "Plot", "Publish", "RawMessages", "RosOut",
        "Tab", "Teleop", "TopicGraph",
    }  # fmt: skip


def test_foxgloves_file_uses_foxgloves_names_of_panels() -> None:
    layout = json.loads(render("foxglove"))
    assert layout["version"] == 1
    assert {panel["panelType"] for panel in panels(layout["content"])} == {
        "DiagnosticsSummary", "Indicator", "Log", "Parameters", "Plot", "Publish", "RawMessages", "ServiceCall",
        "Teleop", "ThreeDee", "TopicGraph",
    }  # fmt: skip


def test_both_files_have_the_same_panels() -> None:
    expected = [panel.title for panel in panels_of(describe())]
    old, new = json.loads(render("lichtblick")), json.loads(render("foxglove"))
    configs = old["configById"]
    old_panels = [panel for panel in leaves(old["layout"], configs) if not panel.startswith("Tab!")]
    assert [configs[panel]["lichtblickPanelTitle"] for panel in old_panels] == expected
    assert [panel["title"] for panel in panels(new["content"])] == expected


def test_the_present_app_stops_the_robot_when_a_key_is_released() -> None:
    (teleop,) = [panel for panel in panels(json.loads(render("foxglove"))["content"]) if panel["panelType"] == "Teleop"]
    assert teleop["config"]["autoSendStopOnRelease"]
    assert teleop["config"]["stopButton"] == {"field": "linear-x", "value": 0}


def test_areas_side_by_side_share_as_described() -> None:
    split = json.loads(render("lichtblick"))["configById"]["Tab!details"]["tabs"][0]["layout"]
    assert (split["splitPercentage"], split["second"]["splitPercentage"]) == (45.0, 63.6)


@pytest.mark.parametrize("app", APPS)
def test_a_namespace_is_before_every_name_of_the_robot(app: str) -> None:
    text = render(app, "anna")
    assert '"/anna/cmd_vel"' in text
    assert '"/anna/proximity/center.range"' in text
    assert '"/anna/aseba/run"' in text
    assert '"frame:anna/base_link"' in text
    assert '"/simulator/reset"' in text
    assert '"/cmd_vel"' not in text
