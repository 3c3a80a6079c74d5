"""What tests in a browser do on the page, again and again."""

from __future__ import annotations

from typing import Any

import pytest

from tests.processes import wait_for_port

MARKS = [pytest.mark.browser, pytest.mark.process]


def open_page(page: Any, address: str) -> None:
    """Load the page, as soon as the suite answers, and wait for the robot."""
    wait_for_port(int(address.rsplit(":", 1)[1].strip("/")))
    page.goto(address)
    page.wait_for_function("window.thymio && window.thymio.connected && window.thymio.partPosition('robot')")


def wait_until_settled(page: Any, part: str) -> dict[str, float]:
    """Where a part of the robot is on the screen, once the view stands still."""
    page.wait_for_function("() => window.thymio.state().markers > 0")
    page.wait_for_function(
        "(part) => { const now = window.thymio.partPosition(part); const last = window.lastPosition;"
        " window.lastPosition = now;"
        " return now && last && Math.hypot(now.x - last.x, now.y - last.y) < 0.01; }",
        arg=part,
        polling=300,
    )
    place: dict[str, float] = page.evaluate("(part) => window.thymio.partPosition(part)", part)
    return place
