"""Readings → messages as plain functions."""

from __future__ import annotations

import math

import pytest
from geometry_msgs.msg import Quaternion
from sensor_msgs.msg import JointState, LaserScan, Range
from std_msgs.msg import Float32
from visualization_msgs.msg import Marker

from thymio_sim_ros.ros.interface import convert_readings, rotations, sensor_topics
from thymio_sim_ros.ros.interface.convert_readings import ConvertOptions
from thymio_sim_ros.ros.interface.names import RobotNames, ros_names, topic_word
from thymio_sim_ros.sim.model import readings, units
from thymio_sim_ros.sim.model.geometry import Pose, Tilt
from thymio_sim_ros.sim.model.geometry import Twist as BodyMotion
from thymio_sim_ros.sim.model.primitives import Stroke
from thymio_sim_ros.sim.sensors import all_sensors

ALONE = RobotNames("")
SECOND = RobotNames("thymio_2")
ROWS = {row.topic: row for sensor in all_sensors() for row in sensor_topics.rows_of(sensor)}

PROXIMITY = readings.ProximityReading(
    1_500_000_000,
    (0, 1000, 4505, 0, 0, 0, 2000),
    (math.inf, 0.12, 0.005, math.inf, math.inf, math.inf, 0.08),
)


def encode(topic, reading, names=ALONE, options=None):
    return ROWS[topic].encode(reading, names, options or ConvertOptions())


@pytest.mark.parametrize(
    ("topic", "expected", "driver"),
    [
        ("proximity/left", math.inf, -1.0),
        ("proximity/center_left", 0.12, 0.12),
        ("proximity/center", -math.inf, 0.0215),
        ("proximity/rear_right", 0.08, 0.08),
    ],
)
def test_ranges_out_of_range_follow_rep_117_or_the_driver(topic, expected, driver):
    message = encode(topic, PROXIMITY)
    assert isinstance(message, Range)
    assert message.range == pytest.approx(expected)
    assert encode(topic, PROXIMITY, options=ConvertOptions(driver_ranges=True)).range == pytest.approx(driver)
    assert (message.header.stamp.sec, message.header.stamp.nanosec) == (1, 500_000_000)


def test_frames_have_the_robot_s_prefix():
    assert encode("proximity/center", PROXIMITY, SECOND).header.frame_id == "thymio_2/proximity_center_link"


def test_the_laser_goes_from_right_to_left_and_nothing_is_inf():
    scan = encode("_proximity/laser", PROXIMITY)
    assert isinstance(scan, LaserScan)
    assert list(scan.ranges) == pytest.approx([math.inf, math.inf, 0.1015, 0.2, math.inf])
    assert list(scan.intensities) == [0.0, 0.0, 4505.0, 1000.0, 0.0]
    assert len(scan.ranges) == round((scan.angle_max - scan.angle_min) / scan.angle_increment) + 1


@pytest.mark.parametrize(("count", "expected", "driver"), [(100, math.inf, 1.0), (900, -math.inf, 0.0)])
def test_the_ground_reflects_or_not(count, expected, driver):
    reading = readings.GroundReading(0, (0, 0, count, 900, count, 900), (0.0, 1.0))
    assert encode("ground/left", reading).range == expected
    assert encode("ground/left", reading, options=ConvertOptions(driver_ranges=True)).range == driver
    assert encode("ground/right", reading).range == -math.inf


@pytest.mark.parametrize(("gray", "side"), [(0.0, "left"), (0.3, "right"), (1.0, "left")])
def test_the_grey_of_the_ground_is_that_over_which_the_sensor_counts_so(gray, side):
    count = round(units.ground_response(gray))
    reading = readings.GroundReading(0, (200, 200, count + 200, count + 200, count, count), (0.9, 0.1))
    message = encode(f"ground/{side}/reflectance", reading)
    assert isinstance(message, Float32)
    assert message.data == pytest.approx(gray, abs=0.01)


@pytest.mark.parametrize("count", [-20, 0, 60, 944, 1023])
def test_greys_are_from_0_to_1_whatever_is_counted(count):
    reading = readings.GroundReading(0, (0, 0, count, count, count, count), (0.0, 0.0))
    assert encode("ground/left/reflectance", reading).data == (1.0 if count > 500 else 0.0)


def test_joints_carry_angles_and_speeds():
    message = encode("joint_states", readings.MotorReading(0, (1, 2, 3, 4), (0.5, 7.0), (1.0, 2.0)), SECOND)
    assert isinstance(message, JointState)
    assert message.name == ["thymio_2/left_wheel_joint", "thymio_2/right_wheel_joint"]
    assert (list(message.position), list(message.velocity)) == ([0.5, 7.0], [1.0, 2.0])


def test_odometry_and_truth_have_their_frames_and_covariances():
    reading = readings.PoseReading(
        0, (), Pose(1.0, 2.0, math.pi / 2), BodyMotion(0.1, 0.2), Pose(3.0, 4.0, 0.0), BodyMotion(0.3, 0.4)
    )
    odometry, truth = encode("odom", reading), encode("_ground_truth/odom", reading)
    assert (odometry.header.frame_id, truth.header.frame_id) == ("odom", "map")
    assert convert_readings.yaw_of(odometry.pose.pose.orientation) == pytest.approx(math.pi / 2)
    assert (odometry.twist.twist.linear.x, truth.twist.twist.angular.z) == (0.1, 0.4)
    assert min(odometry.pose.covariance) >= 0.0
    assert sum(truth.pose.covariance) == 0.0
    sure = ConvertOptions(pose_covariance=(0.0,) * 6, twist_covariance=(1.0, 2.0, 3.0, 4.0, 5.0, 6.0))
    assert list(encode("odom", reading, options=sure).twist.covariance[::7]) == [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]


@pytest.mark.parametrize("tilt", [Tilt(0.0, 0.8), Tilt(0.8, 0.0), Tilt(-0.3, 0.4), Tilt(0.0, 0.0)])
def test_the_true_pose_has_the_tilt(tilt):
    rest = BodyMotion(0.0, 0.0)
    reading = readings.PoseReading(0, (), Pose(0.0, 0.0, 0.0), rest, Pose(0.0, 0.0, math.pi / 2), rest, tilt)
    q = encode("_ground_truth/odom", reading).pose.pose.orientation
    forward_up, left_up = 2 * (q.x * q.z - q.w * q.y), 2 * (q.y * q.z + q.w * q.x)
    assert (forward_up, left_up) == pytest.approx(
        (-math.sin(tilt.pitch_rad), math.sin(tilt.roll_rad) * math.cos(tilt.pitch_rad))
    )
    assert convert_readings.yaw_of(q) == pytest.approx(math.pi / 2)
    assert q.x**2 + q.y**2 + q.z**2 + q.w**2 == pytest.approx(1.0)


def test_leds_are_labelled_parts_of_one_array():
    message = encode("_led/state", readings.LedReading(0, (), (("top", (32, 16, 0)), ("ground", (0, 32)))))
    assert [(dim.label, dim.size) for dim in message.layout.dim] == [("top", 3), ("ground", 2)]
    assert list(message.data) == [1.0, 0.5, 0.0, 0.0, 1.0]


@pytest.mark.parametrize(("shift", "volume"), [(0, 1.0), (1, 0.5), (7, 2.0**-7), (8, 0.0)])
def test_the_volume_is_halved_by_each_bit_and_the_last_one_is_silence(shift, volume):
    reading = readings.LoudspeakerReading(0, (), 0, 440.0, None, (), b"", shift)
    assert list(encode("_sound/state", reading).data) == [440.0, math.inf, volume]


def test_a_trail_takes_the_place_of_the_one_before():
    stroke = Stroke((1.0, 0.0, 0.0), 0.01, ((0.0, 0.0), (0.1, 0.0)))
    reading = readings.PenReading(0, (), True, (1.0, 0.0, 0.0), 0.01, False, (stroke, stroke))
    markers = encode("_pen/trail", reading).markers
    assert [(marker.action, marker.id) for marker in markers[1:]] == [(Marker.ADD, 0), (Marker.ADD, 1)]
    assert markers[0].action == Marker.DELETEALL


@pytest.mark.parametrize("yaw", [-3.0, -0.5, 0.0, 1.0, 3.1])
def test_yaw_survives_as_quaternion(yaw):
    assert convert_readings.yaw_of(convert_readings.quaternion(yaw)) == pytest.approx(yaw)
    assert isinstance(convert_readings.quaternion(yaw), Quaternion)


@pytest.mark.parametrize("tilt", [Tilt(0.0, 0.0), Tilt(0.3, -0.2), Tilt(-3.0, 0.1), Tilt(0.1, 3.1)])
@pytest.mark.parametrize("yaw", [0.0, 3.0, math.pi, 3.2, 5.0, 7.0, 40.0, -3.0, -3.2, -5.0, -40.0])
def test_every_orientation_has_a_w_that_is_not_negative(yaw, tilt):
    x, y, z, w = rotations.rotation(yaw, tilt)
    assert w >= 0.0
    assert math.hypot(x, y, z, w) == pytest.approx(1.0)
    forward = (1 - 2 * (y * y + z * z), 2 * (x * y + w * z))
    lean = math.cos(tilt.pitch_rad)
    assert forward == pytest.approx((math.cos(yaw) * lean, math.sin(yaw) * lean))


@pytest.mark.parametrize("angle", [0.0, 1.0, 3.5, -3.5, 100.0])
def test_wheels_turn_with_a_w_that_is_not_negative(angle):
    x, y, z, w = rotations.wheel_rotation(angle)
    assert w >= 0.0
    assert (x, z) == (0.0, 0.0)
    assert (w * w - y * y, 2 * w * y) == pytest.approx((math.cos(angle), math.sin(angle)))


def test_one_robot_has_no_name_and_several_have_theirs():
    assert ros_names(("thymio",))["thymio"].topic("odom") == "odom"
    names = ros_names(("anna", "bert"))
    assert names["bert"].topic("odom") == "bert/odom"
    assert names["bert"].frame("base_link") == "bert/base_link"


@pytest.mark.parametrize(
    ("event", "word"), [("ping", "ping"), ("my.event", "my_event"), ("1st", "_1st"), ("été", "_t_")]
)
def test_events_become_words_of_a_topic(event, word):
    assert topic_word(event) == word


def test_rays_have_the_measured_length_and_a_color_for_obstacles():
    marker = encode("_proximity/rays", PROXIMITY, SECOND)
    assert marker.header.frame_id == "thymio_2/base_link"
    pairs = list(zip(marker.points[::2], marker.points[1::2], strict=True))
    lengths = [math.hypot(end.x - start.x, end.y - start.y) for start, end in pairs]
    assert lengths == pytest.approx([0.14, 0.12, 0.005, 0.14, 0.14, 0.14, 0.08])
    assert [color.r == 1.0 for color in marker.colors[1::2]] == [False, True, True, False, False, False, True]
    assert len(marker.colors) == len(marker.points)
