"""An operator says what proximity and ground sensors count."""

from __future__ import annotations

import math

import pytest

from tests.sim.builders import FLOOR, ROBOT, make, measure_one, post_wall, send
from thymio_sim_ros.sim.commands import SetAmbientLight, SetGround, SetProximity
from thymio_sim_ros.sim.model.units import proximity_distance
from thymio_sim_ros.sim.world import World


@pytest.fixture
def world() -> World:
    """A robot before a wall."""
    return World(make([FLOOR, post_wall(0.05)], [ROBOT]), noise=False)


def test_a_covered_sensor_counts_what_the_hand_says_and_the_others_see(world: World) -> None:
    seen = measure_one(world, "proximity").words
    send(world, SetProximity((1500, -1, 0, -1, -1, -1, 4505)))
    reading = measure_one(world, "proximity")
    assert reading.words == (1500, seen[1], 0, seen[3], seen[4], seen[5], 4505)
    assert reading.ranges_m[0] == proximity_distance(1500)
    assert (reading.ranges_m[2], reading.ranges_m[6]) == (math.inf, 0.0)
    send(world, SetProximity((-1,) * 7))
    assert measure_one(world, "proximity").words == seen


def test_an_override_counts_without_any_obstacle() -> None:
    world = World(make([FLOOR], [ROBOT]))
    send(world, SetProximity((-1, -1, 3000, -1, -1, -1, -1)))
    assert measure_one(world, "proximity").words == (0, 0, 3000, 0, 0, 0, 0)


def test_a_ground_sensor_over_a_hand_counts_what_it_says(world: World) -> None:
    send(world, SetGround((77, -1)))
    reading = measure_one(world, "ground")
    assert reading.words == (0, 0, 77, 938, 77, 938)
    assert reading.reflectances == pytest.approx((0.0, 1.0), abs=0.01)
    send(world, SetAmbientLight(100))
    assert measure_one(world, "ground").words == (100, 100, 177, 1023, 77, 923)


@pytest.mark.parametrize("count", [60, 77, 500, 938, 944, 1023])
def test_the_grey_that_goes_with_a_count_of_the_hand_is_one(world: World, count: int) -> None:
    send(world, SetGround((count, count)))
    assert 0.0 <= measure_one(world, "ground").reflectances[0] <= 1.0


def test_a_reset_takes_the_hand_away(world: World) -> None:
    seen = measure_one(world, "proximity").words
    send(world, SetProximity((0,) * 7))
    assert measure_one(world, "proximity").words == (0,) * 7
    world.reset()
    assert measure_one(world, "proximity").words == seen
