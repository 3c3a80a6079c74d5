"""Fixtures of all browser tests: a real Chromium, the running suite, and pages that must not fail."""

from __future__ import annotations

import contextlib
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.processes import Process, free_port
from thymio_sim_ros import resources

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
DEADLINE_MS = 60_000
FLAGS = [
    "--no-sandbox",
    "--enable-unsafe-swiftshader",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
]
LOCAL = ("http://127.0.0.1:", "ws://127.0.0.1:", "data:", "blob:")


@pytest.fixture(scope="session")
def browser() -> Iterator[Any]:
    """Chromium; a test is skipped where it, the page's build, Playwright or ROS is missing."""
    api = pytest.importorskip("playwright.sync_api")
    pytest.importorskip("rclpy")
    if CHROMIUM is None:
        pytest.skip("no Chromium on this machine")
    if resources.page() is None:
        pytest.skip("the page is not built: make web")
    api.expect.set_options(timeout=DEADLINE_MS)
    with api.sync_playwright() as playing:
        browser = playing.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield browser
        browser.close()


class Suites:
    """The suites of one test. A call with arguments starts one and returns the address of its page."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._running: list[Process] = []

    def __call__(self, *arguments: str, ports: tuple[int, int] | None = None) -> str:
        port, foxglove_port = ports or (free_port(), free_port())
        command = ["--port", str(port), "--foxglove-port", str(foxglove_port), *arguments]
        self._running.append(Process(self._folder, "thymio_sim_ros.cli.main", *command))
        return f"http://127.0.0.1:{port}/"

    def end(self) -> None:
        """End all running suites."""
        while self._running:
            self._running.pop().end()


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Run the tests that share a suite one after another, so that it is started once."""
    ours = [at for at, item in enumerate(items) if Path(__file__).parent in item.path.parents]
    tests = [items[at] for at in ours]
    tests.sort(key=lambda item: "at_rest" not in getattr(item, "fixturenames", ()))  # otherwise in their order
    for at, item in zip(ours, tests, strict=True):
        items[at] = item


class SharedSuite:
    """One suite for many tests: a robot without a program that stands in the playground "base"."""

    ARGUMENTS = ("--playground", "base", "--program", "none")
    UNCHANGED = """() => {
        const {simulator, robot, program} = window.thymio?.connected ? window.thymio.state() : {};
        if (!simulator || !robot?.latest) return true;
        const {x, y} = robot.latest.pose;
        return simulator.playground === "base" && !simulator.paused && !program?.name && Math.hypot(x, y) < 0.001;
    }"""

    def __init__(self, folder: Path) -> None:
        self._suites = Suites(folder)
        self._resources = contextlib.ExitStack()
        self._address: str | None = None

    def start(self) -> str:
        """The address of its page; it is started if it does not run."""
        if self._address is None:
            from thymio_sim_ros.testing.ros.domain import reserved

            self._resources.enter_context(reserved())
            self._resources.callback(self._suites.end)
            self._address = self._suites(*self.ARGUMENTS)
        return self._address

    def end(self) -> None:
        """End it if it runs."""
        self._address = None
        self._resources.close()


@pytest.fixture(scope="session")
def _shared(tmp_path_factory) -> Iterator[SharedSuite]:
    shared = SharedSuite(tmp_path_factory.mktemp("shared"))
    yield shared
    shared.end()


@pytest.fixture
def at_rest(_shared, page) -> Iterator[str]:
    """The address of a suite with a robot at rest, shared by all tests that leave it as it is: starts take long."""
    yield _shared.start()
    if not page.evaluate(SharedSuite.UNCHANGED):
        _shared.end()
        pytest.fail("this test has changed the shared suite: it needs a suite of its own (suite)")


@pytest.fixture
def _alone(_shared) -> None:
    """One suite at a time: two processors are enough for no more."""
    _shared.end()


@pytest.fixture
def suite(_alone, ros_domain, tmp_path) -> Iterator[Suites]:
    """Start a suite with arguments; returns the address of its page."""
    suites = Suites(tmp_path)
    yield suites
    suites.end()


@pytest.fixture
def page(browser) -> Iterator[Any]:
    """A page that fails the test if a script on it fails or if it requests another host."""
    yield from checked_page(browser)


@pytest.fixture
def other_page(browser) -> Iterator[Any]:
    """A second such page, for another user."""
    yield from checked_page(browser)


def checked_page(browser: Any, **options: Any) -> Iterator[Any]:
    """A page with its own browser profile; asserts at the end that there were no problems."""
    options = {"viewport": {"width": 1024, "height": 768}, "bypass_csp": True} | options  # waiting evaluates
    page = browser.new_page(**options)
    page.set_default_timeout(DEADLINE_MS)
    problems: list[str] = []
    page.on("pageerror", lambda error: problems.append(f"script: {error}"))
    page.on("request", lambda request: problems.append(request.url) if not request.url.startswith(LOCAL) else None)
    yield page
    page.close()
    assert not problems
