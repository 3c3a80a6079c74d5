"""The five tasks of someone who sees the page for the first time and follows only what it says.

Drive to the wall, load a program, find the mistake in one, build a playground with a door, connect a ROS node: by mouse
with few clicks, by the keyboard alone, and by touch on a tablet and on a phone.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from tests.processes import Process, wait_for_port
from tests.web_ui.page_support import MARKS, wait_for_program, wait_until_still
from tests.web_ui.tabs import checked_page
from tests.web_ui.test_welcome import MOVES, READY, RESTS

pytestmark = MARKS

MOST_KEYS = 150
MOST_CLICKS = {"drive": 2, "load": 4, "mistake": 2, "door": 7, "ros": 4}
GREEN = "onevent button.center\ncall leds.top(0, 32, 0)"
MISTAKE = "onevent button.forward\nif button.forward = 1 then\ncall leds.top(32, 0, 0)\nend"
FOCUS = """(one) => {
    const focused = document.activeElement;
    const isBefore = (one.compareDocumentPosition(focused) & Node.DOCUMENT_POSITION_FOLLOWING) !== 0;
    return [one === focused, focused.getAttribute("role"), focused.matches(".cm-content"), isBefore];
}"""
KEEPS_FOCUS = "() => document.activeElement !== null && document.activeElement !== document.body"
ITEMS = "(count) => window.thymio.built().playground.items.length === count"
LEAST_TOUCH_PX = 44


class Mouse:
    """A hand with a mouse; it counts its clicks, by task."""

    def __init__(self, page: Any) -> None:
        self.page = page
        self.task = ""
        self.clicks: Counter[str] = Counter()

    def choose(self, role: str, name: str | re.Pattern[str], within: str = "body") -> None:
        """Choose what has a role and a name on the page."""
        place = self.page.locator(within)
        self._choose(place.get_by_role(role, name=name, exact=True).locator("visible=true").first)
        self.clicks[self.task] += 1

    def open_tab(self, name: str) -> None:
        """Choose a tab, on phones in the bar at the bottom."""
        self.choose("tab", name)

    def open_file(self, file: Path) -> None:
        """Open a program by the menu of the file."""
        self.choose("button", re.compile("^File:"))
        with self.page.expect_file_chooser() as chooser:
            self.choose("button", "Open a program")
        chooser.value.set_files(str(file))

    def drive(self) -> None:
        """Press the arrow forward."""
        self.choose("button", "Forward", "#pad")

    def place(self, tool: str, x: float, y: float) -> None:
        """Place an item of the creator."""
        self.choose("button", tool)
        self._click(*self._spot(x, y))
        self.clicks[self.task] += 1

    def _choose(self, locator: Any) -> None:
        locator.click()

    def _click(self, x: float, y: float) -> None:
        self.page.mouse.click(x, y)

    def _spot(self, x: float, y: float) -> tuple[float, float]:
        wait_until_still(self.page, f"window.thymio.screenPosition({x}, {y}, 0)")
        place = self.page.evaluate("([x, y]) => window.thymio.screenPosition(x, y, 0)", [x, y])
        return place["x"], place["y"]


class Keyboard(Mouse):
    """Two hands on the keyboard: Tab, arrows in lists, Enter."""

    def drive(self) -> None:
        """The card gives the view the focus."""
        playwright.expect(self.page.locator("#view")).to_be_focused()
        self.page.keyboard.down("ArrowUp")
        self.page.wait_for_function("() => window.thymio.state().robot.buttons.forward")
        self.page.keyboard.up("ArrowUp")

    def place(self, tool: str, x: float, y: float) -> None:
        """Choose the tool, which gives the view the focus; move from the middle of the view, place."""
        self.choose("button", tool)
        playwright.expect(self.page.locator("#view")).to_be_focused()
        for key in ("ArrowRight" if x > 0 else "ArrowLeft", "ArrowUp" if y > 0 else "ArrowDown"):
            self.page.keyboard.press(f"Shift+{key}")
        self.page.keyboard.press("Enter")

    def _choose(self, locator: Any) -> None:
        locator.wait_for()
        if self.clicks.total() > 0:
            self.page.wait_for_function(KEEPS_FOCUS)
        wanted = locator.get_attribute("role")
        for _ in range(MOST_KEYS):
            has_focus, role, is_text, is_before = locator.evaluate(FOCUS)
            if has_focus:
                break
            if is_text:
                self.page.keyboard.press("Escape")  # then Tab leaves the text
            in_list = role == wanted and role in {"menuitem", "tab"}
            self.page.keyboard.press("ArrowDown" if in_list else "Shift+Tab" if is_before else "Tab")
        else:
            pytest.fail(f"{MOST_KEYS} keys do not lead to {locator}")
        self.page.keyboard.press("Enter")


class Tablet(Mouse):
    """A finger: what it taps is large enough."""

    def _choose(self, locator: Any) -> None:
        locator.scroll_into_view_if_needed()
        box = locator.bounding_box()
        assert min(box["width"], box["height"]) >= LEAST_TOUCH_PX, locator
        locator.tap()

    def _click(self, x: float, y: float) -> None:
        self.page.touchscreen.tap(x, y)


class Phone(Tablet):
    """A finger on a phone: tabs are in the bar at the bottom."""

    def open_tab(self, name: str) -> None:
        """Choose a screen in the bar."""
        self.choose("button", name, "#bar")


HANDS = {
    Mouse: {"viewport": {"width": 1280, "height": 800}},
    Keyboard: {"viewport": {"width": 1280, "height": 720}},
    Tablet: {"viewport": {"width": 1024, "height": 768}, "has_touch": True, "is_mobile": True},
    Phone: {"viewport": {"width": 390, "height": 844}, "has_touch": True, "is_mobile": True},
}


@pytest.fixture(params=HANDS, ids=lambda kind: kind.__name__.lower())
def hand(request, browser, ros_domain, suite) -> Iterator[Any]:
    """The page as it is after installation, at its first visit, and a hand that uses it."""
    address = suite("--ros")
    wait_for_port(int(address.rsplit(":", 1)[1].strip("/")))
    for page in checked_page(browser, **HANDS[request.param]):
        page.context.grant_permissions(["clipboard-read", "clipboard-write"])
        page.on("filechooser", lambda _chooser: None)  # so that no dialog of the system opens
        page.goto(address)
        page.wait_for_function(READY)
        yield request.param(page)


def program(folder: Path, name: str, text: str) -> Path:
    file = folder / name
    file.write_text(f'<network>\n<node nodeId="1" name="thymio-II">{text}</node>\n</network>\n')
    return file


def run_as_node(folder: Path, page: Any, command: str) -> None:
    """Publish what a command for a terminal says, as a ROS node of another process does, until the robot moves."""
    pattern = r'ros2 topic pub --rate (\d+) --times \d+ (\S+) geometry_msgs/msg/Twist "\{linear: \{x: ([\d.]+)\}\}"'
    match = re.fullmatch(pattern, command)
    assert match is not None, command
    node = Process(folder, "tests.web_ui.velocity_node", match[2], match[1], match[3])
    try:
        page.wait_for_function(MOVES)
    finally:
        node.end()


@pytest.mark.slow
def test_the_five_tasks_by_what_the_page_says(hand, tmp_path):
    page = hand.page

    hand.task = "drive"
    hand.choose("button", "Drive with the arrows")
    wait_for_program(page, "thesis_basic.aesl")
    hand.drive()
    page.wait_for_function(MOVES)
    page.wait_for_function(RESTS)  # in front of the wall

    hand.task = "load"
    hand.open_tab("Program")
    hand.open_file(program(tmp_path, "green.aesl", GREEN))
    playwright.expect(page.locator(".verdict")).to_contain_text("No mistakes")
    hand.choose("button", "Run program")
    wait_for_program(page, "green.aesl")

    hand.task = "the way to it"
    hand.open_file(program(tmp_path, "mistake.aesl", MISTAKE))
    card = page.locator(".mistake-card")
    playwright.expect(card).to_contain_text("One “=” stores. Two compare.")
    playwright.expect(page.locator(".verdict")).to_contain_text("1 mistake, line 2")
    hand.task = "mistake"
    hand.choose("button", "Change it to ==", ".mistake-card")
    playwright.expect(page.locator(".verdict")).to_contain_text("No mistakes")
    hand.choose("button", "Run program")
    wait_for_program(page, "mistake.aesl")

    hand.task = "door"
    hand.open_tab("Playground")
    hand.choose("button", "New playground")
    hand.place("Door", -0.2, 0.2)
    page.wait_for_function(ITEMS, arg=3)
    hand.place("Plate", 0.2, -0.2)
    page.wait_for_function(ITEMS, arg=4)
    hand.choose("button", "Try it")
    page.wait_for_function("window.thymio.state().simulator.playground === 'My_playground.json'")

    hand.task = "ros"
    hand.choose("button", "Help and tour")
    hand.choose("menuitem", "Show the ways to start")
    hand.choose("button", "Show me the topics")
    hand.choose("button", "Copy the command", "#welcome-ros")
    playwright.expect(page.locator("#welcome-ros")).to_contain_text("Copied")
    copied = page.wait_for_function("navigator.clipboard.readText()")  # truthy: the browser writes it a moment later
    run_as_node(tmp_path, page, copied.json_value())
    page.keyboard.press("Escape")
    playwright.expect(page.locator(".welcome-starts")).to_have_count(0)
    page.wait_for_function("() => document.activeElement.id === 'view'")  # the focus is not lost with the cards

    if type(hand) is Mouse:
        assert {task: hand.clicks[task] for task in MOST_CLICKS} == MOST_CLICKS
