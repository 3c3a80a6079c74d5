"""Many robots: all of them move in the view, although few topics are subscribed to."""

from __future__ import annotations

import json
from typing import Any

import pytest

pytest.importorskip("playwright.sync_api")

from tests.web_ui.page_support import MARKS, choose_robot, open_page, open_tab

pytestmark = MARKS

NAMES = [f"thymio_{number}" for number in range(6)]
ALL_TURN = """(count) => Object.values(window.thymio.state().robots).filter(({previous, latest}) =>
    previous && latest && previous.pose.yaw !== latest.pose.yaw).length === count"""
PLACED = "() => Object.entries(window.thymio.state().robots).filter(([, {isByTransforms}]) => isByTransforms).length"
STANDS = """([name, x, y]) => {
    const pose = window.thymio.state().robots[name]?.latest?.pose;
    return pose && Math.hypot(pose.x - x, pose.y - y) < 0.01;
}"""
STAMPS = "() => Object.values(window.thymio.state().robots).map(({latest}) => latest?.stampNs)"
AS_LATE = f"(stamps) => ({STAMPS})().every((stamp, at) => stamp >= stamps[at])"


@pytest.fixture
def robots_page(world, page, tmp_path) -> Any:
    """Six robots that drive small circles."""
    shapes = [{"kind": "rectangle", "size_x_m": 3.0, "size_y_m": 1.0, "color": "#eef2f6"}]
    robots = [{"name": name, "x_m": -1.2 + 0.5 * number, "y_m": 0.0} for number, name in enumerate(NAMES)]
    playground, program = tmp_path / "many_robots.json", tmp_path / "circle.aesl"
    playground.write_text(json.dumps({"format": 1, "title": "Many robots", "shapes": shapes, "robots": robots}))
    program.write_text("motor.left.target = 100\nmotor.right.target = 200\n")
    open_page(page, world(playground, program))
    page.wait_for_function(ALL_TURN, arg=len(NAMES))
    return page


def test_all_of_many_robots_move_by_their_shared_transforms(robots_page):
    robots_page.wait_for_function(f"() => ({PLACED})() === 5")
    selected = robots_page.evaluate("() => window.thymio.state().selected")
    assert selected == NAMES[0]
    choose_robot(robots_page, NAMES[3])
    robots_page.wait_for_function(f"() => ({PLACED})() === 6")
    stamps = robots_page.evaluate("() => Object.values(window.thymio.state().robots).map(({latest}) => latest.stampNs)")
    later = (
        "(stamps) => Object.values(window.thymio.state().robots).every(({latest}, at) => latest.stampNs > stamps[at])"
    )
    robots_page.wait_for_function(later, arg=stamps)
    open_tab(robots_page, "robot")
    robots_page.wait_for_function("() => window.thymio.state().robot.raw.motor !== undefined")


@pytest.mark.slow
def test_a_browser_that_connects_while_paused_gets_all_poses(robots_page, other_page):
    robots_page.wait_for_function(f"() => ({PLACED})() === 5")
    robots_page.get_by_role("button", name="Pause time").click()
    robots_page.wait_for_function("() => window.thymio.state().simulator.paused")
    open_page(other_page, robots_page.url)
    other_page.wait_for_function(f"(count) => ({STAMPS})().filter(Boolean).length === count", arg=len(NAMES))
    robots_page.wait_for_function(AS_LATE, arg=other_page.evaluate(STAMPS))  # its last ones may come after the pause
    poses = robots_page.evaluate("() => Object.values(window.thymio.state().robots).map(({latest}) => latest.pose)")
    for name, pose in zip(NAMES, poses, strict=True):
        other_page.wait_for_function(STANDS, arg=[name, pose["x"], pose["y"]])
