"""Access: valid, missing, wrong and read-only tokens; and the content security policy."""

from __future__ import annotations

import pytest

from tests.processes import wait_for_port
from tests.web_ui.page_support import MARKS, open_page, open_tab
from thymio_sim_ros.files import resources
from thymio_sim_ros.web import Content, ServerThread, Settings

pytestmark = MARKS

TOKENS = ("--address", "0.0.0.0", "--token", "fulltoken", "--read-only-token", "looktoken")


def connection(page, address, state):
    """Open the page at an address and wait for a connection state."""
    page.goto(address)
    page.wait_for_function("(state) => window.thymio?.state().connection === state", arg=state)


@pytest.mark.slow
def test_the_token_in_the_address_gives_control_and_survives_a_reload(suite, page):
    address = suite(*TOKENS)
    wait_for_port(int(address.rsplit(":", 1)[1].strip("/")))
    page.goto(f"{address}#token=fulltoken")
    page.wait_for_function("window.thymio?.connected")
    assert page.evaluate("location.href") == address
    open_page(page, address)
    page.locator("#pause").click()
    page.wait_for_function("window.thymio.state().simulator.paused")
    assert page.evaluate("window.thymio.state().notices") == []


@pytest.mark.slow
@pytest.mark.parametrize(("rest", "state"), [("", "noToken"), ("#token=wrongtoken", "wrongToken")])
def test_without_a_valid_token_the_page_explains_what_to_do(suite, page, rest, state):
    address = suite(*TOKENS)
    wait_for_port(int(address.rsplit(":", 1)[1].strip("/")))
    connection(page, address + rest, state)
    page.locator(".banner", has_text="terminal").wait_for()
    # A token that is put into the bar later does not need a reload by hand.
    page.evaluate("location.hash = '#token=fulltoken'")
    page.wait_for_function("window.thymio?.connected")


def test_with_the_read_only_token_the_page_only_watches(suite, page):
    address = suite(*TOKENS)
    wait_for_port(int(address.rsplit(":", 1)[1].strip("/")))
    page.goto(f"{address}?tour=off&welcome=off#token=looktoken")
    page.wait_for_function("window.thymio?.state().readOnly && window.thymio.state().simulator !== null")
    page.locator("#read-only").wait_for()
    for tab, controls in (
        ("program", "#time button, #time select, .pad button, .stop, .program-head > [data-verb], .example"),
        ("playground", ".sample, #playground-change, #panel-playground .file button"),
    ):
        open_tab(page, tab)
        page.wait_for_function(
            "(controls) => [...document.querySelectorAll(controls)].every((control) => control.disabled)", arg=controls
        )
    assert page.locator(".stop").get_attribute("title") == page.locator("#read-only").get_attribute("title")
    before = page.evaluate("window.thymio.state().timeNs")
    page.keyboard.press("Escape")  # would stop everything
    page.wait_for_function("window.thymio.state().notices.some(({technical}) => technical.includes('read-only'))")
    page.wait_for_function("(before) => window.thymio.state().timeNs > before", arg=before)
    assert page.evaluate("window.thymio.state().program.state") == "running"


@pytest.fixture
def page_server():
    """The server of the built page, without a simulator."""
    folder = resources.page()
    server = ServerThread(warn=print)
    server.mount_page(Content(folder, b"{}"), Settings())
    yield server.listen("localhost", 0)[1]
    server.close()


@pytest.mark.slow
@pytest.mark.parametrize("host", ["127.0.0.1", "localhost", "[::1]"])
def test_nothing_violates_the_content_security_policy(browser, page_server, host):
    page = browser.new_page()
    page.add_init_script(
        "window.broken = []; addEventListener('securitypolicyviolation', (e) => broken.push(e.blockedURI))"
    )
    page.goto(f"http://{host}:{page_server}/")
    page.locator("#connection[data-state=lost]").wait_for()  # the socket was tried; a predicate would need eval
    page.locator("#tab-program").click()
    page.locator(".cm-editor").wait_for()
    page.locator("#file-menu").click()
    page.locator("#file-sheet [data-verb=new]").click()
    page.locator("[data-new=blocks-avoid]").click()
    page.locator(".blocklyBlockCanvas .thymio_led").wait_for()
    page.locator("#tab-playground").click()
    page.locator(".current [data-new]").click()
    page.locator("#creator-try").wait_for()
    assert page.evaluate("broken") == []
    page.close()


@pytest.mark.slow
def test_the_page_cannot_be_embedded(browser, page_server):
    page = browser.new_page()
    page.goto(f"data:text/html,<iframe src='http://127.0.0.1:{page_server}/'></iframe>")
    (frame,) = page.main_frame.child_frames
    assert frame.url.startswith("chrome-error:")
    page.close()
