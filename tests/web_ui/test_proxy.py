"""Lessons behind a real nginx with TLS and a path, as docs/serve-a-school.md configures it."""

from __future__ import annotations

import re
import ssl
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from urllib.parse import urljoin

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

from tests.classroom.class_support import RunningClass
from tests.nginx import Nginx
from tests.patience import until
from tests.processes import SUITE, Process, free_port
from tests.web_ui.page_support import (
    MARKS,
    build_playground,
    open_editor,
    open_page,
    step_into_event,
)
from tests.web_ui.tabs import checked_page, new_page, problems_of
from tests.web_ui.test_editor import click_beside
from tests.web_ui.test_page_sound import LISTEN, SOUNDING
from thymio_sim_ros.bridge.protocol.constants import SUBPROTOCOLS

pytestmark = MARKS

PROGRAM = """\
var count = 0
call leds.top(0, 32, 0)
call sound.freq(440, 0)
motor.left.target = 200
timer.period[0] = 50
onevent timer0
  count = count + 1
"""
HALTED = 7
"""The line with a breakpoint."""
PLACE = "() => JSON.stringify(window.thymio.partPosition('robot'))"
TLS = {"ignore_https_errors": True}


@pytest.fixture(scope="module")
def group(browser, tmp_path_factory: pytest.TempPathFactory) -> Iterator[RunningClass]:
    """A class of six behind a proxy."""
    path = tmp_path_factory.mktemp("class")
    names = ["Ada", "Ben", "Eve", "Ida", "Tom", "Uma"]
    running = RunningClass(path, names, arguments=("--trusted-proxy", "127.0.0.1"))
    yield running
    running.end()


@pytest.fixture(scope="module")
def proxy(group: RunningClass, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Nginx]:
    """The proxy in front of the class."""
    running = Nginx(tmp_path_factory.mktemp("proxy") / "nginx", group.port)
    yield running
    running.end()


@pytest.fixture
def page(browser) -> Iterator[Any]:
    """A page that accepts the certificate of the proxy, and whose sounds are noted."""
    for one in checked_page(browser, **TLS):
        one.add_init_script(LISTEN)
        yield one


def lesson(page: Any) -> None:
    """A program that is written, heard, halted and stepped; the 3D view, and a playground that is built."""
    open_editor(page)
    page.locator(".cm-content").fill(PROGRAM)
    before = page.evaluate(PLACE)
    page.get_by_role("button", name="Run program").click()
    page.wait_for_function("() => window.thymio.state().robot.leds.top !== undefined")
    page.wait_for_function(f"(before) => ({PLACE})() !== before", arg=before)
    page.wait_for_function(f"({SOUNDING})() === 1")
    click_beside(page, HALTED)
    playwright.expect(page.locator("#program-state")).to_have_text(f"halted in line {HALTED}")
    page.focus(".cm-content")
    step_into_event(page, ".current-line")
    click_beside(page, HALTED)
    page.keyboard.press("F9")
    playwright.expect(page.locator("#program-state")).to_have_text("running")
    build_playground(page)
    page.locator("#view").press("n")
    page.locator(".item-form").wait_for()


def test_a_pupil_comes_by_the_address_of_the_class_and_has_a_lesson(group: RunningClass, proxy: Nginx, page) -> None:
    page.goto(f"{proxy.address}#token={group.known['room_code']}")
    page.get_by_role("link", name="Ben").click()
    page.locator("#pupil", has_text="Ben").wait_for()
    assert page.url == f"{proxy.address}p/ben/"
    open_page(page, page.url)
    lesson(page)
    page.goto("about:blank")  # nginx logs a WebSocket when it has ended
    until(lambda: " 101 " in proxy.whole_log)
    assert "token" not in proxy.whole_log
    assert group.token_of("ben") not in proxy.whole_log


def test_a_suite_behind_the_proxy_needs_its_token_and_has_a_lesson(browser, page, tmp_path: Path) -> None:
    port = free_port()
    options = ("--portable", "--port", str(port), "--no-foxglove-port", "--trusted-proxy", "127.0.0.1")
    proxy = Nginx(tmp_path / "nginx", port)  # skips the test where there is none, before a suite is left behind
    suite = Process(tmp_path, SUITE, *options)
    try:
        until(lambda: "Stop " in suite.output, lambda: suite.output)
        page.goto(f"{proxy.address}?tour=off&welcome=off")
        page.locator("#connection[data-state=noToken]").wait_for()
        token = re.search(r"^Page .*#token=(\S+)", suite.output, re.MULTILINE)
        assert token is not None, suite.output
        page.goto(f"{proxy.address}?tour=off&welcome=off#token={token[1]}")
        page.locator("#connection[data-state=connected]").wait_for()
        open_page(page, proxy.address)  # the tab keeps the token
        lesson(page)
    finally:
        proxy.end()
        suite.end()


def test_a_simulator_that_dies_comes_back_on_the_open_page_and_others_do_not_notice(
    group: RunningClass, proxy: Nginx, browser, page
) -> None:
    other = new_page(browser, **TLS)
    states = (
        "() => { const dot = document.getElementById('connection'); window.seen = [dot.dataset.state]; "
        "new MutationObserver(() => window.seen.push(dot.dataset.state)).observe(dot, { attributes: true }); }"
    )
    for one, pupil in ((page, "ida"), (other, "tom")):
        one.goto(f"{proxy.address}p/{pupil}/?tour=off&welcome=off#token={group.token_of(pupil)}")
        one.locator("#connection[data-state=connected]").wait_for()
        one.evaluate(states)
    group.suite("ida").kill()
    page.wait_for_function("() => window.seen.length > 1")
    page.locator("#connection[data-state=connected]").wait_for()
    page.locator("#pupil", has_text="Ida").wait_for()
    before = page.evaluate("() => window.thymio.state().timeNs")
    page.wait_for_function("(before) => window.thymio.state().timeNs !== before", arg=before)
    assert set(other.evaluate("() => window.seen")) == {"connected"}
    other.context.close()


def test_two_devices_of_a_pupil_show_the_same_robot(group: RunningClass, proxy: Nginx, browser, page) -> None:
    tablet = new_page(browser, **TLS)
    for one in (page, tablet):
        one.goto(f"{proxy.address}p/uma/?tour=off&welcome=off#token={group.token_of('uma')}")
        one.locator("#connection[data-state=connected]").wait_for()
    open_page(page, page.url)
    open_editor(page)
    page.locator(".cm-content").fill("call leds.top(0, 0, 32)\nmotor.left.target = 100")
    page.get_by_role("button", name="Run program").click()
    has_blue_top = "() => Object.values(window.thymio.state().robots).some(({ leds }) => leds.top?.[2] > 0.9)"
    for one in (page, tablet):
        one.wait_for_function(has_blue_top)
    tablet.context.close()


def test_the_links_of_the_teacher_have_the_address_of_the_proxy(group: RunningClass, proxy: Nginx, page) -> None:
    page.goto(f"{proxy.address}teacher/#token={group.known['teacher_token']}")
    page.locator("#count", has_text="6 / 6").wait_for()
    page.click("[data-verb=sheet]")
    link = page.locator(".class-link a").first
    link.wait_for()
    assert link.inner_text() == f"{proxy.address}p/ada/#token={group.token_of('ada')}"
    assert urljoin(page.url, group.pupil("ada")["link"]) == link.inner_text()
    page.click("[data-verb=back]")
    page.click("[data-verb=room]")
    page.locator("#room-address", has_text=proxy.address).wait_for()


def test_the_page_keeps_to_its_content_security_policy(group: RunningClass, proxy: Nginx, browser) -> None:
    page = new_page(browser, **TLS, bypass_csp=False)
    problems = problems_of(page)
    page.on("console", lambda message: problems.append(message.text) if message.type == "error" else None)
    page.goto(f"{proxy.address}p/eve/?tour=off#token={group.token_of('eve')}")
    page.locator("#connection[data-state=connected]").wait_for()
    page.context.close()
    assert problems == []


def test_a_foxglove_client_connects_through_the_proxy_with_the_right_token(group: RunningClass, proxy: Nginx) -> None:
    context = ssl.create_default_context()
    context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
    address = f"{proxy.address}p/ada/".replace("https", "wss")
    how: dict[str, Any] = {"subprotocols": SUBPROTOCOLS, "ssl": context, "proxy": None}
    with connect(f"{address}?token={group.token_of('ada')}", **how) as client:
        assert "serverInfo" in client.recv()
    with pytest.raises(InvalidStatus, match="401"):
        connect(f"{address}?token={group.token_of('ben')}", **how)
    assert group.token_of("ada") not in proxy.log


def test_behind_a_proxy_without_upgrade_the_page_says_what_is_wrong(
    group: RunningClass, browser, tmp_path, page
) -> None:
    proxy = Nginx(tmp_path / "nginx", group.port, passes_upgrade=False)
    try:
        page.goto(f"{proxy.address}p/ada/?tour=off&welcome=off#token={group.token_of('ada')}")
        page.locator("#connection[data-state=blocked]").wait_for()
        page.get_by_text("a proxy or filter in between does not pass WebSockets").first.wait_for()
    finally:
        proxy.end()
