"""Horizontal proximity: seven distances, thin things, noise."""

from __future__ import annotations

import itertools
import math
import statistics

import pytest
from hypothesis import given
from hypothesis.strategies import floats

from tests.sim import fake_view
from tests.sim.builders import FLOOR, ROBOT, box, make, measure_one, post_wall
from tests.sim.fake_view import FakeView, Measurement
from thymio_sim_ros.sim.model import robot_constants
from thymio_sim_ros.sim.model.noise import Noise
from thymio_sim_ros.sim.model.readings import ProximityReading
from thymio_sim_ros.sim.model.units import PROXIMITY_FULL
from thymio_sim_ros.sim.raycast.scalar import ConvexObstacle, DiscObstacle
from thymio_sim_ros.sim.sensors.proximity import SENSOR
from thymio_sim_ros.sim.world import World

FRONT = 2


def measure(view: FakeView) -> ProximityReading:
    reading = fake_view.measure(SENSOR, view)
    assert isinstance(reading, ProximityReading)
    return reading


def wall_ahead(distance_m: float, *, height_m: float = 0.1) -> ConvexObstacle:
    near = 0.0795 + distance_m
    return ConvexObstacle(((near, -1.0), (near + 0.1, -1.0), (near + 0.1, 1.0), (near, 1.0)), height_m)


def wall_at(angle_deg: float, distance_m: float, from_x_m: float = 0.0795) -> ConvexObstacle:
    """A long flat wall, seen at this angle off the robot's axis, whose plane is so far from a point on that axis."""
    cos, sin = math.cos(math.radians(angle_deg)), math.sin(math.radians(angle_deg))
    corners = ((distance_m, -2.0), (distance_m + 0.1, -2.0), (distance_m + 0.1, 2.0), (distance_m, 2.0))
    return ConvexObstacle(tuple((from_x_m + cos * x - sin * y, sin * x + cos * y) for x, y in corners), 0.1)


@pytest.mark.parametrize(
    ("distance_cm", "count"), [(1, 4448), (2, 4278), (4, 3705), (6, 3027), (8, 2409), (10, 1908), (12, 1521)]
)
@pytest.mark.parametrize("model", ["default", "enki"])
def test_a_wall_across_the_axis_reads_as_the_table_says(distance_cm: float, count: int, model: str) -> None:
    reading = measure(FakeView(obstacles=(wall_ahead(distance_cm / 100),), proximity_model=model))
    assert reading.words[FRONT] == pytest.approx(count, abs=1)
    assert reading.ranges_m[FRONT] == pytest.approx(distance_cm / 100, abs=1e-4)


def test_nothing_in_range_is_exactly_zero_and_infinitely_far() -> None:
    reading = measure(FakeView(obstacles=(wall_ahead(0.145),), noise=Noise(1, "thymio", "proximity")))
    assert reading.words[FRONT] == 0
    assert reading.ranges_m[FRONT] == math.inf


def test_an_empty_world_reads_zero_everywhere() -> None:
    reading = measure(FakeView(noise=Noise(1, "thymio", "proximity")))
    assert (reading.words, reading.ranges_m) == ((0,) * 7, (math.inf,) * 7)


@pytest.mark.parametrize(("height_m", "seen"), [(0.033, False), (0.034, True)])
def test_objects_lower_than_the_sensor_are_not_seen(height_m: float, seen: bool) -> None:
    assert (measure(FakeView(obstacles=(wall_ahead(0.05, height_m=height_m),))).words[FRONT] > 0) is seen


@pytest.mark.parametrize(("radius_m", "distance_m"), [(0.01, 0.03), (0.02, 0.06)])
def test_a_thin_post_ahead_is_counted_by_default_and_missed_as_the_reference_does(
    radius_m: float, distance_m: float
) -> None:
    post = (DiscObstacle(0.0795 + distance_m + radius_m, 0.0, radius_m, 0.1),)
    assert measure(FakeView(obstacles=post, proximity_model="enki")).words[FRONT] == 0
    assert measure(FakeView(obstacles=post)).ranges_m[FRONT] == pytest.approx(distance_m, abs=1e-4)


@pytest.mark.parametrize(
    "angle_deg",
    [pytest.param(angle, marks=() if angle in (-75, 0, 50) else pytest.mark.slow) for angle in range(-75, 80, 5)],
)
def test_the_count_of_a_flat_wall_falls_with_its_distance_at_every_angle(angle_deg: int) -> None:
    walls = [(wall_at(angle_deg, 0.0005 * step),) for step in range(1, 300)]
    for model in ("default", "cone"):
        counts = swept(walls, model)
        assert counts == sorted(counts, reverse=True)
        assert counts[0] > 2000
        assert counts[-1] == 0


@pytest.mark.parametrize("angle_deg", [-20, -10, 0, 10, 20])
def test_a_slanted_wall_reads_as_the_nearest_part_of_it_in_the_cone(angle_deg: int) -> None:
    reading = measure(FakeView(obstacles=(wall_at(angle_deg, 0.09),)))
    assert reading.ranges_m[FRONT] == pytest.approx(0.09, rel=0.05)


def test_whatever_is_seen_gives_at_least_what_the_end_of_the_range_gives() -> None:
    counts = [count for sweep in SWEEPS.values() for count in swept(sweep, "default")]
    assert min(filter(None, counts)) >= 1226


@given(angle_deg=floats(-180, 180), near_m=floats(0.08, 0.25), gap_m=floats(0.0, 0.1))
def test_no_sensor_reads_a_farther_wall_as_nearer(angle_deg: float, near_m: float, gap_m: float) -> None:
    """Distances from the middle of the robot, whose sensors are all within 8 cm of it."""
    walls = (wall_at(angle_deg, near_m, from_x_m=0.0), wall_at(angle_deg, near_m + gap_m, from_x_m=0.0))
    near, far = (measure(FakeView(obstacles=(wall,))).words for wall in walls)
    assert all(count >= other for count, other in zip(near, far, strict=True))


def test_in_the_reference_a_slanted_wall_at_the_end_of_the_range_reads_as_a_near_one() -> None:
    """Its subtracted ray ends at 13.5 cm, the others at 14 cm."""
    nearer, farther = swept([(wall_at(20, 0.126),), (wall_at(20, 0.128),)], "enki")
    assert farther > nearer + 1000


def test_the_sensors_stand_in_the_order_of_the_firmware() -> None:
    left = measure(FakeView(obstacles=(DiscObstacle(0.12, 0.12, 0.04, 0.1),))).words
    assert left[0] > 0
    assert left[2:] == (0, 0, 0, 0, 0)
    rear_right = measure(FakeView(obstacles=(DiscObstacle(-0.1, -0.05, 0.02, 0.1),))).words
    assert [index for index, count in enumerate(rear_right) if count] == [6]


def test_noise_spreads_counts_as_measured() -> None:
    noise = Noise(1, "thymio", "proximity")
    measurement = Measurement(SENSOR, FakeView(obstacles=(wall_ahead(0.05),), noise=noise))
    counts = [measurement.next().words[FRONT] for _ in range(2000)]
    assert statistics.mean(counts) == pytest.approx(3366, abs=0.5)
    assert statistics.stdev(counts) == pytest.approx(robot_constants.PROXIMITY_NOISE, rel=0.1)


def test_noise_never_leaves_the_limits() -> None:
    noise = Noise(1, "thymio", "proximity")
    measurement = Measurement(SENSOR, FakeView(obstacles=(wall_ahead(0.0004),), noise=noise))
    counts = [measurement.next().words[FRONT] for _ in range(200)]
    assert max(counts) == 4505


def test_a_robot_sees_the_hull_of_another() -> None:
    world = World(make([FLOOR], [ROBOT, {**ROBOT, "name": "other", "x_m": 0.2}]), noise=False)
    assert measure_one(world, "proximity", "thymio").ranges_m[FRONT] == pytest.approx(0.17 - 0.0795, abs=1e-3)
    assert [count > 0 for count in measure_one(world, "proximity", "other").words] == [False] * 5 + [True] * 2


def test_a_robot_stands_before_a_wall_in_the_world() -> None:
    world = World(make([FLOOR, post_wall(0.06)]), noise=False)
    assert measure_one(world, "proximity").ranges_m[FRONT] == pytest.approx(0.06, abs=1e-4)


def test_a_near_object_hides_a_far_one() -> None:
    far, near = post_wall(0.1), box(0.0795 + 0.05 + 0.01, 0.0, 0.02, 0.5)
    world = World(make([FLOOR, {**far, "name": "far"}, {**near, "name": "near"}]), noise=False)
    assert measure_one(world, "proximity").ranges_m[FRONT] == pytest.approx(0.05, abs=1e-4)


STEP_M = 0.0005
SWEEPS = {
    "a wall comes": [(wall_ahead(0.2 - STEP_M * step),) for step in range(390)],
    "the end of a wall passes": [
        (ConvexObstacle(((0.13, y), (0.2, y), (0.2, y + 1.0), (0.13, y + 1.0)), 0.1),)
        for y in (STEP_M * step - 0.15 for step in range(600))
    ],
    "a post passes": [(DiscObstacle(0.14, STEP_M * step - 0.1, 0.01, 0.1),) for step in range(400)],
    "a stick passes": [(DiscObstacle(0.14, STEP_M * step - 0.1, 0.003, 0.1),) for step in range(400)],
}


def swept(obstacles: list[tuple[ConvexObstacle | DiscObstacle]], model: str) -> list[int]:
    """What the front sensor counts, one after the other."""
    return [measure(FakeView(obstacles=seen, proximity_model=model)).words[FRONT] for seen in obstacles]


@pytest.mark.parametrize("sweep", SWEEPS)
def test_a_cone_reads_without_jumps_and_without_gaps(sweep: str) -> None:
    """Each of its nine rays is a ninth of the count; in the other models one ray is all of it."""
    counts = swept(SWEEPS[sweep], "cone")
    assert max(abs(after - before) for before, after in itertools.pairwise(counts)) < PROXIMITY_FULL / 9
    seen = [step for step, count in enumerate(counts) if count]
    assert seen == list(range(seen[0], seen[-1] + 1))


def test_with_three_rays_a_stick_that_passes_comes_and_goes() -> None:
    counts = swept(SWEEPS["a stick passes"], "default")
    appeared = sum(before == 0 < after for before, after in itertools.pairwise(counts))
    assert appeared == 3
    assert max(counts) > 3000


@pytest.mark.parametrize("distance_cm", [1, 3, 6, 10, 12])
def test_a_wall_reads_in_a_cone_as_in_the_other_models(distance_cm: float) -> None:
    at_once = [(wall_ahead(distance_cm / 100),)]
    assert swept(at_once, "cone") == pytest.approx(swept(at_once, "default"), abs=1)
