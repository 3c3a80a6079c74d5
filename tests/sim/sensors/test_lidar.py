"""The lidar: distances all around, noise, limits, and that a world without one has nothing of it."""

from __future__ import annotations

import math
import statistics
from dataclasses import replace

import pytest

from tests.sim.builders import FLOOR, ROBOT, box, make, measure_one, readings, run, send
from thymio_sim_ros.sim.commands import BodyTwist, Lift
from thymio_sim_ros.sim.model.lidar import LIDAR_MIN_M, LIDAR_PLACE, Lidar
from thymio_sim_ros.sim.model.readings import LidarReading
from thymio_sim_ros.sim.world import World

EXACT = Lidar(noise_m=0.0)
ROOM = [
    FLOOR,
    box(1.02, 0.0, 0.04, 2.2, height_m=0.1),
    box(0.0, 0.82, 2.2, 0.04, height_m=0.1),
    box(0.0, -0.62, 2.2, 0.04, height_m=0.1),
]
"""Walls in front at 1 m, to the left at 0.8 m, to the right at 0.6 m; none behind."""


def scan(world: World, robot: str | None = None) -> LidarReading:
    reading = measure_one(world, "lidar", robot)
    assert isinstance(reading, LidarReading)
    return reading


def test_beams_go_counter_clockwise_from_the_front() -> None:
    reading = scan(World(make(ROOM), lidar=EXACT))
    assert len(reading.ranges_m) == 360
    assert [reading.ranges_m[degrees] for degrees in (0, 90, 180, 270)] == [
        pytest.approx(1.0 - LIDAR_PLACE[0]),
        pytest.approx(0.8),
        math.inf,
        pytest.approx(0.6),
    ]
    assert reading.ranges_m[45] == pytest.approx(0.8 * math.sqrt(2))


@pytest.mark.parametrize("beams", [1, 7, 23, 360, 997, 1440])
def test_any_number_of_beams_sees_the_same_walls(beams: int) -> None:
    lidar = replace(EXACT, beams=beams)
    ranges = scan(World(make(ROOM), lidar=lidar)).ranges_m
    assert len(ranges) == beams
    x, y = LIDAR_PLACE
    for number, range_m in enumerate(ranges):
        cos, sin = math.cos(number * lidar.step_rad), math.sin(number * lidar.step_rad)
        ahead = [(1.0 - x) / cos] if cos > 1e-9 else []
        aside = [((0.8 if sin > 0.0 else -0.6) - y) / sin] if abs(sin) > 1e-9 else []
        hits = [length for length in (*ahead, *aside) if -1.1 <= x + length * cos <= 1.04]
        assert range_m == pytest.approx(min(hits, default=math.inf), abs=1e-9), number


def test_what_is_beyond_the_range_or_lower_than_the_beams_is_not_seen() -> None:
    low, high = box(0.4, 0.0, 0.02, 0.2, height_m=0.049), box(-0.4, 0.0, 0.02, 0.2, height_m=0.05)
    ranges = scan(World(make([*ROOM, low, high]), lidar=replace(EXACT, range_m=0.7))).ranges_m
    assert (ranges[0], ranges[90]) == (math.inf, math.inf)
    assert ranges[180] == pytest.approx(0.39 + LIDAR_PLACE[0])
    assert ranges[270] == pytest.approx(0.6)


def test_robots_see_each_other_and_not_themselves() -> None:
    other = {"name": "other", "x_m": 0.5, "y_m": 0.0, "yaw_rad": math.pi}
    world = World(make(robots=[ROBOT, other]), lidar=EXACT)
    assert scan(world, "other").ranges_m[0] == pytest.approx(0.5 - 0.08 - LIDAR_PLACE[0])
    assert scan(world, "thymio").ranges_m[0] == pytest.approx(0.5 - 0.08 - LIDAR_PLACE[0])
    assert set(scan(world, "thymio").ranges_m[90:271]) == {math.inf}


def test_a_robot_that_is_lifted_sees_nothing() -> None:
    world = World(make(ROOM), lidar=EXACT)
    send(world, Lift(is_lifted=True))
    assert set(scan(world).ranges_m) == {math.inf}


def test_noise_has_the_deviation_that_is_set_and_stays_within_the_limits() -> None:
    world = World(make(ROOM), lidar=Lidar(beams=4, noise_m=0.02, range_m=0.8, rate_hz=100.0))
    scans = readings(run(world, 20.0), "lidar")
    right = [one.ranges_m[3] for one in scans]
    assert statistics.mean(right) == pytest.approx(0.6, abs=0.002)
    assert statistics.stdev(right) == pytest.approx(0.02, rel=0.1)
    assert max(one.ranges_m[1] for one in scans) == 0.8
    near = World(make([box(0.11, 0.0, 0.02, 0.2)]), lidar=Lidar(beams=1, noise_m=0.5))
    assert min(one.ranges_m[0] for one in readings(run(near, 5.0), "lidar")) == LIDAR_MIN_M


def test_scans_come_at_their_rate_and_are_the_same_again() -> None:
    def drive() -> list[LidarReading]:
        world = World(make(ROOM), seed=5, lidar=Lidar(rate_hz=5.0))
        send(world, BodyTwist(0.1, 0.3))
        return readings(run(world, 2.0), "lidar")

    scans = drive()
    assert [one.stamp_ns for one in scans] == [200_000_000 * number for number in range(1, 11)]
    assert scans == drive()
    assert scans[0].ranges_m != scans[1].ranges_m


def test_it_changes_nothing_else_and_measures_only_where_it_is() -> None:
    def others(lidar: Lidar | None, wanted: list[str] | None = None) -> list[object]:
        world = World(make(ROOM), seed=2, lidar=lidar)
        send(world, BodyTwist(0.05, 0.5))
        return [row for _ in range(100) for row in world.step(wanted).readings if row[1] != "lidar"]

    assert others(None) == others(Lidar())
    world = World(make(ROOM))
    assert "lidar" not in {name for step in run(world, 1.0) for _, name, _ in step.readings}
    with pytest.raises(KeyError, match="lidar"):
        world.read("thymio", "lidar")
    world = World(make(ROOM), lidar=Lidar())
    assert "lidar" not in {name for _ in range(100) for _, name, _ in world.step(["pose"]).readings}


def test_its_period_can_be_one_of_those_of_the_world() -> None:
    world = World(make(ROOM), lidar=Lidar(), periods_ns={"pose": 50_000_000})
    assert [one.stamp_ns for one in readings(run(world, 0.25), "lidar")] == [100_000_000, 200_000_000]
    world = World(make(ROOM), lidar=Lidar(), periods_ns={"lidar": 50_000_000})
    assert len(readings(run(world, 0.25), "lidar")) == 5
    with pytest.raises(ValueError, match="found 'lidar', expected one of"):
        World(make(ROOM), periods_ns={"lidar": 50_000_000})


@pytest.mark.parametrize(
    ("field", "value"),
    [("beams", 0), ("beams", 1441), ("range_m", math.nan), ("rate_hz", 0.0), ("noise_m", -0.1), ("range_m", math.inf)],
)
def test_values_out_of_range_are_refused(field: str, value: float) -> None:
    with pytest.raises(ValueError, match=rf"lidar: {field}: found .*, expected a number from"):
        Lidar(**{field: value})
