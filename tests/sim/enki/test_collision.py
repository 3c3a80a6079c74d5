"""Where robots and things rest after they have met walls, things and each other, as in the reference."""

from __future__ import annotations

import math

import pytest

from tests.sim.enki.scenes import Scene, mean_rows, play

RUNS = 6
TOLERANCE_M = 0.003
TOLERANCE_RAD = 0.005
PART_OF_WAY = 0.04
"""A kick, and with it the way after it, hangs on the place of contact: the reference finds one, we find two."""


@pytest.mark.enki("collision")
def test_robots_and_objects_rest_where_measured(scene: Scene) -> None:
    """Robots within 3 mm, objects within 3 mm and a twenty-fifth of the way that they went; both plus what noise adds.

    That is three standard errors of both means.
    """
    found = mean_rows(play(scene, runs=RUNS))[-1]
    first, expected, std = scene["mean"][0], scene["mean"][-1], scene["std"][-1]
    spread = math.sqrt(1 / scene["runs"] + 1 / RUNS)
    robots = 3 * len(scene["robots"])
    for index in range(robots):
        tolerance = TOLERANCE_RAD if index % 3 == 2 else TOLERANCE_M
        assert found[index] == pytest.approx(expected[index], abs=tolerance + 3 * spread * std[index]), index
    for index in range(robots, len(found), 3):
        way_m = math.dist(first[index : index + 2], expected[index : index + 2])
        error_m = 3 * spread * math.hypot(*std[index : index + 2])
        away_m = math.dist(found[index : index + 2], expected[index : index + 2])
        assert away_m < TOLERANCE_M + PART_OF_WAY * way_m + error_m, index
