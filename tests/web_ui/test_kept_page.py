"""The page that a browser keeps: without its server, and with a newer one."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from tests.processes import free_port, wait_for_port
from tests.web_ui.page_support import MARKS, open_page
from tests.web_ui.tabs import checked_page

pytestmark = MARKS

KEPT = """async () => {
    const found = [];
    for (const name of await caches.keys())
        for (const { url } of await (await caches.open(name)).keys()) found.push(url);
    return found;
}"""


@pytest.fixture
def keeping_page(browser) -> Iterator[Any]:
    """A page whose service worker runs."""
    yield from checked_page(browser, service_workers="allow")


def test_a_page_whose_server_is_away_opens_and_connects_when_it_is_back(suite, keeping_page):
    page, ports = keeping_page, (free_port(), free_port())
    arguments = ("--playground", "base", "--program", "none")
    address = suite(*arguments, ports=ports)
    open_page(page, address)
    page.evaluate("navigator.serviceWorker.ready.then(() => true)")
    scripts = page.evaluate("performance.getEntriesByType('resource').map(({name}) => name)")
    needed = {address, *(name for name in scripts if name.endswith((".js", ".css")))}
    assert len(needed) > 3
    page.wait_for_function(
        f"async (needed) => {{ const kept = await ({KEPT})(); return needed.every((url) => kept.includes(url)); }}",
        arg=list(needed),
    )
    suite.end()
    page.goto(f"{address}?token=secret")
    banner = page.locator(".banner:not([hidden])")
    playwright.expect(banner).to_contain_text("tries again every second")
    suite(*arguments, ports=ports)
    wait_for_port(ports[1])
    page.wait_for_function("() => window.thymio?.connected")
    playwright.expect(banner).to_have_count(0)
    page.goto(f"{address}?token=secret")
    page.wait_for_function("() => window.thymio?.connected")
    assert not [url for url in page.evaluate(KEPT) if "token" in url]


def test_a_page_that_is_older_than_its_server_says_so_and_reloads(suite, own_page):
    ports = (free_port(), free_port())
    arguments = ("--playground", "base", "--program", "none")
    address = suite(*arguments, ports=ports)
    open_page(own_page, address)
    suite.end()
    own_page.wait_for_function("() => !window.thymio?.connected")
    older = own_page.evaluate("document.querySelector('script[type=module]').getAttribute('src')")
    own_page.route(address, lambda route: newer(route, older))
    suite(*arguments, ports=ports)
    banner = own_page.locator(".banner:not([hidden])")
    playwright.expect(banner).to_contain_text("newer version")
    own_page.unroute_all()
    banner.get_by_role("button", name="Reload").click()
    own_page.wait_for_function("() => window.thymio?.connected")
    playwright.expect(banner).to_have_count(0)


def newer(route: Any, older: str) -> None:
    """Answer with the page of another build."""
    answer = route.fetch()
    route.fulfill(response=answer, body=answer.text().replace(older, "./assets/index-newer123.js"))
