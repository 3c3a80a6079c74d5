"""Fixtures of all browser tests: a real Chromium, the running suite, and pages that must not fail."""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.patience import PATIENCE_MS
from tests.processes import Process, free_port
from tests.web_ui.shared_world import SharedWorld
from tests.web_ui.tabs import Tabs, checked_page
from thymio_sim_ros.files import resources

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
FLAGS = [
    "--no-sandbox",
    "--enable-unsafe-swiftshader",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
]


@pytest.fixture(scope="package")
def browser() -> Iterator[Any]:
    """Chromium; a test is skipped where it, the page's build or Playwright is missing.

    It ends with the tests of this folder: Playwright leaves a running event loop in the thread, in which
    `asyncio.run` of later tests would fail.
    """
    api = pytest.importorskip("playwright.sync_api")
    if CHROMIUM is None:
        pytest.skip("no Chromium on this machine")
    if resources.page() is None:
        pytest.skip("the page is not built: make web")
    api.expect.set_options(timeout=PATIENCE_MS)
    with api.sync_playwright() as playing:
        browser = playing.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield browser
        browser.close()


class Suites:
    """The suites of one test, on embedded graphs unless `--ros` is given.

    A call with arguments starts one and returns the address of its page.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._running: list[Process] = []

    def __call__(self, *arguments: str, ports: tuple[int, int] | None = None) -> str:
        port, foxglove_port = ports or (free_port(), free_port())
        graph = () if "--ros" in arguments else ("--portable",)
        command = [*graph, "--port", str(port), "--foxglove-port", str(foxglove_port), *arguments]
        self._running.append(Process(self._folder, "thymio_sim_ros.cli.main", *command))
        return f"http://127.0.0.1:{port}/"

    def end(self) -> None:
        """End all running suites."""
        while self._running:
            self._running.pop().end()


@pytest.fixture
def suite(tmp_path) -> Iterator[Suites]:
    """Start a suite with arguments, and return the address of its page: for tests of how a suite starts or ends."""
    suites = Suites(tmp_path)
    yield suites
    suites.end()


@pytest.fixture(scope="package")
def _shared(browser, tmp_path_factory) -> Iterator[SharedWorld]:
    shared = SharedWorld(tmp_path_factory.mktemp("shared"))
    yield shared
    shared.end()


@pytest.fixture
def world(_shared) -> Iterator[SharedWorld]:
    """Restart the world of the shared suite with a playground and a program, and return the address of its page."""
    yield _shared
    _shared.rest()


@pytest.fixture
def at_rest(world) -> str:
    """The address of the page of a robot without a program in the playground "base"."""
    return world("base")


CLASS_NAMES = [f"thymio_{number}" for number in range(1, 21)]


@pytest.fixture(scope="package")
def class_world(tmp_path_factory) -> Path:
    """A playground with twenty robots."""
    shapes = [{"kind": "rectangle", "x_m": 1.0, "y_m": -0.75, "size_x_m": 3.0, "size_y_m": 2.5, "color": "#f3eee3"}]
    robots = [{"name": name, "x_m": at % 5 * 0.5, "y_m": -(at // 5) * 0.5} for at, name in enumerate(CLASS_NAMES)]
    world: Path = tmp_path_factory.mktemp("class") / "class.json"
    world.write_text(json.dumps({"format": 1, "title": "Class", "shapes": shapes, "robots": robots}))
    return world


@pytest.fixture(scope="package")
def _tabs(browser) -> Tabs:
    return Tabs(browser)


@pytest.fixture
def page(_tabs) -> Iterator[Any]:
    """A page that fails the test if a script on it fails or if it requests another host."""
    yield from _tabs.lend()


@pytest.fixture
def own_page(browser) -> Iterator[Any]:
    """Such a page with a browser profile of its own, for tests that change more of the browser than its storage."""
    yield from checked_page(browser)


@pytest.fixture
def other_page(browser) -> Iterator[Any]:
    """A second such page, for another user."""
    yield from checked_page(browser)


@pytest.fixture
def touch_page(_tabs) -> Iterator[Any]:
    """Such a page on a touch screen."""
    yield from _tabs.lend(has_touch=True)
