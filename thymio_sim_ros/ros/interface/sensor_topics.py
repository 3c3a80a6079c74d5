"""Topics of all sensors, one row each, with their rates.

Names, units, frames and QoS are those of docs/spec/ros-interface.md sections 4, 6.3 and 9.
"""

from __future__ import annotations

import builtins
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from operator import attrgetter
from typing import TYPE_CHECKING, Any, TypeVar

from nav_msgs.msg import Odometry
from rclpy.qos import QoSProfile
from sensor_msgs.msg import BatteryState, Imu, JointState, Joy, LaserScan, Range, Temperature
from std_msgs.msg import (
    Bool,
    Empty,
    Float32,
    Float32MultiArray,
    Int8,
    Int8MultiArray,
    Int16,
    Int16MultiArray,
    UInt8MultiArray,
)
from visualization_msgs.msg import Marker, MarkerArray

from thymio_sim_ros.ros.interface import convert_readings, convert_sensors, qos
from thymio_sim_ros.ros.interface.convert_readings import ConvertOptions
from thymio_sim_ros.ros.interface.headers import SECOND_NS
from thymio_sim_ros.ros.interface.names import MAP_FRAME, PROXIMITY, SCAN_FRAME, SIDES, RobotNames, raw_topic
from thymio_sim_ros.sim import commands
from thymio_sim_ros.sim.audio.synthesis import TRIANGLE
from thymio_sim_ros.sim.model.lidar import LIDAR
from thymio_sim_ros.sim.model.readings import LoudspeakerReading, PenReading, Reading
from thymio_sim_ros.sim.sensors import Sensor

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.messages.message_class import Message

JOINTS, TRUTH, SCAN = "joint_states", "_ground_truth/odom", "scan"

M = TypeVar("M", bound="Message")

Encode = Callable[[Any, RobotNames, ConvertOptions], "Message | None"]


@dataclass(frozen=True, slots=True)
class Row:
    """One topic of one sensor; `encode` returns the message, or None if there is nothing to publish.

    `about`: content and units, for docs/ros.md. `frame`: default name of the frame in the header, if there is one.
    `every_ns`: shortest period; 0 publishes all readings. `always`: published also without subscribers. `on_change`:
    published only if this part of the reading has changed.
    """

    topic: str
    type: type[Message]
    encode: Encode
    about: str = ""
    frame: str = ""
    profile: QoSProfile = field(default_factory=lambda: qos.SENSOR)
    every_ns: int = 0
    always: bool = False
    on_change: Callable[[Any], object] | None = None
    is_event: bool = False
    """Whether `encode` returns None for most readings."""

    if TYPE_CHECKING:  # the parts fit each other; a generic class would not be checked within a tuple of rows

        def __init__(
            self,
            topic: str,
            type: builtins.type[M],  # noqa: A002  # the name of the field
            encode: Callable[[Any, RobotNames, ConvertOptions], M | None],
            about: str = "",
            frame: str = "",
            profile: QoSProfile = ...,
            every_ns: int = 0,
            always: bool = False,
            on_change: Callable[[Any], object] | None = None,
            is_event: bool = False,
        ) -> None: ...


ROWS: dict[str, tuple[Row, ...]] = {
    "ground": (
        *(
            Row(
                f"ground/{side}",
                Range,
                partial(convert_readings.ground_range, index=i),
                "-inf: the floor reflects, +inf: it does not; in the driver 0 and 1",
                f"ground_{side}_link",
            )
            for i, side in enumerate(SIDES)
        ),
        *(
            Row(
                f"ground/{side}/reflectance",
                Float32,
                partial(convert_readings.ground_reflectance, index=i),
                "gray value of the floor measured by the sensor: 0 black (or no floor), 1 white",
            )
            for i, side in enumerate(SIDES)
        ),
    ),
    "proximity": (
        *(
            Row(
                f"proximity/{name}",
                Range,
                partial(convert_readings.proximity_range, index=i),
                "distance in m; +inf: no obstacle, -inf: too close; in the driver -1 and the minimum",
                f"proximity_{name}_link",
            )
            for i, name in enumerate(PROXIMITY)
        ),
        Row(
            "_proximity/laser",
            LaserScan,
            convert_readings.laser,
            "the five front sensors from right to left, m from the center of the robot; intensities are counts",
            "laser_link",
        ),
        Row(
            "_proximity/rays",
            Marker,
            convert_sensors.rays,
            "the seven rays as lines of the measured length; red if there is an obstacle",
            "base_link",
        ),
    ),
    "buttons": (
        *(
            Row(
                f"buttons/{name}",
                Bool,
                partial(convert_readings.button, index=i),
                "true while it is pressed",
                on_change=partial(convert_readings.pressed, index=i),
                always=True,
            )
            for i, name in enumerate(commands.BUTTONS)
        ),
        Row(
            "_buttons",
            Joy,
            convert_readings.joy,
            "backward, left, center, forward, right",
            "base_link",
            every_ns=SECOND_NS // 10,
        ),
    ),
    "motor": (
        Row(
            JOINTS,
            JointState,
            convert_readings.joints,
            "wheel angles in rad, not wrapped, and speeds in rad/s, left then right",
            every_ns=SECOND_NS // 20,
        ),
    ),
    "pose": (
        Row(
            "odom",
            Odometry,
            convert_readings.odometry,
            "wheel odometry, from zero; with slip",
            "odom",
        ),
        Row(TRUTH, Odometry, convert_readings.truth, "true pose and velocity", MAP_FRAME),
    ),
    "leds": (
        Row(
            "_led/state",
            Float32MultiArray,
            convert_readings.leds,
            "brightness 0…1 of every light, a labeled dimension for each group",
            profile=qos.TRANSIENT_LOCAL,
            always=True,
        ),
    ),
    "accelerometer": (
        Row(
            "imu",
            Imu,
            convert_sensors.imu,
            "acceleration alone, m/s²; g upwards at rest",
            "base_link",
        ),
    ),
    "temperature": (
        Row(
            "_temperature",
            Temperature,
            convert_sensors.temperature,
            "°C, in tenths",
            "base_link",
        ),
    ),
    "battery": (
        Row(
            "_battery",
            BatteryState,
            convert_sensors.battery,
            "V, charge 0…1, charging or not",
            "base_link",
        ),
    ),
    "collision": (
        Row(
            "_collision",
            Bool,
            convert_sensors.collision,
            "whether the robot touches anything except the floor",
            on_change=attrgetter("is_touching"),
            always=True,
        ),
    ),
    "tap": (Row("_tap", Empty, convert_sensors.tap, "a tap was detected"),),
    "sound": (Row("_sound", Float32, convert_sensors.sound, "loudness 0…1 above `_sound_threshold`", is_event=True),),
    "remote": (Row("_remote", Int8, convert_sensors.remote, "command 0…127 of a key of an RC5 remote control"),),
    "comm": (Row("_comm/received", Int16, convert_sensors.received, "value of an infrared frame"),),
    LIDAR: (
        Row(
            SCAN,
            LaserScan,
            convert_sensors.scan,
            "the lidar, only with `--lidar`: m, counter-clockwise from the front; +inf: nothing within range",
            SCAN_FRAME,
        ),
    ),
    "pen": (
        Row(
            "_pen/trail",
            MarkerArray,
            convert_readings.trail,
            "what the pen drew, a line strip for each stroke",
            profile=qos.TRANSIENT_LOCAL,
            always=True,
        ),
    ),
    "loudspeaker": (
        Row(
            "_sound/state/wave",
            Int8MultiArray,
            convert_readings.played_wave,
            "the period that tones are made of, 142 samples",
            profile=qos.TRANSIENT_LOCAL,
            always=True,
            on_change=attrgetter("wave"),
        ),
        Row(
            "_sound/state/samples",
            UInt8MultiArray,
            convert_readings.played_samples,
            "unsigned 8 bit at 7812.5 Hz of a sound that begins",
            profile=qos.EVENTS,
        ),
        Row(
            "_sound/state",
            Float32MultiArray,
            convert_readings.sound,
            "Hz, s, volume 0…1 of what plays; zeros for silence",
            profile=qos.TRANSIENT_LOCAL,
            always=True,
        ),
    ),
}
"""Topics in SI units by sensor name. In addition, every sensor with Aseba variables or an event has `_raw/<sensor>`."""


AT_START: Mapping[str, Reading] = {
    "pen": PenReading(0, (), False, (0.0, 0.0, 0.0), 0.0, False, ()),
    "loudspeaker": LoudspeakerReading(0, (), 0, 0.0, 0, TRIANGLE, b"", 0),
}
"""Readings at the start for sensors that report changes only."""


def rows_of(sensor: Sensor) -> tuple[Row, ...]:
    """Return the topics of a sensor; sensors of plug-ins have the raw topic only."""
    variables = ", ".join(f"`{name}`" if size == 1 else f"`{name}[{size}]`" for name, size in sensor.aseba.variables)
    about = f"Aseba's integers: {variables}" if variables else "the event, without values"
    about += "".join(f", then {name}" for name in sensor.aseba.unseen)
    is_seen = sensor.aseba.variables or sensor.aseba.event
    raw = (
        (
            Row(
                raw_topic(sensor.name),
                Int16MultiArray,
                convert_readings.words,
                about,
            ),
        )
        if is_seen
        else ()
    )
    return ROWS.get(sensor.name, ()) + raw


IRREGULAR: Mapping[str, str] = {
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
"""Sensors without periodic readings: whether they publish on change or on an event."""


def is_periodic(sensor: Sensor, row: Row) -> bool:
    """Whether a row is published periodically, rather than on change or on an event."""
    return not (row.is_event or row.on_change or sensor.name in IRREGULAR)


def rate(sensor: Sensor, row: Row) -> str:
    """Return the rate of a row: a number in Hz, "change" or "event"."""
    if not is_periodic(sensor, row):
        return "event" if row.is_event else IRREGULAR.get(sensor.name, "change")
    return f"{SECOND_NS / max(sensor.period_ns, row.every_ns):.3g}"
