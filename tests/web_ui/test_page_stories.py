"""The use cases of the earlier thesis, using only names shown on the page, no selectors."""

from __future__ import annotations

from typing import Any

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from tests.web_ui.page_support import MARKS, open_page, wait_for_service

pytestmark = MARKS

MOVED = """([x, y, far]) => {
    const pose = window.thymio.state().robot.latest.pose;
    return Math.hypot(pose.x - x, pose.y - y) > far;
}"""


@pytest.fixture
def class_page(world, page) -> Any:
    """The page at the start of a lesson: the robot is switched on and nothing has been chosen."""
    open_page(page, world("base", "welcome"))
    return page


def choose_example(page: Any, title: str, about: str) -> None:
    """Choose an example, which starts at once and is shown."""
    page.get_by_role("tab", name="Program").click()
    page.get_by_role("button", name=f"{title} {about}").click()
    playwright.expect(page.get_by_role("textbox", name="Program text")).to_be_visible()
    playwright.expect(page.get_by_text("running", exact=True).first).to_be_visible()


def robot_button(page: Any, name: str) -> Any:
    """One of the robot's five buttons, not a key of the remote control."""
    return page.get_by_role("group", name="The five buttons of the robot").get_by_role("button", name=name)


def wait_until_moved(page: Any, far_m: float, act: Any) -> None:
    """Run an action, and wait until the robot has moved by a distance."""
    pose = page.evaluate("() => window.thymio.state().robot.latest.pose")
    act()
    page.wait_for_function(MOVED, arg=[pose["x"], pose["y"], far_m])


@pytest.mark.slow
def test_the_basic_mode_drives_by_the_arrow_buttons(class_page):
    about = "Press an arrow and the robot drives until something is in its way."
    choose_example(class_page, "Drive with the arrows", about)
    wait_until_moved(class_page, 0.05, robot_button(class_page, "Forward").click)
    wait_for_service(class_page, "/aseba/stop")
    class_page.get_by_role("banner").get_by_role("button", name="Stop").click()
    class_page.wait_for_function("() => Math.abs(window.thymio.state().robot.wheelSpeeds.left) < 0.1")


@pytest.mark.slow
def test_the_explorer_avoids_obstacles(class_page):
    class_page.get_by_role("tab", name="Playground").click()
    class_page.get_by_role("button", name="Obstacle").first.click()
    class_page.wait_for_function("() => window.thymio.state().simulator.playground === 'obstacle'")
    about = "Forward starts, backward stops. Avoids things."
    choose_example(class_page, "Press forward: avoid things", about)
    wait_until_moved(class_page, 0.2, robot_button(class_page, "Forward").click)
    playwright.expect(class_page.get_by_text("running", exact=True).first).to_be_visible()


@pytest.mark.slow
def test_the_track_follower_follows_the_track(class_page):
    class_page.get_by_role("tab", name="Playground").click()
    class_page.get_by_role("button", name="Borderless").first.click()
    class_page.wait_for_function("() => window.thymio.state().simulator.playground === 'borderless'")
    about = "Forward starts, backward stops. Follows the track."
    choose_example(class_page, "Press forward: follow the track", about)
    wait_until_moved(class_page, 0.3, robot_button(class_page, "Forward").click)


def test_an_aseba_program_is_written_and_runs_on_the_robot(class_page):
    class_page.get_by_role("tab", name="Program").click()
    class_page.get_by_role("region", name="Text").get_by_role("button", name="Follow a line").click()
    text = class_page.get_by_role("textbox", name="Program text")
    playwright.expect(text).to_contain_text("Follow a line")
    text.press("Control+a")
    class_page.keyboard.insert_text("onevent button.center\ncall leds.top(32, 0, 0)\nmotor.left.target = ")
    playwright.expect(text).not_to_contain_text("Follow")
    playwright.expect(class_page.get_by_text("No mistakes")).to_have_count(0)  # or it would be of the text before
    class_page.keyboard.insert_text("100\n")
    playwright.expect(class_page.get_by_text("No mistakes")).to_be_visible()
    class_page.get_by_role("region", name="Program").get_by_role("button", name="Run program").click()
    playwright.expect(class_page.get_by_role("region", name="Program")).to_contain_text("is loaded")
    robot_button(class_page, "Center").click()
    class_page.wait_for_function("() => window.thymio.state().robot.leds.top?.[0] === 1")
    class_page.wait_for_function("() => window.thymio.state().robot.wheelSpeeds.left > 0.5")
