"""A real Chromium, the running suite, and pages that must not fail: fixtures of all tests in a browser."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
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
    with api.sync_playwright() as playing:
        browser = playing.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield browser
        browser.close()


@pytest.fixture
def suite(ros_domain, tmp_path) -> Iterator[Callable[..., str]]:
    """Start the suite with these arguments; gives the page's address."""
    started: list[Process] = []

    def start(*arguments: str) -> str:
        port = free_port()
        command = ["--port", str(port), "--foxglove-port", str(free_port()), *arguments]
        started.append(Process(tmp_path, "thymio_sim_ros.cli", *command))
        return f"http://127.0.0.1:{port}/"

    yield start
    for process in started:
        process.end()


@pytest.fixture
def page(browser) -> Iterator[Any]:
    """A page that fails the test when a script on it fails or it asks another host."""
    page = browser.new_page(viewport={"width": 800, "height": 600}, bypass_csp=True)  # wait_for_function evaluates
    page.set_default_timeout(DEADLINE_MS)
    problems: list[str] = []
    page.on("pageerror", lambda error: problems.append(f"script: {error}"))
    page.on("request", lambda request: problems.append(request.url) if not request.url.startswith(LOCAL) else None)
    yield page
    page.close()
    assert not problems
