"""The page in WebKit against the running suite: its start, a robot that drives, each language, the creator."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import pytest

pytest.importorskip("selenium")

from tests.nginx import Nginx
from tests.patience import until
from tests.processes import SUITE, Process, free_port
from tests.web_ui.page_support import MARKS
from tests.web_ui.webkit import WebKitPage, webkit_driver

pytestmark = [*MARKS, pytest.mark.slow]

PUSHED = """\
onevent button.forward
motor.left.target = 200 * button.forward
motor.right.target = 200 * button.forward
"""
TYPED = (
    "onevent prox\nmotor.left.target = 100\nmotor.right.target = 100\nif acc[0] > 30 then\ncall leds.top(32, 0, 0)\nend"
)
WRITTEN = (
    "onevent prox\n\tmotor.left.target = 100\n\tmotor.right.target = 100\n\tif acc[0] > 30 then\n"
    "\t\tcall leds.top(32, 0, 0)\n\tend"
)
FORWARD = (
    "onevent buttons\nwhen button.forward == 1 do\nmotor.left.target = 300\nmotor.right.target = 300\n"
    "call leds.top(0, 32, 0)\nend"
)
"""A solution of the first mission."""
RIGHT = "\ue014"
POSE = "window.thymio.state().robot.latest.pose"
RUNS = "return window.thymio.state().program?.state === 'running'"
CANVAS = ".blocklySvg .blocklyBlockCanvas"


@pytest.fixture(scope="module")
def driver(tmp_path_factory) -> Iterator[str]:
    """The address of a WebDriver of WebKit; tests are skipped where it is missing."""
    with webkit_driver(tmp_path_factory.mktemp("webkit")) as address:
        yield address


@pytest.fixture
def webkit(driver) -> Iterator[WebKitPage]:
    """A window of WebKit without storage; asserts at the end that no script has failed."""
    page = WebKitPage(driver)
    try:
        yield page
        errors = page.errors
    finally:
        page.quit()
    assert errors == []


def wait_until_it_drives(page: WebKitPage) -> None:
    start = page.run(f"const {{x, y}} = {POSE}; return [x, y]")
    page.wait(f"const [x, y] = arguments[0]; return Math.hypot({POSE}.x - x, {POSE}.y - y) > 0.03", start)


def begin(page: WebKitPage, sample: str) -> None:
    """Open a new program: a sample of a language."""
    page.click("#tab-program")
    page.find(".program[data-shown=start], .program[data-shown=program]")
    card = f"[data-new={sample}]"
    page.wait("return document.querySelector(arguments[0]) !== null", card)
    page.run("const more = document.querySelector(arguments[0]).closest('details'); if (more) more.open = true", card)
    page.click(card)


def wait_for_one(page: WebKitPage, selector: str) -> None:
    page.wait("return document.querySelectorAll(arguments[0]).length === 1", selector)


def new_block(page: WebKitPage, category: int, kind: str, target: tuple[int, int]) -> None:
    """Drag a new block of a category to a place."""
    page.wait("return document.querySelectorAll('.blocklyToolboxCategory')[arguments[0]]", category).click()
    page.drag(page.place(f".blocklyFlyout .{kind}", 4, 20), target)
    wait_for_one(page, f"{CANVAS} .{kind}")


def run(page: WebKitPage) -> None:
    page.wait("return !document.querySelector('[data-verb=run]').disabled")
    page.click("[data-verb=run]")
    page.wait(RUNS)


def test_the_page_draws_the_world_and_its_buttons_drive_the_robot(webkit, world, tmp_path):
    program = tmp_path / "pushed.aesl"
    program.write_text(PUSHED)
    webkit.open(world("base", program))
    webkit.wait(RUNS)
    webkit.wait("return window.thymio.frames() > 2 && window.thymio.state().markers > 0")
    webkit.hold("[data-button=forward]")
    wait_until_it_drives(webkit)
    webkit.release()
    webkit.wait("return Math.abs(window.thymio.state().robot.wheelSpeeds.left) < 0.1")


def test_behind_a_proxy_with_tls_and_a_path_a_program_drives_the_robot(webkit, tmp_path):
    port = free_port()
    proxy = Nginx(tmp_path / "nginx", port)
    options = ("--portable", "--port", str(port), "--no-foxglove-port", "--trusted-proxy", "127.0.0.1")
    suite = Process(tmp_path, SUITE, *options)
    try:
        until(lambda: "Stop " in suite.output, lambda: suite.output)
        token = re.search(r"^Page .*#token=(\S+)", suite.output, re.MULTILINE)
        assert token is not None, suite.output
        webkit.open(f"{proxy.address}#token={token[1]}")
        begin(webkit, "empty")
        webkit.click(".cm-content")
        webkit.type("motor.left.target = 100\nmotor.right.target = 100")
        run(webkit)
        wait_until_it_drives(webkit)
    finally:
        proxy.end()
        suite.end()


def test_a_text_is_typed_at_the_speed_of_a_pupil_and_runs(webkit, world):
    webkit.open(world("base"))
    begin(webkit, "empty")
    webkit.click(".cm-content")
    webkit.type(TYPED)
    lines = "return [...document.querySelectorAll('.cm-line')].map(({textContent}) => textContent).join('\\n')"
    assert webkit.run(lines) == WRITTEN
    run(webkit)
    wait_until_it_drives(webkit)


def test_a_program_of_vpl_is_built_and_runs(webkit, world):
    webkit.open(world("base"))
    begin(webkit, "vpl-empty")
    webkit.click("[data-new-block=prox]")
    wait_for_one(webkit, "[data-row='0'] [data-block=prox]")
    webkit.click("[data-new-block=move]")
    wait_for_one(webkit, "[data-row='0'] [data-block=move]")
    webkit.click("[data-place='0 actions 0']")
    height = webkit.run("return arguments[0].offsetHeight", webkit.find("#vpl-block"))
    assert height < 0.7 * webkit.run("return innerHeight")
    for side in ("left", "right"):
        slider = webkit.find(f"#vpl-block [data-look={side}] input")
        width, height = webkit.run(
            "const {width, height} = arguments[0].getBoundingClientRect(); return [width, height]", slider
        )
        assert height > 2 * width
        slider.send_keys(RIGHT * 4)
    webkit.click("#vpl-block [data-block-verb=done]")
    run(webkit)
    wait_until_it_drives(webkit)


@pytest.mark.parametrize(
    ("sample", "hat", "statement"),
    [
        ("blocks-empty", (0, "thymio_event_prox"), (1, "thymio_motors_start")),
        ("blocks-scratch_start", (3, "thymio_notouching"), (0, "thymio_setMotor")),
    ],
    ids=["blocks", "scratch"],
)
def test_a_program_of_blocks_is_built_and_runs(webkit, world, sample: str, hat: Any, statement: Any):
    webkit.open(world("base"))
    begin(webkit, sample)
    x, y = webkit.place(".blocks-place", 320, 80)
    new_block(webkit, *hat, (x, y))
    new_block(webkit, *statement, webkit.place(f"{CANVAS} .{hat[1]}", 30, 40))
    run(webkit)


def test_a_playground_is_built_and_tried(webkit, world):
    webkit.open(world("base"))
    webkit.click("#tab-playground")
    webkit.click(".current [data-new]")
    webkit.find(".palette")
    count = "return window.thymio.built()?.playground.items.length === arguments[0]"
    webkit.wait(count, 2)
    webkit.click("[data-tool=box]")
    place = "return window.thymio.screenPosition(0.3, 0.3, 0)"
    x, y = (round(webkit.run(place)[axis]) for axis in ("x", "y"))
    webkit.click_at(x, y)
    webkit.wait(count, 3)
    webkit.click("#creator-try")
    webkit.wait("return !window.thymio.built().isOpen && window.thymio.state().simulator.playground !== 'base'")


def test_the_first_mission_is_played_from_the_list_to_the_third_star(webkit, world):
    webkit.open(world("base", "none"))
    webkit.click("#missions-open")
    webkit.click("[data-mission=forward]")
    webkit.wait("return window.thymio.state().mission?.name === 'forward'")
    webkit.click("[data-mission-language=text]")
    webkit.click(".cm-content")
    webkit.type(FORWARD)
    webkit.click("[data-verb=run]")
    wait_for_one(webkit, ".mission-passed")
    stars = "return document.querySelectorAll('.mission-passed .mission-star:not(.mission-no)').length === 3"
    webkit.wait(stars)
    webkit.click("[data-mission-do=next]")
    webkit.wait("return window.thymio.state().mission?.name === 'brake'")
