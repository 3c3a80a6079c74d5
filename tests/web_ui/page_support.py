"""Helpers for browser tests."""

from __future__ import annotations

import contextlib
import json
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import pytest

from tests.patience import PATIENCE_MS
from tests.processes import wait_for_port
from tests.web_ui.shared_world import SharedWorld
from thymio_sim_ros.bridge.protocol import messages as ms

DROPS = 3
STEPS = 12
STEP_MS = PATIENCE_MS / STEPS
KEY_MS = 150
"""Time from one key to the next: that of a pupil. Lists that open between two keys can take the next one."""

MARKS = [pytest.mark.browser, pytest.mark.process]


class TouchPoints:
    """Several touch points, through the DevTools protocol: each has a name; positions are in CSS pixels."""

    def __init__(self, page: Any) -> None:
        self._developer = page.context.new_cdp_session(page)
        self._down: dict[int, tuple[float, float]] = {}

    def start(self, **places: tuple[float, float]) -> None:
        """Start touches: a=(x, y), b=(x, y)."""
        for name, place in places.items():
            self._down[ord(name)] = place
            self._send("touchStart")

    def move(self, steps: int = 6, **places: tuple[float, float]) -> None:
        """Move all touches at once."""
        start = {name: self._down[ord(name)] for name in places}
        for step in range(1, steps + 1):
            for name, (x, y) in places.items():
                from_x, from_y = start[name]
                self._down[ord(name)] = (from_x + (x - from_x) * step / steps, from_y + (y - from_y) * step / steps)
            self._send("touchMove")

    def end(self) -> None:
        """End all touches."""
        self._down.clear()
        self._send("touchEnd")

    def _send(self, kind: str) -> None:
        points = [{"x": x, "y": y, "id": number} for number, (x, y) in self._down.items()]
        self._developer.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})


def drop_file(page: Any, path: Path, selector: str) -> None:
    """Drop a file on the center of the visible part of an element; repeat a gesture that the browser ends elsewhere."""
    box, height = page.locator(selector).bounding_box(), page.viewport_size["height"]
    place = {"x": box["x"] + box["width"] / 2, "y": (box["y"] + min(box["y"] + box["height"], height)) / 2}
    data = {"items": [], "files": [str(path)], "dragOperationsMask": 1}
    developer = page.context.new_cdp_session(page)
    page.evaluate("() => addEventListener('drop', () => (document.body.dataset.drops = 'taken'), {once: true})")
    for _ in range(DROPS):
        for kind in ("dragEnter", "dragOver", "drop"):
            developer.send("Input.dispatchDragEvent", {"type": kind, "data": data} | place)
            hidden = str(kind == "drop").lower()
            page.wait_for_function(f"document.querySelector('#drop').hidden === {hidden}")
        # the hint is hidden by the drop, or by a dragleave in its place
        if page.evaluate(
            "() => { const {drops} = document.body.dataset; delete document.body.dataset.drops; return drops }"
        ):
            return
    pytest.fail(f"the browser has not dropped {path.name} in {DROPS} attempts")


def step_into_event(page: Any, selector: str) -> None:
    """Press F7 until an element shows the line of the halt: between events, a step needs one that waits already."""
    from playwright.sync_api import TimeoutError as TooLate

    for _ in range(STEPS):
        page.keyboard.press("F7")
        with contextlib.suppress(TooLate):
            page.locator(selector).wait_for(state="attached", timeout=STEP_MS)
            return
    pytest.fail(f"{STEPS} steps lead to no line")


def without_welcome(address: str) -> str:
    """The address with tour and welcome disabled, as for a kiosk."""
    page, mark, fragment = address.partition("#")
    return f"{page}{'&' if '?' in page else '?'}tour=off&welcome=off{mark}{fragment}"


def open_page(page: Any, address: str, *, unfold: bool = True) -> None:
    """Load the page as soon as the suite answers, and wait for the robot and the state of the simulator.

    In a low window the tray with the robot's buttons is folded; `unfold` unfolds it.
    """
    wait_for_port(urlsplit(address).port or 80)
    page.goto(without_welcome(address))
    page.wait_for_function("window.thymio && window.thymio.connected && window.thymio.partPosition('robot')")
    page.wait_for_function("window.thymio.state().simulator !== null")
    if unfold:
        page.evaluate("() => document.querySelector('#tray[data-folded] #tray-unfold')?.click()")


def resize(page: Any, width: int, height: int) -> None:
    """Resize the window of a page that is open, and wait until the page has the layout for it."""
    page.set_viewport_size({"width": width, "height": height})
    page.wait_for_function("([width, height]) => innerWidth === width && innerHeight === height", arg=[width, height])
    page.evaluate("() => new Promise(requestAnimationFrame)")  # frames begin with the events of a new size


def open_tab(page: Any, name: str) -> None:
    """Open a tab of the workspace, on phones in the bar at the bottom: robot, program, playground or class."""
    page.locator(f"#tab-{name}, #bar-{name}").locator("visible=true").click()
    page.locator(f"#panel-{name}").wait_for()


def open_details(page: Any) -> None:
    """Open the table with all values of the robot."""
    open_tab(page, "robot")
    if page.locator("#values").get_attribute("open") is None:
        page.click("#values summary")
    page.locator("#values table").wait_for()


def open_menu(page: Any, button: str) -> None:
    """Open the menu or sheet of a button, unless it is open."""
    locator = page.locator(button)
    if locator.get_attribute("aria-expanded") != "true":
        locator.click()
    page.wait_for_function("(button) => document.querySelector(button).ariaExpanded === 'true'", arg=button)


def open_hands(page: Any, hand: str = "room") -> None:
    """Open the sheet of a hand with values: hand, tilt, pen, remote or room; on phones some are in that of "More"."""
    button = f"[data-hand={hand}]"
    if not page.locator(button).is_visible():
        open_menu(page, "#hands-more")
    open_menu(page, button)


def open_editor(page: Any) -> None:
    """Open the tab of the program with the text; with an empty page where the tab asks how to begin."""
    open_tab(page, "program")
    page.locator(".program[data-shown=start], .program[data-shown=program]").wait_for()
    empty = page.locator("[data-new=empty]")
    if empty.is_visible():
        empty.click()
    page.locator(".cm-content").wait_for()


def choose_example(page: Any, name: str) -> None:
    """Start a built-in behavior from the list of examples."""
    open_tab(page, "program")
    page.locator(".program[data-shown=start], .program[data-shown=program]").wait_for()
    example = page.locator(f"[data-example={name}]")
    if not example.is_visible():
        choose_in_file_menu(page, "examples")
    example.click()


def choose_in_file_menu(page: Any, verb: str) -> None:
    """Choose an entry of the menu of the program's file."""
    open_menu(page, "#file-menu")
    page.locator(f"#file-sheet [data-verb={verb}]").click()


def build_playground(page: Any) -> None:
    """Open the creator, with a new playground unless something is being built."""
    open_tab(page, "playground")
    if not page.locator(".palette").is_visible():
        page.click(".current [data-new]")
    page.locator(".palette").wait_for()
    wait_for_frame(page)  # with its title


def go_on_building(page: Any, title: str) -> None:
    """Open a playground of this device in the creator."""
    open_tab(page, "playground")
    page.get_by_role("button", name=f"Go on building {title}", exact=True).click()
    page.locator(".palette").wait_for()


def choose_playground(page: Any, name: str) -> None:
    """Put a ready-made playground on the desk."""
    open_tab(page, "playground")
    page.click(f"[data-playground={name}]")


def choose_robot(page: Any, name: str) -> None:
    """Choose a robot by its name, or all of them by `*`."""
    open_menu(page, "#robot-chooser")
    page.locator(f"#robot-menu [data-robot='{name}']").click()
    wait_for_frame(page)


def choose_language(page: Any, language: str) -> None:
    """Choose the language, on phones in the sheet of the settings."""
    if page.locator("#settings-open").is_visible():
        open_menu(page, "#settings-open")
    page.select_option("select.language", language)
    page.wait_for_function("(language) => document.documentElement.lang === language", arg=language)
    wait_for_frame(page)


def wait_for_program(page: Any, name: str) -> None:
    """Wait until the robot runs the program of that name, in any folder."""
    page.wait_for_function(
        "(name) => { const {program} = window.thymio.state();"
        " return program?.state === 'running' && program.name.endsWith(name); }",
        arg=name,
    )


def wait_for_service(page: Any, *names: str) -> None:
    """Wait until these services are available."""
    page.wait_for_function(
        "(names) => names.every((name) => window.thymio.state().services.includes(name))", arg=list(names)
    )


def wait_for_frame(page: Any) -> None:
    """Wait for one more frame: then panels and view show the current state."""
    frames = page.evaluate("() => window.thymio.frames()")
    page.wait_for_function("(frames) => window.thymio.frames() > frames", arg=frames)


def wait_for_none(page: Any, finding: str, arg: Any = None) -> None:
    """Wait until a function that runs on the page finds nothing; fails with what it still finds."""
    from playwright.sync_api import TimeoutError as TooLate

    with contextlib.suppress(TooLate):
        page.wait_for_function(f"(arg) => ({finding})(arg).length === 0", arg=arg)
    if found := page.evaluate(finding, arg):
        pytest.fail(f"still found: {found}")


def wait_until_still(page: Any, place: str) -> None:
    """Wait until an expression on the page gives the same position in several frames."""
    page.evaluate("() => { window.previous = null; }")
    page.wait_for_function(
        f"() => {{ const now = {place}; const frames = window.thymio.frames(); const {{previous}} = window;"
        " const still = now && previous && Math.hypot(now.x - previous.x, now.y - previous.y) < 0.01;"
        " if (!still) window.previous = now && {x: now.x, y: now.y, frames};"
        " return still && frames > previous.frames + 2; }",
        polling=200,
    )


def wait_for_position(page: Any, part: str) -> dict[str, float]:
    """The screen position of a part of the robot, once the view is still."""
    page.wait_for_function("() => window.thymio.state().markers > 0")
    wait_until_still(page, f"window.thymio.partPosition({json.dumps(part)})")
    place: dict[str, float] = page.evaluate("(part) => window.thymio.partPosition(part)", part)
    return place


def watch_it_avoid(page: Any, world: SharedWorld) -> None:
    """Wait until the robot has driven from the middle of "base" to the wall, turned there and driven on.

    It must touch nothing on its way. The playground is reset first; then time is five times as fast.
    """
    pose = "window.thymio.state().robot.latest.pose"
    is_far = f"([x, y]) => Math.hypot({pose}.x - x, {pose}.y - y) > 0.1"
    with world.client() as client:
        client.subscribe(1, "/_collision")
        page.click("#time [data-verb=reset]")
        page.wait_for_function(f"() => Math.hypot({pose}.x, {pose}.y) <= 0.1")
        page.select_option("#speed", "5")
        page.wait_for_function(is_far, arg=[0, 0])
        page.wait_for_function(f"() => Math.abs({pose}.yaw) > 0.5")
        page.wait_for_function(is_far, arg=page.evaluate(f"[{pose}.x, {pose}.y]"))
        touched = [message.payload[-1] for message in client.read().received if isinstance(message, ms.MessageData)]
    assert not any(touched)
    page.select_option("#speed", "1")
