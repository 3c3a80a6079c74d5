"""What the view shows of the ground is what the ground sensors measure there: the edge of the tape is at its place."""

from __future__ import annotations

import io
import json
from collections.abc import Iterator
from typing import Any

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from PIL import Image

from tests.web_ui.page_support import MARKS, open_menu, open_page, wait_until_still
from tests.web_ui.tabs import checked_page
from thymio_sim_ros.sim.ground.sampling import Ground
from thymio_sim_ros.sim.playground import reader

pytestmark = MARKS

STRIPS = {"wide": (0.0, 0.04), "narrow": (0.1, 0.01), "slanted": (-0.12, 0.03)}
"""Place and width in meters of three strips of tape."""
HALF_M = 0.2
RISE = 0.1
"""Of the slanted strip; its width is measured across it, so its edges are half a percent farther from each other."""
PLACES = 40
TOLERANCE_M = 0.001


def playground() -> str:
    shapes = [{"kind": "rectangle", "name": "ground", "size_x_m": 0.6, "size_y_m": 0.5, "color": "#ffffff"}]
    for name, (y, width) in STRIPS.items():
        rise = RISE * HALF_M if name == "slanted" else 0.0
        points = [[-HALF_M, y - rise], [HALF_M, y + rise]]
        shapes.append({"kind": "track", "name": name, "points_m": points, "width_m": width, "color": "#000000"})
    robots = [{"name": "thymio", "x_m": -0.24, "y_m": 0.19, "yaw_rad": 1.5708}]
    return json.dumps({"format": 1, "title": "Strips", "shapes": shapes, "robots": robots})


@pytest.fixture
def page(browser) -> Iterator[Any]:
    """A page in full resolution, because its picture is compared."""
    yield from checked_page(browser, compares_pictures=True)


@pytest.mark.slow
def test_the_view_is_dark_exactly_where_the_sensors_measure_dark(world, page, tmp_path):
    path = tmp_path / "strips.json"
    path.write_text(playground())
    loaded = reader.load(path)
    ground = Ground(loaded.floors, loaded.paints)
    open_page(page, world(path))
    open_menu(page, "[data-view=look]")
    page.select_option("#quality", "medium")
    page.locator("#view").focus()
    page.keyboard.press("t")
    page.keyboard.press("b")
    wait_until_still(page, "window.thymio.screenPosition(0, 0, 0)")
    for _ in range(4):
        page.keyboard.press("+")
    wait_until_still(page, "window.thymio.screenPosition(0, 0, 0)")
    image = Image.open(io.BytesIO(page.screenshot())).convert("L")
    pixel_m = 0.1 / (seen_x(page, 0.1) - seen_x(page, 0.0))
    assert pixel_m < TOLERANCE_M, "near enough to see a millimeter"
    places = [
        (x, edge + side * (TOLERANCE_M + pixel_m))
        for x in (-0.06 + 0.003 * step for step in range(PLACES))
        for edge in edges(x)
        for side in (-1, 1)
    ]
    seen = page.evaluate("(places) => places.map(([x, y]) => window.thymio.screenPosition(x, y, 0))", places)
    dark = [image.getpixel((int(at["x"]), int(at["y"]))) < 128 for at in seen]
    measured = [sum(ground.color_at(x, y)) / 3 < 0.5 for x, y in places]
    assert measured.count(True) == len(places) / 2, "each edge has a dark side"
    assert dark == measured


def edges(x: float) -> list[float]:
    """The edges of all strips there."""
    middles = {name: y + (RISE * x if name == "slanted" else 0.0) for name, (y, _) in STRIPS.items()}
    return [middles[name] + side * width / 2 for name, (_, width) in STRIPS.items() for side in (-1, 1)]


def seen_x(page, x: float) -> float:
    return page.evaluate("(x) => window.thymio.screenPosition(x, 0, 0).x", x)
