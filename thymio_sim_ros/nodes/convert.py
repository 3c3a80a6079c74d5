"""Readings → messages and messages → commands, one row per topic; nothing else knows what a Range is.

Names, units, frames and QoS are those of ros-interface.md sections 4, 6.3 and 9.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from functools import partial
from operator import attrgetter
from typing import Any

from geometry_msgs.msg import Point, Quaternion, TwistWithCovariance
from geometry_msgs.msg import Pose as PoseMsg
from geometry_msgs.msg import Twist as TwistMsg
from nav_msgs.msg import Odometry
from rclpy.qos import QoSProfile
from sensor_msgs.msg import BatteryState, Imu, JointState, Joy, LaserScan, Range, Temperature
from std_msgs.msg import (
    Bool,
    ColorRGBA,
    Empty,
    Float32,
    Float32MultiArray,
    Int8,
    Int8MultiArray,
    Int16,
    Int16MultiArray,
    MultiArrayDimension,
    MultiArrayLayout,
    UInt8MultiArray,
)
from visualization_msgs.msg import Marker, MarkerArray

from thymio_sim_ros.nodes import patches, qos, senses
from thymio_sim_ros.nodes.headers import SECOND_NS, stamped
from thymio_sim_ros.nodes.names import MAP_FRAME, PROXIMITY, SIDES, RobotNames
from thymio_sim_ros.nodes.patches import LASER_OFFSET_M, PROXIMITY_MIN_M
from thymio_sim_ros.nodes.templates import Patch
from thymio_sim_ros.sim import commands, readings
from thymio_sim_ros.sim.geometry import LEVEL, Pose, Tilt, Twist
from thymio_sim_ros.sim.sensors import Sensor
from thymio_sim_ros.sim.tones import VOLUME_OFF

# The driver's constants of a Range (ros-interface.md section 3).
PROXIMITY_MAX_M, PROXIMITY_FOV_RAD = 0.14, 0.3
GROUND_MIN_M, GROUND_MAX_M, GROUND_FOV_RAD = 0.009, 0.03, 0.3
LASER_STEP_RAD, LASER_ANGLE_RAD = 0.32, 0.64

JOINTS, TRUTH = "joint_states", "ground_truth/odom"

TRAIL_M = 0.0015
"""Height of what pens drew, for viewers: above all paint."""


@dataclass(frozen=True, slots=True)
class RangeFields:
    """What the Range of one proximity sensor says about it: m, m, rad."""

    min_m: float = PROXIMITY_MIN_M
    max_m: float = PROXIMITY_MAX_M
    fov_rad: float = PROXIMITY_FOV_RAD


@dataclass(frozen=True, slots=True)
class ConvertOptions:
    """What a user may choose about the content of messages.

    `driver_ranges`: −1 and minimum instead of ±inf (ros-interface.md section 4.3). `ground_threshold`: count.
    `proximity`: in Thymio's order. Covariance diagonals: x y z roll pitch yaw.
    """

    driver_ranges: bool = False
    ground_threshold: int = 200
    proximity: tuple[RangeFields, ...] = (RangeFields(),) * len(PROXIMITY)
    pose_covariance: tuple[float, ...] = (1e-4, 1e-4, 0.0, 0.0, 0.0, 1e-3)
    twist_covariance: tuple[float, ...] = (1e-5, 1e-5, 0.0, 0.0, 0.0, 1e-4)


Encode = Callable[[Any, RobotNames, ConvertOptions], Any]


@dataclass(frozen=True, slots=True)
class Row:
    """One topic made from one sensor: `encode` gives the message, or None for nothing new.

    `about`: its content and units, for the reference; `frame`: the usual name of its header's frame, if it has one.
    `every_ns`: not more often than that; 0 all. `always`: published also when nobody listens. `on_change`: only when
    this part of a reading differs from what it was.
    """

    topic: str
    type: type
    encode: Encode
    about: str = ""
    frame: str = ""
    profile: QoSProfile = field(default_factory=lambda: qos.SENSOR)
    every_ns: int = 0
    always: bool = False
    on_change: Callable[[Any], Any] | None = None
    is_event: bool = False
    """Whether `encode` gives nothing for most readings."""
    patch: Patch | None = None
    """What a reading changes in the serialised message, for topics with much traffic."""


def quaternion(yaw_rad: float, tilt: Tilt = LEVEL) -> Quaternion:
    """A turn about z, of a body that leans."""
    x, y, z, w = patches.rotation(yaw_rad, tilt)
    return Quaternion(x=x, y=y, z=z, w=w)


def yaw_of(rotation: Quaternion) -> float:
    """Yaw in rad of any unit quaternion."""
    return math.atan2(2 * (rotation.w * rotation.z + rotation.x * rotation.y), 1 - 2 * (rotation.y**2 + rotation.z**2))


def _range(reading: readings.ProximityReading, names: RobotNames, options: ConvertOptions, *, index: int) -> Range:
    said = options.proximity[index]
    message = Range(
        radiation_type=Range.INFRARED,
        field_of_view=said.fov_rad,
        min_range=said.min_m,
        max_range=said.max_m,
        range=patches.seen_m(reading, options, index),
    )
    return stamped(message, reading.stamp_ns, names.frame(f"proximity_{PROXIMITY[index]}_link"))


def _laser(reading: readings.ProximityReading, names: RobotNames, _options: ConvertOptions) -> LaserScan:
    message = LaserScan(
        angle_min=-LASER_ANGLE_RAD,
        angle_max=LASER_ANGLE_RAD,
        angle_increment=LASER_STEP_RAD,
        range_min=PROXIMITY_MIN_M + LASER_OFFSET_M,
        range_max=PROXIMITY_MAX_M + LASER_OFFSET_M,
        ranges=patches.laser_m(reading),
        intensities=[float(count) for count in reading.words[4::-1]],
    )
    return stamped(message, reading.stamp_ns, names.frame("laser_link"))


def _ground(reading: readings.GroundReading, names: RobotNames, options: ConvertOptions, *, index: int) -> Range:
    message = Range(
        radiation_type=Range.INFRARED,
        field_of_view=GROUND_FOV_RAD,
        min_range=GROUND_MIN_M,
        max_range=GROUND_MAX_M,
        range=patches.below_m(reading, options, index),
    )
    return stamped(message, reading.stamp_ns, names.frame(f"ground_{SIDES[index]}_link"))


def _button(reading: readings.ButtonsReading, _names: RobotNames, _options: ConvertOptions, *, index: int) -> Bool:
    return Bool(data=_pressed(reading, index=index))


def _pressed(reading: readings.ButtonsReading, *, index: int) -> bool:
    return bool(reading.words[index])


def _joy(reading: readings.ButtonsReading, names: RobotNames, _options: ConvertOptions) -> Joy:
    return stamped(Joy(buttons=list(reading.words)), reading.stamp_ns, names.frame("base_link"))


def _joints(reading: readings.MotorReading, names: RobotNames, _options: ConvertOptions) -> JointState:
    message = JointState(
        name=[names.frame(f"{side}_wheel_joint") for side in SIDES],
        position=list(reading.angles_rad),
        velocity=list(reading.velocities_rad_s),
    )
    return stamped(message, reading.stamp_ns, "")


def _odometry(reading: readings.PoseReading, names: RobotNames, options: ConvertOptions) -> Odometry:
    message = _odometry_message(reading.odometry, reading.odometry_twist, options.pose_covariance, options)
    message.child_frame_id = names.frame("base_link")
    return stamped(message, reading.stamp_ns, names.frame("odom"))


def _truth(reading: readings.PoseReading, names: RobotNames, options: ConvertOptions) -> Odometry:
    message = _odometry_message(reading.truth, reading.truth_twist, (0.0,) * 6, options)
    message.pose.pose.orientation = quaternion(reading.truth.yaw_rad, reading.tilt)
    message.child_frame_id = names.frame("base_link")
    return stamped(message, reading.stamp_ns, names.frame(MAP_FRAME))


def _odometry_message(pose: Pose, twist: Twist, covariance: tuple[float, ...], options: ConvertOptions) -> Odometry:
    message = Odometry()
    message.pose.pose = PoseMsg(position=Point(x=pose.x_m, y=pose.y_m), orientation=quaternion(pose.yaw_rad))
    message.pose.covariance[::7] = covariance
    message.twist = TwistWithCovariance()
    message.twist.twist.linear.x = twist.linear_m_s
    message.twist.twist.angular.z = twist.angular_rad_s
    message.twist.covariance[::7] = options.twist_covariance if any(covariance) else covariance
    return message


def _leds(reading: readings.LedReading, _names: RobotNames, _options: ConvertOptions) -> Float32MultiArray:
    return Float32MultiArray(
        layout=layout((group, len(levels)) for group, levels in reading.groups),
        data=[level / commands.LED_FULL for _, levels in reading.groups for level in levels],
    )


def _sound(reading: readings.LoudspeakerReading, _names: RobotNames, _options: ConvertOptions) -> Float32MultiArray:
    """[Hz, s, volume 0…1]: 0 Hz for samples, inf s for a tone without end, zeros for silence."""
    seconds = math.inf if reading.duration_ns is None else reading.duration_ns / SECOND_NS
    parts = layout([("frequency_hz", 1), ("duration_s", 1), ("volume", 1)])
    return Float32MultiArray(layout=parts, data=[reading.frequency_hz, seconds, volume(reading.shift)])


def _heard_samples(reading: readings.LoudspeakerReading, _names: RobotNames, _options: ConvertOptions) -> Any:
    return UInt8MultiArray(data=reading.samples) if reading.samples else None


def _heard_wave(reading: readings.LoudspeakerReading, _names: RobotNames, _options: ConvertOptions) -> Int8MultiArray:
    return Int8MultiArray(data=list(reading.wave))


def _trail(reading: readings.PenReading, names: RobotNames, _options: ConvertOptions) -> MarkerArray:
    """What the robot's pen drew, a line strip for each stroke; DELETEALL comes first."""
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
    """Loudness 0…1 of samples that lose so many bits."""
    return 0.0 if shift >= VOLUME_OFF else 2.0**-shift


def _words(reading: Any, _names: RobotNames, _options: ConvertOptions) -> Int16MultiArray:
    return Int16MultiArray(data=list(reading.words))


def layout(dimensions: Iterable[tuple[str, int]]) -> MultiArrayLayout:
    """Labelled parts of one flat array, one after the other."""
    return MultiArrayLayout(
        dim=[MultiArrayDimension(label=label, size=size, stride=size) for label, size in dimensions]
    )


ROWS: dict[str, tuple[Row, ...]] = {
    "ground": (
        *(
            Row(
                f"ground/{side}",
                Range,
                partial(_ground, index=i),
                "-inf: the floor reflects, +inf: it does not; as the driver has it 0 and 1",
                f"ground_{side}_link",
                patch=patches.below_patch(i),
            )
            for i, side in enumerate(SIDES)
        ),
    ),
    "proximity": (
        *(
            Row(
                f"proximity/{name}",
                Range,
                partial(_range, index=i),
                "distance in m of a wall; +inf: nothing, -inf: too close; as the driver has it -1 and the minimum",
                f"proximity_{name}_link",
                patch=patches.seen_patch(i),
            )
            for i, name in enumerate(PROXIMITY)
        ),
        Row(
            "proximity/laser",
            LaserScan,
            _laser,
            "the five front sensors from right to left, m from the robot's middle; intensities are counts",
            "laser_link",
            patch=patches.LASER,
        ),
        Row(
            "proximity/rays",
            Marker,
            senses.rays,
            "the seven rays as lines, as long as what they measure; red where something is met",
            "base_link",
            patch=patches.RAYS,
        ),
    ),
    "buttons": (
        *(
            Row(
                f"buttons/{name}",
                Bool,
                partial(_button, index=i),
                "true while it is pressed",
                on_change=partial(_pressed, index=i),
                always=True,
            )
            for i, name in enumerate(commands.BUTTONS)
        ),
        Row(
            "buttons",
            Joy,
            _joy,
            "backward, left, center, forward, right",
            "base_link",
            every_ns=SECOND_NS // 10,
            patch=patches.JOY,
        ),
    ),
    "motor": (
        Row(
            JOINTS,
            JointState,
            _joints,
            "wheel angles in rad, not wrapped, and speeds in rad/s, left then right",
            every_ns=SECOND_NS // 20,
            patch=patches.JOINTS,
        ),
    ),
    "pose": (
        Row(
            "odom",
            Odometry,
            _odometry,
            "by the wheels, from zero; they slip",
            "odom",
            patch=patches.ODOMETRY,
        ),
        Row(TRUTH, Odometry, _truth, "where the robot really is", MAP_FRAME, patch=patches.TRUTH),
    ),
    "leds": (
        Row(
            "led/state",
            Float32MultiArray,
            _leds,
            "brightness 0…1 of every light, a labelled dimension for each group",
            profile=qos.LATCHED,
            always=True,
        ),
    ),
    "accelerometer": (
        Row("imu", Imu, senses.imu, "acceleration alone, m/s²; g upwards at rest", "base_link", patch=patches.IMU),
    ),
    "temperature": (
        Row("temperature", Temperature, senses.temperature, "°C, in tenths", "base_link", patch=patches.TEMPERATURE),
    ),
    "battery": (
        Row(
            "battery",
            BatteryState,
            senses.battery,
            "V, charge 0…1, charging or not",
            "base_link",
            patch=patches.BATTERY,
        ),
    ),
    "collision": (
        Row(
            "collision",
            Bool,
            senses.collision,
            "whether anything but the floor is touched",
            on_change=attrgetter("is_touching"),
            always=True,
        ),
    ),
    "tap": (Row("tap", Empty, senses.tap, "a shock was felt"),),
    "sound": (Row("sound", Float32, senses.sound, "loudness 0…1 above `sound_threshold`", is_event=True),),
    "remote": (Row("remote", Int8, senses.remote, "command 0…127 of a key of an RC5 remote control"),),
    "comm": (Row("comm/received", Int16, senses.received, "value of an infrared frame"),),
    "pen": (
        Row(
            "pen/trail",
            MarkerArray,
            _trail,
            "what the pen drew, a line strip for each stroke",
            profile=qos.LATCHED,
            always=True,
        ),
    ),
    "loudspeaker": (
        Row(
            "sound/state/wave",
            Int8MultiArray,
            _heard_wave,
            "the period that tones are made of, 142 samples",
            profile=qos.LATCHED,
            always=True,
            on_change=attrgetter("wave"),
        ),
        Row(
            "sound/state/samples",
            UInt8MultiArray,
            _heard_samples,
            "unsigned 8 bit at 7812.5 Hz of a sound that begins",
            profile=qos.EVENTS,
        ),
        Row(
            "sound/state",
            Float32MultiArray,
            _sound,
            "Hz, s, volume 0…1 of what plays; zeros for silence",
            profile=qos.LATCHED,
            always=True,
        ),
    ),
}
"""Sensor name → topics in SI units. Besides, every sensor that Aseba sees has `raw/<sensor>`."""


def rows_of(sensor: Sensor) -> tuple[Row, ...]:
    """Topics of a sensor; one added by a plug-in has those of its words."""
    variables = ", ".join(f"`{name}`" if size == 1 else f"`{name}[{size}]`" for name, size in sensor.aseba.variables)
    about = f"Aseba's integers: {variables}" if variables else "the event, without values"
    count = sum(size for _, size in sensor.aseba.variables)
    is_seen = sensor.aseba.variables or sensor.aseba.event
    raw = (
        (Row(f"raw/{sensor.name}", Int16MultiArray, _words, about, patch=patches.words_patch(count)),)
        if is_seen
        else ()
    )
    return ROWS.get(sensor.name, ()) + raw


RARE: Mapping[str, str] = {
    "collision": "change",
    "comm": "event",
    "current": "change",
    "leds": "change",
    "loudspeaker": "change",
    "pen": "change",
    "remote": "event",
    "sound_finished": "event",
    "tap": "event",
}
"""When sensors give readings that look for something now and then."""


def is_regular(sensor: Sensor, row: Row) -> bool:
    """Whether a row of a sensor is sent again and again, and not when something happens."""
    return not (row.is_event or row.on_change or sensor.name in RARE)


def often(sensor: Sensor, row: Row) -> str:
    """How often a row of a sensor is sent: in Hz, on a change, or when something happens."""
    if not is_regular(sensor, row):
        return "event" if row.is_event else RARE.get(sensor.name, "change")
    return f"{SECOND_NS / max(sensor.period_ns, row.every_ns):.3g}"


class CommandError(ValueError):
    """A message that is refused; the text says what was found and what was expected."""


def body_twist(message: TwistMsg, timeout_ns: int) -> commands.BodyTwist:
    """geometry_msgs/Twist → command; linear.x and angular.z count. NaN and inf are refused."""
    finite(message.linear.x, "linear.x")
    finite(message.angular.z, "angular.z")
    return commands.BodyTwist(message.linear.x, message.angular.z, timeout_ns)


def wheel_velocities(data: Any, timeout_ns: int) -> commands.WheelVelocities:
    """[left, right] in rad/s → command."""
    values = sized(data, 2, "[left, right] in rad/s")
    for value in values:
        finite(value, "wheel speed")
    return commands.WheelVelocities(float(values[0]), float(values[1]), timeout_ns)


def motor_targets(data: Any) -> commands.MotorTargets:
    """[left, right] in Thymio units → command."""
    left, right = sized(data, 2, "[left, right] in Thymio units")
    return commands.MotorTargets(int(left), int(right))


def led_levels(group: str, intensities: Any) -> commands.SetLeds:
    """Intensities 0…1 → command with levels 0…32; clamped; fewer than the group has are refused."""
    size = commands.LED_GROUPS[group]
    values = sized(intensities, size, f"{size} intensities 0…1")
    for value in values:
        finite(value, "intensity")
    return commands.SetLeds(group, tuple(round(min(max(v, 0.0), 1.0) * commands.LED_FULL) for v in values))


def sized(data: Any, size: int, what: str) -> list[Any]:
    """The values of an array of this size; CommandError for another."""
    values = list(data)
    if len(values) != size:
        raise CommandError(f"{len(values)} values found, expected {what}")
    return values


def finite(value: float, what: str) -> None:
    """CommandError for NaN and infinities."""
    if not math.isfinite(value):
        raise CommandError(f"{what} is {value}, expected a finite number")
