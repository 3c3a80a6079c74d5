"""Small pictures for tests: as bytes, as data URIs, as prints."""

from __future__ import annotations

import base64

from thymio_sim_ros.sim.formats.image_io import Pixels, encode_png
from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.model.primitives import Print

WHITE, BLACK, RED, CLEAR = (255, 255, 255, 255), (0, 0, 0, 255), (255, 0, 0, 255), (0, 0, 0, 0)

Rows = list[list[tuple[int, int, int, int]]]


def pixels(rows: Rows) -> Pixels:
    """Pixels from the colors of each row, the top one first."""
    return Pixels(len(rows[0]), len(rows), bytes(value for row in rows for color in row for value in color))


def png(rows: Rows) -> bytes:
    """A PNG file."""
    return encode_png(pixels(rows))


def png_uri(rows: Rows) -> str:
    """A PNG as a data URI."""
    return "data:image/png;base64," + base64.b64encode(png(rows)).decode()


def svg_uri(body: str, attributes: str = 'viewBox="0 0 100 50"') -> str:
    """An SVG as a data URI."""
    text = (
        f'<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" {attributes}>{body}</svg>'
    )
    return "data:image/svg+xml;base64," + base64.b64encode(text.encode()).decode()


def printed(rows: Rows, size_x_m: float, size_y_m: float, pose: Pose | None = None) -> Print:
    """A print of such pixels."""
    found = pixels(rows)
    return Print("print", pose or Pose(0.0, 0.0, 0.0), size_x_m, size_y_m, found.columns, found.rows, found.rgba)
