"""Playgrounds for measurements. This module works with the packages of other checkouts, too.

The dense scene has 0.36 m² for each robot, a box for every second one, half of them movable, and black lines on a gray
ground. New targets between -100 and 500 come from a generator that the driver of Enki has, too.
"""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Iterator
from typing import Any

try:
    from thymio_sim_ros.sim.playground.reader import Playground, RobotStart, loads
except ImportError:  # 713c77a
    from thymio_sim_ros.sim.playground import Playground, RobotStart, loads

CELL_M = 0.6
BOX_M = (0.08, 0.05, 0.1)
"""Length, width, height."""
BOX_KG = 0.1
"""Mass of every second box; the others stand fast."""


def side_m(robots: int) -> float:
    """Return the inner side of the square of the dense scene."""
    return math.ceil(math.sqrt(robots)) * CELL_M


def dense_scene(count: int) -> Playground:
    """Return the scene with so many robots; the square's corner is the origin."""
    side = side_m(count)
    columns = round(side / CELL_M)
    place = {"x_m": side / 2, "y_m": side / 2}
    size = {"size_x_m": side, "size_y_m": side}
    shapes: list[dict[str, Any]] = [{"kind": "rectangle", **place, **size, "color": "#c0c0c0", "walls": {}}]
    for row in range(columns):
        y = (row + 0.5) * CELL_M
        points = [[0.05, y], [side - 0.05, y + 0.1]]
        shapes.append({"kind": "track", "points_m": points, "width_m": 0.04, "color": "#101010"})
    robots = []
    for index in range(count):
        x, y = (index % columns + 0.5) * CELL_M, (index // columns + 0.5) * CELL_M
        robots.append(RobotStart(f"thymio_{index}", x, y, index % 6))
        if index % 2 == 0:
            place = {"x_m": x + 0.22, "y_m": y + 0.22}
            size = dict(zip(("size_x_m", "size_y_m", "height_m"), BOX_M, strict=True))
            mass = {"mass_kg": BOX_KG} if index % 4 == 0 else {}
            shapes.append({"kind": "box", "color": "#9fa3bd", **place, **size, **mass})
    data = {"format": 1, "title": "dense scene", "shapes": shapes, "robots": []}
    # The number of robots in a file is limited.
    return dataclasses.replace(loads(json.dumps(data), f"{count} robots"), robots=tuple(robots))


def targets() -> Iterator[int]:
    """Yield targets of wheels without an end."""
    dice = 1
    while True:
        dice = (dice * 1664525 + 1013904223) % 2**32
        yield (dice >> 16) % 601 - 100


def grid(robots: int, gap_m: float, *, prefix: str = "r", walls: bool = False) -> str:
    """Return a playground file with robots in rows, `gap_m` apart, on a square floor around the origin."""
    columns = math.ceil(math.sqrt(robots))
    size_m = columns * gap_m + 1.0
    floor: dict[str, Any] = {"kind": "rectangle", "size_x_m": size_m, "size_y_m": size_m, "color": "#ffffff"}
    if walls:
        floor["walls"] = {"height_m": 0.1, "thickness_m": 0.02, "color": "#5c6b73"}
    middle = (columns - 1) / 2
    starts = [
        {"name": f"{prefix}{n}", "x_m": (n % columns - middle) * gap_m, "y_m": (n // columns - middle) * gap_m}
        for n in range(robots)
    ]
    return json.dumps({"format": 1, "title": "Robots in rows", "shapes": [floor], "robots": starts})
