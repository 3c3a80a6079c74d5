"""What tests in a browser do on the page, again and again."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

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


def drop_file(page: Any, path: Path, selector: str) -> None:
    """Drag a file from the desktop and let go of it over the middle of this."""
    box = page.locator(selector).bounding_box()
    place = {"x": box["x"] + box["width"] / 2, "y": box["y"] + box["height"] / 2}
    developer = page.context.new_cdp_session(page)
    for kind in ("dragEnter", "dragOver", "drop"):
        data = {"items": [], "files": [str(path)], "dragOperationsMask": 1}
        developer.send("Input.dispatchDragEvent", {"type": kind, "data": data} | place)


def without_tour(address: str) -> str:
    """The page's address for somebody who has seen the tour, as a teacher or a kiosk opens it."""
    return f"{address}{'&' if '?' in address else '?'}tour=off"


def open_page(page: Any, address: str) -> None:
    """Load the page, as soon as the suite answers, and wait for the robot and for what the simulator says of itself."""
    wait_for_port(urlsplit(address).port or 80)
    page.goto(without_tour(address))
    page.wait_for_function("window.thymio && window.thymio.connected && window.thymio.partPosition('robot')")
    page.wait_for_function("window.thymio.state().simulator !== null")


def wait_for_program(page: Any, name: str) -> None:
    """Wait until the robot runs the program of that name, whatever its folder."""
    page.wait_for_function(
        "(name) => { const {program} = window.thymio.state();"
        " return program?.state === 'running' && program.name.endsWith(name); }",
        arg=name,
    )


def wait_for_service(page: Any, *names: str) -> None:
    """Wait until the page knows that it can call these."""
    page.wait_for_function(
        "(names) => names.every((name) => window.thymio.state().services.includes(name))", arg=list(names)
    )


def wait_for_frame(page: Any) -> None:
    """Wait until one more frame is drawn: panels and view show what the page knows now."""
    frames = page.evaluate("() => window.thymio.frames()")
    page.wait_for_function("(frames) => window.thymio.frames() > frames", arg=frames)


def wait_until_still(page: Any, place: str) -> None:
    """Wait until an expression of the page gives the same place in several frames; without a frame nothing moves."""
    page.evaluate("() => { window.stood = null; }")
    page.wait_for_function(
        f"() => {{ const now = {place}; const frames = window.thymio.frames(); const {{stood}} = window;"
        " const still = now && stood && Math.hypot(now.x - stood.x, now.y - stood.y) < 0.01;"
        " if (!still) window.stood = now && {x: now.x, y: now.y, frames};"
        " return still && frames > stood.frames + 2; }",
        polling=200,
    )


def wait_until_settled(page: Any, part: str) -> dict[str, float]:
    """Where a part of the robot is on the screen, once the view stands still."""
    page.wait_for_function("() => window.thymio.state().markers > 0")
    wait_until_still(page, f"window.thymio.partPosition({json.dumps(part)})")
    place: dict[str, float] = page.evaluate("(part) => window.thymio.partPosition(part)", part)
    return place
