"""Robots drive as in the reference: every recorded place, not only the last."""

from __future__ import annotations

import math

import pytest

from tests.sim.enki.scenes import Scene, mean_rows, play
from thymio_sim_ros.sim.model.units import units_to_speed

RUNS = 8
ROUNDED = 1e-5
"""What the recorded numbers are rounded to."""


@pytest.mark.enki("motion")
def test_a_robot_drives_as_measured(scene: Scene) -> None:
    """Places within 0.2 % of the way so far, headings within 0.5 % of the turn, and what the noise leaves open."""
    rows = mean_rows(play(scene, runs=RUNS))
    way_m = turn_rad = 0.0
    spread = math.sqrt(1 / scene["runs"] + 1 / RUNS)
    for number, (found, expected, std) in enumerate(zip(rows, scene["mean"], scene["std"], strict=True)):
        left, right = _targets(scene, number * scene["every"])
        seconds = scene["every"] * scene["dt"]
        way_m += max(abs(left), abs(right)) * seconds
        turn_rad += abs(right - left) / 0.094 * seconds
        for axis in (0, 1):
            assert found[axis] == pytest.approx(
                expected[axis], abs=0.002 * way_m + 3 * spread * std[axis] + 2 * ROUNDED
            ), number
        assert found[2] == pytest.approx(expected[2], abs=0.005 * turn_rad + 3 * spread * std[2] + 2 * ROUNDED), number


def _targets(scene: Scene, step: int) -> tuple[float, float]:
    """Wheel speeds that are in force before a step, in m/s."""
    given = [command for command in scene["commands"] if command["step"] <= step]
    if not given:
        return 0.0, 0.0
    return _limited(given[-1]["left_target"]), _limited(given[-1]["right_target"])


def _limited(target: int) -> float:
    return units_to_speed(max(-500, min(500, target)))
