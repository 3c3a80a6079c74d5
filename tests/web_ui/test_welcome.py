"""The first visit: three starts, each one click from a moving robot; shown until one is chosen, and on request."""

from __future__ import annotations

import json
import re

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from tests.bridge.studio import set_and_answer
from tests.processes import wait_for_port
from tests.web_ui.page_support import MARKS, choose_language, open_menu, open_tab, wait_for_frame, wait_for_none
from tests.web_ui.test_page_access import AXE, FINDINGS, OVERLAPPING
from tests.web_ui.test_page_recovery import NO_STORAGE
from thymio_sim_ros.bridge.protocol import messages as ms

pytestmark = MARKS

READY = "window.thymio && window.thymio.connected && window.thymio.partPosition('robot')"
SPEED = "() => Object.values(window.thymio.state().robot.wheelSpeeds)"
MOVES = f"() => ({SPEED})().every((speed) => speed > 0.5)"
RESTS = f"() => ({SPEED})().every((speed) => Math.abs(speed) < 0.01)"
STARTS = ".welcome-starts"
IN_SIGHT = """() => [...document.querySelectorAll(".welcome-start, .welcome-watch, .welcome-tour")].every((element) => {
    const {left, top, right, bottom} = element.getBoundingClientRect();
    return left >= 0 && top >= 0 && right <= innerWidth && bottom <= innerHeight;
})"""

GREETING_IS_WHOLE = """() => {
    const hello = document.querySelector(".welcome-hello");
    const {left, top, right, bottom} = hello.getBoundingClientRect();
    const view = document.querySelector("#view").getBoundingClientRect();
    const robot = window.thymio.partPosition("robot");
    const tip = left + parseFloat(getComputedStyle(hello, "::after").left);
    return left >= view.left && right <= view.right && top >= view.top && bottom <= view.bottom
        && hello.scrollWidth <= hello.clientWidth && left <= robot.x && robot.x <= right
        && Math.abs(tip - robot.x) < 30;
}"""
"""The greeting is in the view, and its tip is at the robot."""

OFFER_IS_FREE = """() => {
    const box = (element) => element.getBoundingClientRect();
    const offer = document.querySelector(".welcome-tour");
    if (offer === null) return false;
    const {left, top, right, bottom} = box(offer);
    const others = [...document.querySelectorAll(".welcome-start, .welcome-watch, #messages > *, #trouble")].map(box);
    return offer.checkVisibility({visibilityProperty: true}) && !others.some((other) => other.width > 0
        && other.left < right && other.right > left && other.top < bottom && other.bottom > top);
}"""
"""The offer of the tour covers neither a start nor a message."""


def wait_for_program(page, name):
    """Wait until the robot runs the built-in program."""
    page.wait_for_function(
        "(name) => { const {program} = window.thymio.state();"
        " return program?.state === 'running' && program.name.split('.')[0] === name; }",
        arg=name,
    )


def visit(page, address, query="tour=off"):
    wait_for_port(int(address.rsplit(":", 1)[1].strip("/")))
    page.goto(f"{address}?{query}")
    page.wait_for_function(READY)


@pytest.fixture
def first_visit(world, page):
    """The page at a first visit: the robot waits in the ring of line. Also its address."""
    address = world("line", "welcome")
    visit(page, address)
    page.locator(STARTS).wait_for()
    wait_for_program(page, "welcome")
    return page, address


def test_drive_it_one_click_and_the_arrow_keys_drive(first_visit):
    page, _ = first_visit
    page.set_viewport_size({"width": 1366, "height": 650})  # a laptop of a school: the tray is folded
    page.wait_for_function(RESTS)
    page.get_by_role("button", name="Drive with the arrows").click()
    wait_for_program(page, "thesis_basic")
    playwright.expect(page.locator(STARTS)).to_have_count(0)
    playwright.expect(page.locator("#view")).to_be_focused()
    playwright.expect(page.locator("#pad")).to_be_visible()
    page.keyboard.down("ArrowUp")
    page.wait_for_function("() => window.thymio.state().robot.buttons.forward")
    page.keyboard.up("ArrowUp")
    page.wait_for_function(MOVES)


@pytest.mark.slow
def test_program_it_an_example_moves_and_its_text_is_open(first_visit):
    page, _ = first_visit
    page.locator("[data-start=program]").click()
    page.get_by_role("menuitem", name=re.compile("^(Line follower|Follow the line)")).click()
    wait_for_program(page, "line_follower")
    page.wait_for_function(MOVES)
    playwright.expect(page.locator("#panel-program")).to_be_visible()
    playwright.expect(page.locator(".cm-content")).to_contain_text("Follow a black line")


@pytest.mark.slow
def test_connect_ros_2_the_shown_speed_is_sent_once(first_visit):
    page, _ = first_visit
    playwright.expect(page.locator("[data-start=ros]").locator("xpath=ancestor::li")).to_contain_text("/cmd_vel")
    page.locator("[data-start=ros]").click()
    sheet = page.get_by_role("dialog", name="Connect ROS 2")
    command = "ros2 topic pub --rate 10 --times 20 /cmd_vel geometry_msgs/msg/Twist"
    playwright.expect(sheet).to_contain_text(command)
    for topic in ("/odom", "/imu", "/ground/{left, right}", "/led/circle"):
        playwright.expect(sheet).to_contain_text(topic)
    sheet.get_by_role("button", name="Send this speed once").click()
    page.wait_for_function(MOVES)
    page.wait_for_function(RESTS)  # after two seconds
    link = sheet.get_by_role("link", name="All topics and services")
    answer = page.request.get(f"{page.url.split('?')[0]}{link.get_attribute('href')}")
    assert answer.ok
    assert "cmd_vel" in answer.text()
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    sheet.get_by_role("button", name="Copy the command").click()
    page.wait_for_function("async (command) => (await navigator.clipboard.readText()).startsWith(command)", arg=command)
    page.keyboard.press("Escape")
    playwright.expect(sheet).to_have_count(0)
    playwright.expect(page.locator(STARTS)).to_have_count(0)
    assert page.evaluate("window.thymio.state().program.state") == "running"  # Escape has stopped nothing


@pytest.mark.slow
def test_who_only_watches_sees_it_follow_the_line(first_visit):
    page, _ = first_visit
    page.locator("#pause").click()
    page.wait_for_function("() => window.thymio.state().simulator.paused")
    page.get_by_role("button", name="Just watch it follow the line").click()
    wait_for_program(page, "line_follower")
    page.wait_for_function(MOVES)


@pytest.mark.slow
def test_a_choice_is_for_good_and_the_question_mark_shows_the_starts_again(first_visit):
    page, address = first_visit
    page.keyboard.press("Escape")
    playwright.expect(page.locator(STARTS)).to_have_count(0)
    visit(page, address)
    wait_for_frame(page)
    playwright.expect(page.locator(STARTS)).to_have_count(0)
    open_menu(page, "#help-open")
    page.get_by_role("menuitem", name="Show the ways to start").click()
    page.locator(STARTS).wait_for()
    open_tab(page, "robot")  # something else was chosen
    playwright.expect(page.locator(STARTS)).to_have_count(0)


@pytest.mark.slow
def test_without_browser_storage_a_choice_lasts_in_this_visit(world, own_page):
    page = own_page
    page.add_init_script(NO_STORAGE)
    visit(page, world("line", "welcome"))
    page.locator(STARTS).wait_for()
    page.keyboard.press("Escape")
    page.reload()
    page.wait_for_function(READY)
    wait_for_frame(page)
    playwright.expect(page.locator(STARTS)).to_have_count(0)


def test_the_greeting_is_over_the_robot_and_in_every_language(first_visit):
    page, _ = first_visit
    hello = page.locator(".welcome-hello")
    for language, text in (("de", "Hallo, ich bin Thymio."), ("fr", "Bonjour"), ("it", "Ciao"), ("en", "Hello")):
        choose_language(page, language)
        playwright.expect(hello).to_contain_text(text)
    page.wait_for_function(
        """() => {
            const {left, right, bottom} = document.querySelector(".welcome-hello").getBoundingClientRect();
            const robot = window.thymio.partPosition("robot");
            return left < robot.x && robot.x < right && bottom < robot.y + 30;
        }"""
    )


@pytest.mark.slow
@pytest.mark.parametrize("size", [(1280, 800), (1024, 768), (390, 844), (640, 400)])
def test_everything_is_in_sight_and_accessible_on_every_screen(world, page, size):
    page.set_viewport_size({"width": size[0], "height": size[1]})
    page.emulate_media(reduced_motion="reduce")
    visit(page, world("line", "welcome"), "welcome=on")
    page.locator(STARTS).wait_for()
    for language in ("de", "fr", "it", "en"):
        choose_language(page, language)
        page.locator(STARTS).wait_for()
        page.wait_for_function(IN_SIGHT)
        page.wait_for_function(OFFER_IS_FREE)
    if AXE.exists():
        page.add_script_tag(path=str(AXE))
        assert page.evaluate(FINDINGS) == []
    page.keyboard.press("Escape")  # the starts are gone, the offer of the tour stays, and covers nothing
    page.locator(".view-row").wait_for()
    wait_for_none(page, OVERLAPPING)
    assert page.locator(".welcome-tour").count() == 1


@pytest.mark.slow
@pytest.mark.parametrize("x_m", [-0.9, 0.9])
def test_the_greeting_of_a_robot_at_an_edge_of_the_view_is_whole(world, page, tmp_path, x_m):
    ground = {"kind": "rectangle", "size_x_m": 2, "size_y_m": 1, "color": "#ffffff"}
    robots = [{"name": "thymio", "x_m": x_m, "y_m": 0}]
    playground = tmp_path / "wide.json"
    playground.write_text(json.dumps({"format": 1, "title": "Wide", "shapes": [ground], "robots": robots}))
    page.emulate_media(reduced_motion="reduce")
    visit(page, world(playground, "welcome"), "welcome=on&tour=off")
    for language in ("en", "fr"):
        choose_language(page, language)
        page.locator(STARTS).wait_for()
        for width, height in ((390, 844), (640, 400), (1024, 768)):
            page.set_viewport_size({"width": width, "height": height})
            page.wait_for_function(GREETING_IS_WHOLE)


@pytest.mark.slow
def test_the_offer_of_the_tour_waits_while_the_teacher_says_something_on_a_phone(world, page):
    page.set_viewport_size({"width": 390, "height": 844})
    address = world("line", "welcome")
    with world.client() as client:
        set_and_answer(client, ms.Parameter("/web_ui.notice", "Look at the board. " * 9))
    visit(page, address, "welcome=on")
    page.locator(STARTS).wait_for()
    note = page.locator(".teacher-note")
    note.wait_for()
    page.wait_for_function("() => document.querySelector('.welcome-tour')?.style.visibility === 'hidden'")
    note.get_by_role("button", name="Hide").click()
    page.wait_for_function(OFFER_IS_FREE)


@pytest.mark.slow
def test_the_keys_are_listed_in_a_dialog_that_escape_closes(world, page):
    visit(page, world("line", "welcome"), "tour=off&welcome=off")
    wait_for_program(page, "welcome")
    open_menu(page, "#help-open")
    page.get_by_role("menuitem", name="Keys").click()
    dialog = page.get_by_role("dialog", name="Keys")
    playwright.expect(dialog).to_contain_text("press the robot’s buttons")
    if AXE.exists():
        page.add_script_tag(path=str(AXE))
        assert page.evaluate(FINDINGS) == []
    page.keyboard.press("Escape")
    playwright.expect(dialog).to_have_count(0)
    assert page.evaluate("window.thymio.state().program.state") == "running"


@pytest.mark.slow
def test_the_documentation_ships_with_the_page(first_visit):
    page, _ = first_visit
    open_menu(page, "#help-open")
    with page.context.expect_page() as opened:
        page.get_by_role("menuitem", name="Documentation").click()
    documents = opened.value
    documents.get_by_role("link", name="The web page").click()
    playwright.expect(documents.get_by_role("heading", name="The web page", level=1)).to_be_visible()
    if AXE.exists():
        documents.add_script_tag(content=AXE.read_text(encoding="utf-8"))
        assert documents.evaluate(FINDINGS) == []
