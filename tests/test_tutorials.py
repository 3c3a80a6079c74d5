"""The tutorials do what they say: each is followed from its first line to its last, in terminals of its own."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from tests import pages, terminals

pytest.importorskip("rclpy")
pytestmark = [
    pytest.mark.process,
    pytest.mark.skipif(shutil.which("setsid") is None, reason="the program setsid is not installed"),
]

FOLDER = pages.DOCS / "tutorials"
TUTORIALS = (
    "drive",
    "first-node",
    "sensors",
    "service",
    "action",
    "time",
    "domains",
    "qos",
    "tf",
    "two-robots",
    "package",
    "record",
    "many-runs",
)
LANDING = "first-node"
"""The tutorial that `make test` follows; the others wait in real time."""
NEEDS = {"many-runs": ("distributed", "matplotlib", "pyarrow"), "record": ("matplotlib", "rosbags")}
"""Packages of extras, without which a tutorial is skipped."""


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=() if name == LANDING else pytest.mark.slow) for name in TUTORIALS]
)
def test_a_tutorial_does_what_it_says(name: str, ros_domain: int, tmp_path: Path) -> None:
    for package in NEEDS.get(name, ()):
        pytest.importorskip(package)
    with terminals.reader(tmp_path, ros_domain) as reader:
        reader.follow(pages.read(FOLDER / f"{name}.md"))
    if reader.has_skipped:
        pytest.skip(f"executed: {terminals.NO_ROS2}")


def test_the_first_page_links_all_tutorials_in_order() -> None:
    text = pages.read(FOLDER / "index.md")
    places = [text.index(f"]({name}.md)") for name in TUTORIALS]
    assert places == sorted(places)
