"""The scene on which simulators are compared: many robots in a walled square, boxes, lines on the ground, commands.

0.36 m² for each robot, a box for every second one, half of them movable, black lines on a gray ground. New targets
between -100 and 500 come from a generator that the driver of Enki has too.
"""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Iterator

from thymio_sim_ros.sim.playground import reader
from thymio_sim_ros.sim.playground.reader import Playground, RobotStart

CELL_M = 0.6
BOX_M = (0.08, 0.05, 0.1)
"""Length, width, height."""
BOX_KG = 0.1
"""Mass of every second box; the others stand fast."""


def side_m(robots: int) -> float:
    """The inner side of the square."""
    return math.ceil(math.sqrt(robots)) * CELL_M


def dense_scene(count: int) -> Playground:
    """So many robots; the square's corner is the origin."""
    side = side_m(count)
    columns = round(side / CELL_M)
    shapes: list[dict[str, object]] = [
        {
            "kind": "rectangle",
            "x_m": side / 2,
            "y_m": side / 2,
            "size_x_m": side,
            "size_y_m": side,
            "color": "#c0c0c0",
            "walls": {},
        }
    ]
    for row in range(columns):
        y = (row + 0.5) * CELL_M
        shapes.append(
            {"kind": "track", "points_m": [[0.05, y], [side - 0.05, y + 0.1]], "width_m": 0.04, "color": "#101010"}
        )
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
    return dataclasses.replace(reader.loads(json.dumps(data), f"{count} robots"), robots=tuple(robots))


def targets() -> Iterator[int]:
    """Targets of wheels, one after the other."""
    dice = 1
    while True:
        dice = (dice * 1664525 + 1013904223) % 2**32
        yield (dice >> 16) % 601 - 100
