"""Ground sensors read what the reference reads."""

from __future__ import annotations

from typing import Any

import pytest

from tests.sim.enki.scenes import Scene
from thymio_sim_ros.sim.ground.sampling import Ground
from thymio_sim_ros.sim.model import robot_constants
from thymio_sim_ros.sim.model.geometry import Point, Pose
from thymio_sim_ros.sim.model.primitives import Floor, Paint
from thymio_sim_ros.sim.sensors.ground import response


@pytest.mark.enki("ground")
def test_a_ground_reads_as_measured(scene: Scene) -> None:
    ground = ground_of(scene)
    start = scene["robots"][0]
    pose = Pose(start["x"], start["y"], start["theta"])
    places = [pose.place(place) for place in robot_constants.GROUND_SENSORS]
    samples = [ground.sample(*place) for place in places]
    counts = [response(sample.reflectance, sample.floor) for sample in samples]
    assert counts == pytest.approx(scene["noiseless"], abs=2)


def ground_of(scene: Scene) -> Ground:
    """The ground of a scene; the pattern of family `tiles` stands in the file's `meta`."""
    width, height = scene["world"]["width"], scene["world"]["height"]
    pattern = scene.get("ground") or scene["meta"]["tiles"]
    match pattern:
        case {"kind": "uniform", "grey8": gray}:
            return Ground([_floor(gray, 0.0, 0.0, width, height)], [])
        case {"kind": "half_plane", "along": along, "edge": edge, "below": below, "above": above}:
            right, top = (edge, height) if along == "x" else (width, edge)
            left, bottom = (edge, 0.0) if along == "x" else (0.0, edge)
            return Ground([_floor(below, 0.0, 0.0, right, top), _floor(above, left, bottom, width, height)], [])
        case {"kind": "stripe", "centre_y": center, "width": wide, "stripe": stripe, "outside": outside}:
            half = wide / 2 - 1e-9  # a texel whose middle lies on the border does not belong to the stripe
            paint = Paint("stripe", _area(0.0, center - half, width, center + half), (stripe / 255,) * 3)
            return Ground([_floor(outside, 0.0, 0.0, width, height)], [paint])
        case {"kind": "tiles", "tile": size, "rows_from_y0": rows}:
            return Ground(_tiles(size, rows), [])
    raise AssertionError(pattern)


def _tiles(size: float, rows: list[list[Any]]) -> list[Floor]:
    return [
        _floor(gray, column * size, row * size, (column + 1) * size, (row + 1) * size)
        for row, grays in enumerate(rows)
        for column, gray in enumerate(grays)
    ]


def _area(left: float, bottom: float, right: float, top: float) -> tuple[Point, ...]:
    return ((left, bottom), (right, bottom), (right, top), (left, top))


def _floor(grey8: float, left: float, bottom: float, right: float, top: float) -> Floor:
    return Floor("floor", _area(left, bottom, right, top), (grey8 / 255,) * 3)
