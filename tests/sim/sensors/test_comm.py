"""Infrared communication: intensity, sight, who is understood."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import pytest

from tests.sim.builders import FLOOR, box, make, run
from thymio_sim_ros.sim.commands import EnableComm, MotorTargets, SetCommPayload
from thymio_sim_ros.sim.model.readings import CommReading
from thymio_sim_ros.sim.sensors import comm
from thymio_sim_ros.sim.world import World

CENTER = 2


def robot(name: str, x_m: float, y_m: float = 0.0, yaw_rad: float = 0.0) -> dict[str, Any]:
    return {"name": name, "x_m": x_m, "y_m": y_m, "yaw_rad": yaw_rad}


def frames(
    robots: Sequence[dict[str, Any]], payloads: dict[str, int], shapes: Sequence[dict[str, Any]] = (FLOOR,)
) -> dict[str, list[CommReading]]:
    """What each robot reads in one second when those with a payload send, and all listen."""
    world = World(make(shapes, robots), noise=False)
    for name in world.robots:
        world.post(name, EnableComm(True))
    for name, payload in payloads.items():
        world.post(name, SetCommPayload(payload))
    found: dict[str, list[CommReading]] = {name: [] for name in world.robots}
    for step in run(world, 1.0):
        for name, _, reading in step.readings:
            if isinstance(reading, CommReading):
                found[name].append(reading)
    return found


def facing(gap_m: float) -> list[dict[str, Any]]:
    """`a` looks at `b`, and `b` at `a`; the gap is that of their front sensors."""
    return [robot("a", 0.0), robot("b", 2 * 0.0795 + gap_m, 0.0, math.pi)]


def expected(gap_m: float) -> float:
    """Intensity of the center sensor, from the three front emitters of the other.

    Source: docs/spec/thymio-robot.md section 7.5.
    """
    total = 0.0
    for x, y, angle in ((0.0795, 0.0, 0.0), (0.075, 0.0255, 20.0), (0.075, -0.0255, -20.0)):
        across, along = y, gap_m + 0.0795 - x
        distance = math.hypot(across, along) * 100
        bearing = math.atan2(across, along)
        weight = math.cos(bearing + math.radians(angle)) ** 18 * math.cos(bearing) ** 9
        total += weight * (917 - 0.2**2) / (distance - 0.2) ** 2
    return 4600 / (1 + 1 / total)


@pytest.mark.parametrize("gap_m", [0.05, 0.15, 0.3, 0.4])
def test_two_robots_that_face_each_other_understand_each_other(gap_m: float) -> None:
    found = frames(facing(gap_m), {"a": 5, "b": 2000})
    assert len(found["a"]) == len(found["b"]) == 10
    for name, value in (("a", 2000), ("b", 5)):
        words = found[name][0].words
        assert words[0] == words[1 + CENTER] == value
        assert words[8 + CENTER] == max(words[8:]) == pytest.approx(expected(gap_m), abs=3)


def test_one_emitter_straight_ahead_follows_the_law() -> None:
    assert comm.strength(0.2, 1.0, 1.0) == pytest.approx((917 - 0.04) / 19.8**2)
    assert comm.intensity(comm.strength(0.2, 1.0, 1.0)) == pytest.approx(4600 / (1 + 19.8**2 / 916.96))
    assert comm.intensity(0.0) == 0.0
    assert comm.intensity(comm.strength(0.001, 1.0, 1.0)) == 4600.0


@pytest.mark.parametrize(
    ("distance_m", "cos_emitter", "cos_receiver"),
    [(0.481, 1.0, 1.0), (0.1, 0.0, 1.0), (0.1, -0.5, 1.0), (0.1, 1.0, math.cos(0.645))],
)
def test_beyond_range_and_angles_nothing_is_seen(distance_m: float, cos_emitter: float, cos_receiver: float) -> None:
    assert comm.strength(distance_m, cos_emitter, cos_receiver) == 0.0


def test_too_far_is_not_understood() -> None:
    assert frames(facing(0.49), {"a": 1, "b": 2})["a"] == []


def test_the_rear_sensors_understand_what_is_behind() -> None:
    found = frames([robot("a", 0.0), robot("b", -0.3)], {"b": 7})
    words = found["a"][0].words
    assert words[0] == 7
    assert words[1:8] == (0, 0, 0, 0, 0, 7, 7)
    assert all(intensity >= 1400 for intensity in words[13:])
    assert words[8:13] == (0, 0, 0, 0, 0)


def test_a_wall_between_them_hides_them() -> None:
    wall = box(0.2, 0.0, 0.01, 1.0)
    assert frames(facing(0.2), {"a": 1, "b": 2}, [FLOOR, wall])["a"] == []


def test_so_does_a_wall_close_to_the_other_one_at_the_end_of_the_range() -> None:
    wall = box(0.51, 0.0, 0.01, 1.0)
    assert len(frames(facing(0.45), {"a": 1, "b": 2})["a"]) == 10
    assert frames(facing(0.45), {"a": 1, "b": 2}, [FLOOR, wall])["a"] == []


def test_a_low_wall_does_not() -> None:
    wall = box(0.18, 0.0, 0.01, 1.0, height_m=0.03)
    assert len(frames(facing(0.2), {"a": 1, "b": 2}, [FLOOR, wall])["a"]) == 10


def test_a_robot_between_them_hides_them() -> None:
    found = frames([*facing(0.2), robot("c", 0.18, 0.0, math.pi / 2)], {"b": 2})
    assert found["a"] == []


def test_of_two_senders_the_stronger_is_understood() -> None:
    found = frames([robot("a", 0.0), robot("b", 0.35, 0.03, math.pi), robot("c", 0.2, -0.1, 2.6)], {"b": 1, "c": 2})
    assert {reading.words[0] for reading in found["a"]} == {2}


def test_each_sensor_understands_its_own_sender() -> None:
    found = frames([robot("a", 0.0), robot("b", 0.3, 0.0, math.pi), robot("c", -0.2)], {"b": 1, "c": 2})
    words = found["a"][0].words
    assert words[1 + CENTER] == 1
    assert words[6:8] == (2, 2)


@pytest.mark.parametrize(("payload", "value"), [(0, 0), (2047, 2047), (2048, 2047), (32767, 2047)])
def test_values_are_limited_to_eleven_bits(payload: int, value: int) -> None:
    assert frames(facing(0.1), {"b": payload})["a"][0].words[0] == value


@pytest.mark.parametrize("payload", [-1, -32768])
def test_a_negative_value_is_no_data(payload: int) -> None:
    assert frames(facing(0.1), {"b": payload})["a"] == []


def test_a_robot_that_is_switched_off_neither_sends_nor_receives() -> None:
    world = World(make([FLOOR], facing(0.1)), noise=False)
    world.post("a", EnableComm(True))
    world.post("a", SetCommPayload(3))
    world.post("b", SetCommPayload(4))
    assert not [1 for step in run(world, 1.0) for _, name, _ in step.readings if name == "comm"]
    world.post("b", EnableComm(True))
    heard = {(name, reading.words[0]) for step in run(world, 1.0) for name, _, reading in step.readings
             if isinstance(reading, CommReading)}  # fmt: skip
    assert heard == {("a", 4), ("b", 3)}


def test_a_robot_does_not_hear_itself() -> None:
    assert frames([robot("a", 0.0)], {"a": 1})["a"] == []


def test_turning_both_by_the_same_angle_changes_nothing() -> None:
    straight = frames(facing(0.2), {"b": 9})["a"][0].words
    turned = [robot("a", 0.0, 0.0, 1.0), robot("b", 0.359 * math.cos(1.0), 0.359 * math.sin(1.0), 1.0 + math.pi)]
    assert frames(turned, {"b": 9})["a"][0].words == pytest.approx(straight, abs=1)


def test_a_robot_that_has_fallen_off_the_table_neither_sends_nor_receives() -> None:
    table = {**FLOOR, "size_x_m": 0.6, "size_y_m": 0.6}
    world = World(make([table], [robot("a", 0.0), robot("b", 0.25, 0.0, math.pi)]), noise=False)
    for name in "ab":
        world.post(name, EnableComm(True))
    world.post("b", MotorTargets(-300, -300))
    heard = [
        [name for name, sensor, _ in step.readings if sensor == "comm"]
        for step in run(world, 3.0)
        if any(sensor == "proximity" for _, sensor, _ in step.readings)
    ]
    assert heard[0] == ["a", "b"]
    assert heard[-1] == []
    assert world.robots["b"].is_fallen
