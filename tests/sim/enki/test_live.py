"""Readings recorded from a running playground of the reference."""

from __future__ import annotations

import pytest

from tests.sim.builders import FLOOR, box, make, measure_one
from tests.sim.enki.scenes import Scene
from thymio_sim_ros.sim.world import World

INNER = (1, 2, 3, 5, 6)
OUTER = (0, 4)


@pytest.mark.enki("playground-live")
def test_sensors_read_as_in_the_running_playground(scene: Scene) -> None:
    """The outermost rays graze the ends of the wall, on one side or the other: the smaller count is compared."""
    color = "#" + f"{scene['grey8']:02x}" * 3
    wall = box(0.0795 + scene["distance"] + 0.01, 0.0, 0.02, 0.2)
    world = World(make([{**FLOOR, "color": color}, wall]), noise=False, proximity_model="enki")
    counts, expected = measure_one(world, "proximity").words, scene["prox_mean"]
    assert [counts[index] for index in INNER] == pytest.approx([expected[index] for index in INNER], abs=3)
    assert counts[0] == pytest.approx(min(expected[index] for index in OUTER), abs=3)
    ground = measure_one(world, "ground").words[2:4]
    assert ground == pytest.approx(scene["ground_reflected_mean"], abs=3)
