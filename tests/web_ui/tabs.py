"""Pages of browser tests: each fails its test if a script on it fails or if it requests another host."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from tests.patience import PATIENCE_MS

LOCAL = (*(f"{scheme}://127.0.0.1:" for scheme in ("http", "ws", "https", "wss")), "data:", "blob:")
SIZE = {"width": 1024, "height": 768}
SLOW_DISPLAY = """(() => {
    const FRAME_MS = 50;
    const request = window.requestAnimationFrame.bind(window);
    const waiting = new Map();
    window.requestAnimationFrame = (callback) => {
        const timer = setTimeout(() => waiting.set(timer, request((now) => {
            waiting.delete(timer);
            callback(now);
        })), FRAME_MS - 20);
        return timer;
    };
    const cancel = window.cancelAnimationFrame.bind(window);
    window.cancelAnimationFrame = (timer) => {
        clearTimeout(timer);
        cancel(waiting.get(timer) ?? 0);
        waiting.delete(timer);
    };
})()"""
"""Twenty frames a second are enough: drawing is what most of the processor time of a page goes to."""
USUAL_MEDIA = {"media": "null", "color_scheme": "light", "reduced_motion": "no-preference", "forced_colors": "none"}
MODIFIERS = ("Shift", "Control", "Alt", "Meta")


def new_page(browser: Any, *, compares_pictures: bool = False, **options: Any) -> Any:
    """A page with its own browser profile.

    A pixel covers two by two of CSS and there are twenty frames a second, because the 3D view is drawn by software
    here; not so for tests that compare pictures.
    """
    scale = 1 if compares_pictures else 0.5
    usual = {"viewport": SIZE, "device_scale_factor": scale, "service_workers": "block", "bypass_csp": True}
    page = browser.new_context(**usual | options).new_page()  # bypass_csp: waiting evaluates
    page.set_default_timeout(PATIENCE_MS)
    if not compares_pictures:
        page.context.add_init_script(SLOW_DISPLAY)
    return page


def problems_of(page: Any) -> list[str]:
    """The list of problems that this page has from now on: errors of scripts, requests of other hosts."""
    problems: list[str] = []
    page.on("pageerror", lambda error: problems.append(f"script: {error}"))
    page.on("request", lambda request: problems.append(request.url) if not request.url.startswith(LOCAL) else None)
    return problems


def origins_of(page: Any) -> set[str]:
    """The set of the origins of documents that this page has from now on."""
    origins: set[str] = set()

    def add(frame: Any) -> None:
        if frame.url.startswith("http"):
            origins.add("/".join(frame.url.split("/")[:3]))

    page.on("framenavigated", add)
    return origins


def checked_page(browser: Any, **how: Any) -> Iterator[Any]:
    """A page of `new_page`; asserts at the end that there were no problems."""
    page = new_page(browser, **how)
    problems = problems_of(page)
    yield page
    page.context.close()
    assert not problems


class Tabs:
    """Pages that tests use one after another, which takes half of the processor time of a new page for each.

    A test gets its page with empty storage and with the options of the first test. What cannot be removed, as a script
    of the browser, needs a page of its own.
    """

    def __init__(self, browser: Any) -> None:
        self._browser = browser
        self._tabs: dict[str, tuple[Any, Any, list[str], set[str]]] = {}
        """Page, its developer session, its problems, and the origins of its documents, by options."""

    def lend(self, **options: Any) -> Iterator[Any]:
        """A page with these options of its profile; asserts at the end that there were no problems."""
        name = repr(options)
        if name not in self._tabs:
            page = new_page(self._browser, **options)
            self._tabs[name] = page, page.context.new_cdp_session(page), problems_of(page), origins_of(page)
            page.add_init_script = page.on = page.expose_function = _refuse
        page, developer, problems, origins = self._tabs[name]
        yield page
        found = list(problems)
        if page.is_closed():
            del self._tabs[name]
        else:
            _clear(page, developer, origins)
        problems.clear()
        assert not found


def _refuse(*_: Any) -> None:
    pytest.fail("this would stay for all later tests: take a page of its own (fixture own_page)")


def _clear(page: Any, developer: Any, origins: set[str]) -> None:
    """Leave nothing of a test."""
    for other in page.context.pages:
        if other is not page:
            other.close()
    page.mouse.up()
    for key in MODIFIERS:
        page.keyboard.up(key)
    page.unroute_all()
    page.context.clear_permissions()
    page.emulate_media(**USUAL_MEDIA)
    page.set_viewport_size(SIZE)
    if page.url.startswith("http"):
        page.evaluate("() => sessionStorage.clear()")
    page.goto("about:blank")
    while origins:
        developer.send("Storage.clearDataForOrigin", {"origin": origins.pop(), "storageTypes": "all"})
