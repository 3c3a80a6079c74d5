"""Patched messages are those that the serialiser makes, for every reading, name and option."""

from __future__ import annotations

import math
import struct

import pytest
from rclpy.serialization import deserialize_message, serialize_message
from std_msgs.msg import Float32, Float32MultiArray

from thymio_sim_ros.ros import generate_ros_docs
from thymio_sim_ros.ros.interface import sensor_topics
from thymio_sim_ros.ros.interface.cdr_templates import Patch, Span, Template
from thymio_sim_ros.ros.interface.convert_readings import ConvertOptions
from thymio_sim_ros.ros.interface.names import RobotNames
from thymio_sim_ros.sim.commands import LED_GROUPS
from thymio_sim_ros.sim.model import readings
from thymio_sim_ros.sim.model.geometry import Pose, Tilt, Twist

PATCHED = [
    (sensor, row) for sensor in generate_ros_docs.own_sensors() for row in sensor_topics.rows_of(sensor) if row.patch
]


def reading_of(sensor, seed):
    words = tuple((seed * 7919 + index * 104_729) % 2000 - 500 for index in range(sensor.aseba.size))
    stamp = 1_230_000_000 * seed
    if sensor.name == "proximity":
        return readings.ProximityReading(stamp, words, (math.inf, 0.01, 0.05, 0.1, 0.14, 0.02 * seed, 0.03))
    if sensor.name == "ground":
        return readings.GroundReading(stamp, words, (0.1, 0.9))
    if sensor.name == "pose":
        place, turn = Pose(1.5 * seed, -2.5, 0.7 * seed), Twist(0.125, -0.5 * seed)
        return readings.PoseReading(
            stamp, (), place, turn, Pose(-place.x_m, 3.0, 1.0), Twist(0.25, float(seed)), Tilt(0.1, 0.2)
        )
    if sensor.name == "motor":
        return readings.MotorReading(stamp, words, (0.25 * seed, -7.5), (1.5, -0.125 * seed))
    if sensor.name == "accelerometer":
        return readings.AccelerometerReading(stamp, words)
    if sensor.name == "battery":
        return readings.BatteryReading(stamp, words, 3.5 + 0.125 * seed, 0.25 * seed, seed % 2 == 0)
    if sensor.name == "leds":
        levels = iter(range(seed, 100 + seed))
        groups = ((group, tuple(next(levels) % 33 for _ in range(size))) for group, size in LED_GROUPS.items())
        return readings.LedReading(stamp, (), tuple(groups))
    return readings.PlainReading(stamp, words)


@pytest.mark.parametrize("options", [ConvertOptions(), ConvertOptions(True, 100, pose_covariance=(0.0,) * 6)])
@pytest.mark.parametrize("name", ["", "anna", "a_robot_1"])
@pytest.mark.parametrize(("sensor", "row"), PATCHED, ids=[row.topic for _, row in PATCHED])
def test_a_patched_message_is_the_serialised_one(sensor, row, name, options):
    names, first = RobotNames(name), reading_of(sensor, 1)
    template = Template.checked(row.patch, row.encode(first, names, options), first, options)
    assert template is not None
    for seed in (2, 3, 1):
        reading = reading_of(sensor, seed)
        fresh = serialize_message(row.encode(reading, names, options))
        filled = template.fill(reading)
        assert repr(deserialize_message(filled, row.type)) == repr(deserialize_message(fresh, row.type))


@pytest.mark.parametrize("behind", [0, 4, 20])
def test_a_patch_in_the_wrong_place_is_no_template(behind):
    reading = readings.PlainReading(5, (1,))
    patch = Patch((Span(struct.Struct("<ff"), lambda reading, options: (1.0, 2.0), behind),), has_stamp=False)
    assert Template.checked(patch, Float32(data=3.0), reading, None) is None


def test_a_patch_over_a_length_is_no_template():
    patch = Patch((Span(struct.Struct("<I"), lambda reading, options: (1000,), behind=4),), has_stamp=False)
    message = Float32MultiArray(data=[1.0])
    assert Template.checked(patch, message, readings.PlainReading(5, (1,)), None) is None
