"""Conversions of readings to messages.

Names, units, frames and QoS are those of docs/spec/ros-interface.md sections 4, 6.3 and 9.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from geometry_msgs.msg import Point, Quaternion, TwistWithCovariance
from geometry_msgs.msg import Pose as PoseMsg
from nav_msgs.msg import Odometry
from sensor_msgs.msg import JointState, Joy, LaserScan, Range
from std_msgs.msg import (
    Bool,
    ColorRGBA,
    Float32,
    Float32MultiArray,
    Int8MultiArray,
    Int16MultiArray,
    MultiArrayDimension,
    MultiArrayLayout,
    UInt8MultiArray,
)
from visualization_msgs.msg import Marker, MarkerArray

from thymio_sim_ros.ros.interface.headers import SECOND_NS, stamped
from thymio_sim_ros.ros.interface.names import MAP_FRAME, PROXIMITY, SIDES, RobotNames
from thymio_sim_ros.ros.interface.rotations import rotation
from thymio_sim_ros.sim.audio.synthesis import VOLUME_OFF
from thymio_sim_ros.sim.commands import LED_FULL
from thymio_sim_ros.sim.model import readings, units
from thymio_sim_ros.sim.model.geometry import LEVEL, Pose, Tilt, Twist

# The driver's constants of a Range (docs/spec/ros-interface.md section 3).
PROXIMITY_MIN_M, PROXIMITY_MAX_M, PROXIMITY_FOV_RAD = 0.0215, 0.14, 0.3
GROUND_MIN_M, GROUND_MAX_M, GROUND_FOV_RAD = 0.009, 0.03, 0.3
LASER_STEP_RAD, LASER_ANGLE_RAD, LASER_OFFSET_M = 0.32, 0.64, 0.08

TRAIL_M = 0.0015
"""Height of pen strokes, for viewers: above all paint."""


@dataclass(frozen=True, slots=True)
class RangeFields:
    """Fixed fields in the Range messages of one proximity sensor: m, m, rad."""

    min_m: float = PROXIMITY_MIN_M
    max_m: float = PROXIMITY_MAX_M
    fov_rad: float = PROXIMITY_FOV_RAD


@dataclass(frozen=True, slots=True)
class ConvertOptions:
    """Options for the content of messages.

    `driver_ranges`: −1 and minimum instead of ±inf (docs/spec/ros-interface.md section 4.3). `ground_threshold`: count.
    `proximity`: in Thymio's order. Covariance diagonals: x y z roll pitch yaw. `scan_ns`: period of laser scans.
    """

    driver_ranges: bool = False
    ground_threshold: int = 200
    proximity: tuple[RangeFields, ...] = (RangeFields(),) * len(PROXIMITY)
    pose_covariance: tuple[float, ...] = (1e-4, 1e-4, 0.0, 0.0, 0.0, 1e-3)
    twist_covariance: tuple[float, ...] = (1e-5, 1e-5, 0.0, 0.0, 0.0, 1e-4)
    scan_ns: int = SECOND_NS // 10


def quaternion(yaw_rad: float, tilt: Tilt = LEVEL) -> Quaternion:
    """Return the rotation of a body that is tilted, then turned about z; w >= 0."""
    x, y, z, w = rotation(yaw_rad, tilt)
    return Quaternion(x=x, y=y, z=z, w=w)


def yaw_of(rotation: Quaternion) -> float:
    """Return the yaw in rad of a unit quaternion; NaN if a component is not finite."""
    x, y, z, w = rotation.x, rotation.y, rotation.z, rotation.w
    if not math.isfinite(x * x + y * y + z * z + w * w):
        return math.nan
    return math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))


def proximity_range(
    reading: readings.ProximityReading, names: RobotNames, options: ConvertOptions, *, index: int
) -> Range:
    """Return the range of one proximity sensor as in the driver."""
    fields, value = options.proximity[index], reading.ranges_m[index]
    if options.driver_ranges:
        value = -1.0 if math.isinf(value) else max(value, fields.min_m)
    elif value < fields.min_m:
        value = -math.inf
    message = Range(
        radiation_type=Range.INFRARED,
        field_of_view=fields.fov_rad,
        min_range=fields.min_m,
        max_range=fields.max_m,
        range=value,
    )
    return stamped(message, reading.stamp_ns, names.frame(f"proximity_{PROXIMITY[index]}_link"))


def laser(reading: readings.ProximityReading, names: RobotNames, options: ConvertOptions) -> LaserScan:
    """Return the five front sensors as one scan from right to left; they measure simultaneously: no time increment."""
    message = LaserScan(
        angle_min=-LASER_ANGLE_RAD,
        angle_max=LASER_ANGLE_RAD,
        angle_increment=LASER_STEP_RAD,
        time_increment=0.0,
        scan_time=options.scan_ns / SECOND_NS,
        range_min=PROXIMITY_MIN_M + LASER_OFFSET_M,
        range_max=PROXIMITY_MAX_M + LASER_OFFSET_M,
        ranges=[
            math.inf if math.isinf(range_m) else max(range_m, PROXIMITY_MIN_M) + LASER_OFFSET_M
            for range_m in reading.ranges_m[4::-1]
        ],
        intensities=[float(count) for count in reading.words[4::-1]],
    )
    return stamped(message, reading.stamp_ns, names.frame("laser_link"))


def ground_range(reading: readings.GroundReading, names: RobotNames, options: ConvertOptions, *, index: int) -> Range:
    """Return whether the floor reflects below one ground sensor, as a range."""
    not_reflecting, reflecting = (1.0, 0.0) if options.driver_ranges else (math.inf, -math.inf)
    is_dark = reading.words[4 + index] < options.ground_threshold
    message = Range(
        radiation_type=Range.INFRARED,
        field_of_view=GROUND_FOV_RAD,
        min_range=GROUND_MIN_M,
        max_range=GROUND_MAX_M,
        range=not_reflecting if is_dark else reflecting,
    )
    return stamped(message, reading.stamp_ns, names.frame(f"ground_{SIDES[index]}_link"))


def ground_reflectance(
    reading: readings.GroundReading, _names: RobotNames, _options: ConvertOptions, *, index: int
) -> Float32:
    """Return the part of the light that the floor reflects below one ground sensor: 0 (black) to 1 (white).

    It corresponds to the count of the sensor without ambient light.
    """
    return Float32(data=units.ground_reflectance(reading.words[4 + index]))


def button(reading: readings.ButtonsReading, _names: RobotNames, _options: ConvertOptions, *, index: int) -> Bool:
    """Return whether one button is pressed."""
    return Bool(data=pressed(reading, index=index))


def pressed(reading: readings.ButtonsReading, *, index: int) -> bool:
    """Return whether one button is pressed, as a value to compare."""
    return bool(reading.words[index])


def joy(reading: readings.ButtonsReading, names: RobotNames, _options: ConvertOptions) -> Joy:
    """Return the states of all buttons."""
    return stamped(Joy(buttons=list(reading.words)), reading.stamp_ns, names.frame("base_link"))


def joints(reading: readings.MotorReading, names: RobotNames, _options: ConvertOptions) -> JointState:
    """Return angles and speeds of the wheels."""
    message = JointState(
        name=[names.frame(f"{side}_wheel_joint") for side in SIDES],
        position=list(reading.angles_rad),
        velocity=list(reading.velocities_rad_s),
    )
    return stamped(message, reading.stamp_ns, "")


def odometry(reading: readings.PoseReading, names: RobotNames, options: ConvertOptions) -> Odometry:
    """Return the wheel odometry."""
    message = _odometry_message(reading.odometry, reading.odometry_twist)
    message.pose.covariance[::7] = options.pose_covariance
    message.twist.covariance[::7] = options.twist_covariance
    message.child_frame_id = names.frame("base_link")
    return stamped(message, reading.stamp_ns, names.frame("odom"))


def truth(reading: readings.PoseReading, names: RobotNames, _options: ConvertOptions) -> Odometry:
    """Return the true pose and velocity."""
    message = _odometry_message(reading.truth, reading.truth_twist)
    message.pose.pose.position.z = reading.height_m
    message.pose.pose.orientation = quaternion(reading.truth.yaw_rad, reading.tilt)
    message.child_frame_id = names.frame("base_link")
    return stamped(message, reading.stamp_ns, names.frame(MAP_FRAME))


def _odometry_message(pose: Pose, twist: Twist) -> Odometry:
    message = Odometry()
    message.pose.pose = PoseMsg(position=Point(x=pose.x_m, y=pose.y_m), orientation=quaternion(pose.yaw_rad))
    message.twist = TwistWithCovariance()
    message.twist.twist.linear.x = twist.linear_m_s
    message.twist.twist.angular.z = twist.angular_rad_s
    return message


def leds(reading: readings.LedReading, _names: RobotNames, _options: ConvertOptions) -> Float32MultiArray:
    """Return the intensities of all lights, with a labeled dimension for each group."""
    return Float32MultiArray(
        layout=layout((group, len(levels)) for group, levels in reading.groups),
        data=[level / LED_FULL for _, levels in reading.groups for level in levels],
    )


def sound(reading: readings.LoudspeakerReading, _names: RobotNames, _options: ConvertOptions) -> Float32MultiArray:
    """Return [Hz, s, volume 0…1]: 0 Hz for samples, inf s for a tone without end, zeros for silence."""
    seconds = math.inf if reading.duration_ns is None else reading.duration_ns / SECOND_NS
    parts = layout([("frequency_hz", 1), ("duration_s", 1), ("volume", 1)])
    return Float32MultiArray(layout=parts, data=[reading.frequency_hz, seconds, volume(reading.shift)])


def played_samples(
    reading: readings.LoudspeakerReading, _names: RobotNames, _options: ConvertOptions
) -> UInt8MultiArray | None:
    """Return the samples of a sound that begins; None for a tone."""
    return UInt8MultiArray(data=reading.samples) if reading.samples else None


def played_wave(reading: readings.LoudspeakerReading, _names: RobotNames, _options: ConvertOptions) -> Int8MultiArray:
    """Return the samples of one period of tones."""
    return Int8MultiArray(data=list(reading.wave))


def trail(reading: readings.PenReading, names: RobotNames, _options: ConvertOptions) -> MarkerArray:
    """Return the strokes of the robot's pen as line strips; DELETEALL comes first."""
    message = MarkerArray(markers=[Marker(action=Marker.DELETEALL)])
    for number, stroke in enumerate(reading.strokes):
        red, green, blue = stroke.color
        marker = Marker(ns=f"{names.name}/pen".lstrip("/"), id=number, action=Marker.ADD, type=Marker.LINE_STRIP)
        marker.color = ColorRGBA(r=red, g=green, b=blue, a=1.0)
        marker.scale.x = stroke.width_m
        marker.points = [Point(x=x, y=y, z=TRAIL_M) for x, y in stroke.points]
        message.markers.append(stamped(marker, reading.stamp_ns, names.frame(MAP_FRAME)))
    return message


def volume(shift: int) -> float:
    """Return the loudness 0…1 of samples that lose `shift` bits."""
    return 0.0 if shift >= VOLUME_OFF else 2.0**-shift


def words(reading: readings.Reading, _names: RobotNames, _options: ConvertOptions) -> Int16MultiArray:
    """Return the integers that Aseba programs see."""
    return Int16MultiArray(data=list(reading.words))


def layout(dimensions: Iterable[tuple[str, int]]) -> MultiArrayLayout:
    """Return the layout of a flat array with consecutive labeled parts, from pairs of label and size."""
    return MultiArrayLayout(
        dim=[MultiArrayDimension(label=label, size=size, stride=size) for label, size in dimensions]
    )
