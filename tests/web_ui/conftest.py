"""Fixtures of all browser tests: a real Chromium, the running suite, and pages that must not fail."""

from __future__ import annotations

import contextlib
import json
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.patience import PATIENCE_MS
from tests.processes import Process, free_port
from thymio_sim_ros import resources

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
DEADLINE_MS = PATIENCE_MS
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


SHARED = ("at_rest", "exploring", "greeting", "twenty_robots")
"""Fixtures with a suite that is shared by tests, which leave it as it is."""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Run the tests that share a suite one after another, so that it is started once; the others in their order."""

    def turn(item: pytest.Item) -> int:
        names = getattr(item, "fixturenames", ())
        return next((at for at, name in enumerate(SHARED) if name in names), len(SHARED))

    ours = [at for at, item in enumerate(items) if Path(__file__).parent in item.path.parents]
    for at, item in zip(ours, sorted((items[at] for at in ours), key=turn), strict=True):
        items[at] = item


class SharedSuite:
    """A suite for many tests that do not change it; one at a time, and none beside the suite of a test."""

    UNCHANGED = """([playground, program]) => {
        if (!window.thymio?.connected || window.thymio.state().simulator === null) return true;
        const {simulator, programs} = window.thymio.state();
        const isSame = ({name, state}) => name.split(".")[0] === program && !["stopped", "paused"].includes(state);
        return simulator.playground === playground && !simulator.paused && Object.values(programs).every(isSame);
    }"""

    def __init__(self, folder: Path) -> None:
        self._suites = Suites(folder)
        self._resources = contextlib.ExitStack()
        self._world: tuple[str, str] | None = None
        self._address = ""

    def start(self, playground: str, program: str) -> str:
        """The address of its page; it is started unless it runs."""
        if self._world != (playground, program):
            from thymio_sim_ros.testing.ros.domain import reserved

            self.end()
            self._resources.enter_context(reserved())
            self._resources.callback(self._suites.end)
            self._address = self._suites("--playground", playground, "--program", program)
            self._world = playground, program
        return self._address

    def check(self, page: Any) -> None:
        """Fail, and start anew for the next test, if the world of this page has changed."""
        assert self._world is not None
        playground, program = self._world
        if page.evaluate(self.UNCHANGED, [Path(playground).stem, program]):
            return
        self.end()
        pytest.fail("this test has changed what it shares with others: it needs a suite of its own (fixture suite)")

    def end(self) -> None:
        """End it if it runs."""
        self._world = None
        self._resources.close()


@pytest.fixture(scope="session")
def _shared(tmp_path_factory) -> Iterator[SharedSuite]:
    shared = SharedSuite(tmp_path_factory.mktemp("shared"))
    yield shared
    shared.end()


@pytest.fixture
def at_rest(_shared, page) -> Iterator[str]:
    """The address of a shared suite: a robot without a program in the playground "base"."""
    yield _shared.start("base", "none")
    _shared.check(page)


@pytest.fixture
def exploring(_shared, page) -> Iterator[str]:
    """The address of a shared suite: a robot that drives about in the playground "base"."""
    yield _shared.start("base", "explorer")
    _shared.check(page)


@pytest.fixture
def greeting(_shared, page) -> Iterator[str]:
    """The address of a shared suite: a robot that waits for a first visitor."""
    yield _shared.start("line", "welcome")
    _shared.check(page)


CLASS_NAMES = [f"thymio_{number}" for number in range(1, 21)]


@pytest.fixture(scope="session")
def class_world(tmp_path_factory) -> Path:
    """A playground with twenty robots."""
    shapes = [{"kind": "rectangle", "x_m": 1.0, "y_m": -0.75, "size_x_m": 3.0, "size_y_m": 2.5, "color": "#f3eee3"}]
    robots = [{"name": name, "x_m": at % 5 * 0.5, "y_m": -(at // 5) * 0.5} for at, name in enumerate(CLASS_NAMES)]
    world: Path = tmp_path_factory.mktemp("class") / "class.json"
    world.write_text(json.dumps({"format": 1, "title": "Class", "shapes": shapes, "robots": robots}))
    return world


@pytest.fixture
def twenty_robots(_shared, page, class_world) -> Iterator[str]:
    """The address of a shared suite: twenty robots that wait."""
    yield _shared.start(str(class_world), "welcome")
    _shared.check(page)


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
    """A page with its own browser profile; asserts at the end that there were no problems.

    A pixel covers two by two of CSS, because the 3D view is drawn by software here; tests that compare pictures need
    `device_scale_factor=1`.
    """
    size = {"viewport": {"width": 1024, "height": 768}, "device_scale_factor": 0.5}
    options = size | {"bypass_csp": True} | options  # waiting evaluates
    page = browser.new_page(**options)
    page.set_default_timeout(DEADLINE_MS)
    problems: list[str] = []
    page.on("pageerror", lambda error: problems.append(f"script: {error}"))
    page.on("request", lambda request: problems.append(request.url) if not request.url.startswith(LOCAL) else None)
    yield page
    page.close()
    assert not problems
