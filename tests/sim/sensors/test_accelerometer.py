"""Acceleration as it is read: at rest, tilted, driving, turning, hit; limits and noise."""

from __future__ import annotations

import math
import statistics

import pytest

from tests.sim.builders import FLOOR, ROBOT, make, post_wall, readings, run, send
from tests.sim.fake_view import FakeView, Measurement
from thymio_sim_ros.sim.commands import BodyTwist, MotorTargets, MoveRobot, Tilt
from thymio_sim_ros.sim.model import geometry
from thymio_sim_ros.sim.model.geometry import Pose, Twist
from thymio_sim_ros.sim.model.noise import Noise
from thymio_sim_ros.sim.model.readings import AccelerometerReading
from thymio_sim_ros.sim.physics import Contact
from thymio_sim_ros.sim.sensors import accelerometer
from thymio_sim_ros.sim.world import World

QUARTER = math.pi / 2


def measurement(view: FakeView) -> Measurement:
    return Measurement(accelerometer.SENSOR, view)


def held(roll_rad: float, pitch_rad: float) -> AccelerometerReading:
    """What a robot held at an angle reads."""
    reading = measurement(FakeView(tilt=geometry.Tilt(roll_rad, pitch_rad), now_ns=62_500_000)).next()
    assert isinstance(reading, AccelerometerReading)
    return reading


@pytest.mark.parametrize(
    ("roll_rad", "pitch_rad", "words"),
    [
        (0.0, 0.0, (0, 0, 23)),
        (QUARTER, 0.0, (-23, 0, 0)),  # left side up
        (-QUARTER, 0.0, (23, 0, 0)),  # left side down reads positive
        (0.0, QUARTER, (0, -23, 0)),  # front down
        (0.0, -QUARTER, (0, 23, 0)),  # rear down reads positive
        (math.pi, 0.0, (0, 0, -23)),
        (-0.5, 0.0, (11, 0, 20)),
        (0.0, -0.5, (0, 11, 20)),
    ],
)
def test_gravity_is_read_as_the_robot_is_held(roll_rad: float, pitch_rad: float, words: tuple[int, int, int]) -> None:
    assert held(roll_rad, pitch_rad).words == words


def test_the_vector_is_forward_left_up_in_metres_per_second_squared() -> None:
    reading = held(-0.5, 0.0)
    assert reading.acceleration_m_s2 == pytest.approx((0.0, -11 / 23 * 9.81, 20 / 23 * 9.81))


def test_a_robot_at_rest_reads_g_upwards_with_noise_too() -> None:
    steps = run(World(make([FLOOR]), seed=1), 10.0)
    words = [reading.words for reading in readings(steps, "accelerometer")]
    assert words == [(0, 0, 23)] * 160


def test_starting_and_stopping_are_felt_once_each() -> None:
    world = World(make([FLOOR]), noise=False)
    send(world, MotorTargets(500, 500))
    started = [reading.words[1] for reading in readings(run(world, 0.5), "accelerometer")]
    send(world, MotorTargets(0, 0))
    stopped = [reading.words[1] for reading in readings(run(world, 0.5), "accelerometer")]
    # 0.166 m/s within 70 ms (the first tick after 62.5 ms), then within 60 ms
    assert started == [round(0.166 / 0.07 / 9.81 * 23), 0, 0, 0, 0, 0, 0, 0]
    assert min(stopped) == pytest.approx(-6, abs=1)
    assert stopped.count(0) == len(stopped) - 1


def test_a_curve_presses_outwards() -> None:
    world = World(make([FLOOR]), noise=False)
    send(world, BodyTwist(0.08, 1.0))
    reading = readings(run(world, 1.0), "accelerometer")[-1]
    assert reading.words[0] == round(-0.08 * 1.0 / 9.81 * 23)
    felt = measurement(FakeView(twist=Twist(0.16, 8.0)))
    felt.next()
    turning = felt.next()
    assert turning.words == (round(-0.16 * 8.0 / 9.81 * 23), 0, 23)  # to the left, so negative


def test_a_wall_is_felt_as_a_shock() -> None:
    world = World(make([FLOOR, post_wall(0.05)]), noise=False)
    send(world, MotorTargets(500, 500))
    words = [reading.words[1] for reading in readings(run(world, 2.0), "accelerometer")][1:]
    assert min(words) < -3


def test_a_hit_from_the_side_is_felt_sidewards() -> None:
    contact = Contact("thymio", "other", 0.0, 0.06, 0.3, True)
    view = FakeView(contacts=(contact,), now_ns=62_500_000)
    assert accelerometer.SENSOR.on_wake is not None
    accelerometer.SENSOR.on_wake(view)
    view.contacts = ()
    felt = measurement(view)
    first, second = felt.next(), felt.next()
    assert first.words[0] == round(0.3 / 0.0625 / 9.81 * 23)  # pushed to the right
    assert second.words[0] == 0


def test_hits_between_two_readings_add_up_and_what_is_touched_on_is_none() -> None:
    hit, touched = Contact("thymio", "other", 0.0, 0.06, 0.2, True), Contact("thymio", "wall", 0.0, 0.06, 0.2, False)
    view = FakeView(contacts=(hit, touched), now_ns=62_500_000)
    assert accelerometer.SENSOR.on_wake is not None
    for _ in range(2):
        accelerometer.SENSOR.on_wake(view)
    reading = measurement(view).next()
    assert reading.words[0] == round(2 * 0.2 / 0.0625 / 9.81 * 23)


def test_being_put_elsewhere_is_no_shock_but_a_stop() -> None:
    world = World(make([FLOOR]), noise=False)
    run(world, 0.5)
    send(world, MoveRobot(1.0, 1.0, 2.0))
    assert {reading.words for reading in readings(run(world, 0.5), "accelerometer")} == {(0, 0, 23)}


def test_counts_are_limited() -> None:
    hard = Contact("thymio", "wall", -0.06, 0.0, 0.0, True)
    view = FakeView(twist=Twist(9.0, 0.0), contacts=(hard,))
    felt = measurement(view)
    assert felt.next().words == (0, 32, 23)
    view.twist = Twist(-9.0, 0.0)
    braked = felt.next()
    assert braked.words[1] == -32


def test_a_contact_in_the_middle_of_the_robot_has_no_side() -> None:
    assert accelerometer.sideways(Pose(0.0, 0.0, 0.0), Contact("thymio", "wall", 0.0, 0.0, 1.0, True)) == 0.0


def test_between_two_counts_the_noise_shows() -> None:
    noise = Noise(3, "thymio", "accelerometer")
    middle, above, far = (
        [felt.next().words[0] for _ in range(2000)]
        for felt in (
            measurement(FakeView(tilt=geometry.Tilt(-math.asin(count / 23), 0.0), noise=noise))
            for count in (10.5, 10.6, 10.75)
        )
    )
    assert set(middle) == {10, 11}
    assert statistics.mean(middle) == pytest.approx(10.5, abs=0.05)
    assert statistics.mean(above) == pytest.approx(10.75, abs=0.05)
    assert set(far) == {11}


def test_the_operator_tilts_the_robot_until_the_next_command() -> None:
    world = World(make([FLOOR], [ROBOT]), noise=False)
    send(world, Tilt(0.0, -0.5))
    tilted = readings(run(world, 1.0), "accelerometer")
    send(world, Tilt(0.0, 0.0))
    level = readings(run(world, 1.0), "accelerometer")
    assert {reading.words for reading in tilted} == {(0, round(23 * math.sin(0.5)), round(23 * math.cos(0.5)))}
    assert {reading.words for reading in level} == {(0, 0, 23)}


def test_free_fall_is_weightless_and_the_landing_a_shock() -> None:
    floor = {**FLOOR, "size_x_m": 0.5, "size_y_m": 0.5}
    world = World(make([floor]), noise=False)
    send(world, MotorTargets(500, 500))
    words = [reading.words for reading in readings(run(world, 4.0), "accelerometer")]
    first = words.index((0, 0, 0))
    assert words.count((0, 0, 0)) == 3
    assert words[first + 3][2] == 32
    assert words[-1] == (0, round(-23 * math.sin(math.radians(50))), round(23 * math.cos(math.radians(50))))


def test_a_robot_that_is_put_back_is_level_again() -> None:
    floor = {**FLOOR, "size_x_m": 0.5, "size_y_m": 0.5}
    world = World(make([floor]), noise=False)
    send(world, MotorTargets(500, 500))
    run(world, 4.0)
    send(world, MotorTargets(0, 0))
    send(world, MoveRobot(0.0, 0.0, 0.0))
    assert readings(run(world, 0.5), "accelerometer")[-1].words == (0, 0, 23)
