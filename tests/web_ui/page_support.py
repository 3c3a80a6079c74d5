"""What tests in a browser do on the page, again and again."""

from __future__ import annotations

from typing import Any

import pytest

from tests.processes import wait_for_port

MARKS = [pytest.mark.browser, pytest.mark.process]


class Fingers:
    """Several fingers at once, by the developer protocol: a finger is a number, a place is in CSS pixels."""

    def __init__(self, page: Any) -> None:
        self._developer = page.context.new_cdp_session(page)
        self._down: dict[int, tuple[float, float]] = {}

    def put(self, **places: tuple[float, float]) -> None:
        """Put fingers down: a=(x, y), b=(x, y)."""
        for name, place in places.items():
            self._down[ord(name)] = place
            self._send("touchStart")

    def move(self, steps: int = 6, **places: tuple[float, float]) -> None:
        """Move fingers that are down, all together."""
        begin = {name: self._down[ord(name)] for name in places}
        for step in range(1, steps + 1):
            for name, (x, y) in places.items():
                from_x, from_y = begin[name]
                self._down[ord(name)] = (from_x + (x - from_x) * step / steps, from_y + (y - from_y) * step / steps)
            self._send("touchMove")

    def lift(self) -> None:
        """Take all fingers up."""
        self._down.clear()
        self._send("touchEnd")

    def _send(self, kind: str) -> None:
        points = [{"x": x, "y": y, "id": number} for number, (x, y) in self._down.items()]
        self._developer.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})


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
