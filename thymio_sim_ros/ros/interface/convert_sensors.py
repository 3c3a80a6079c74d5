"""Messages of the senses besides proximity and ground (docs/spec/ros-interface.md sections 3 and 4.1)."""

from __future__ import annotations

import math

from geometry_msgs.msg import Point
from sensor_msgs.msg import BatteryState, Imu, Temperature
from std_msgs.msg import Bool, ColorRGBA, Empty, Float32, Int8, Int16
from visualization_msgs.msg import Marker

from thymio_sim_ros.ros.interface import cdr_fields
from thymio_sim_ros.ros.interface.headers import stamped
from thymio_sim_ros.ros.interface.names import RobotNames
from thymio_sim_ros.sim.model import readings

ACCELERATION_VARIANCE = 0.07
TEMPERATURE_VARIANCE = 0.01
"""As the robot's driver has them (docs/spec/ros-interface.md section 3)."""

ABSENT = -1.0
"""First element of the covariance of a quantity that an Imu does not measure (REP 145)."""


RAY_WIDTH_M = 0.003


def rays(reading: readings.ProximityReading, names: RobotNames, _options: object) -> Marker:
    """The seven rays of the proximity sensors as lines, as long as what they measure, for viewers."""
    marker = Marker(ns="rays", action=Marker.ADD, type=Marker.LINE_LIST, frame_locked=True)
    marker.scale.x = RAY_WIDTH_M
    ends, colors = cdr_fields.ray_lines(reading)
    marker.points = [Point(x=x, y=y, z=z) for x, y, z in ends]
    marker.colors = [ColorRGBA(r=r, g=g, b=b, a=a) for r, g, b, a in colors]
    return stamped(marker, reading.stamp_ns, names.frame("base_link"))


def imu(reading: readings.AccelerometerReading, names: RobotNames, _options: object) -> Imu:
    """Acceleration alone, forward, left, up."""
    message = Imu()
    message.orientation_covariance[0] = message.angular_velocity_covariance[0] = ABSENT
    vector = message.linear_acceleration
    vector.x, vector.y, vector.z = reading.acceleration_m_s2
    message.linear_acceleration_covariance[::4] = (ACCELERATION_VARIANCE,) * 3
    return stamped(message, reading.stamp_ns, names.frame("base_link"))


def temperature(reading: readings.TemperatureReading, names: RobotNames, _options: object) -> Temperature:
    """Degrees Celsius as the robot tells them, in tenths."""
    message = Temperature(temperature=reading.words[0] / 10, variance=TEMPERATURE_VARIANCE)
    return stamped(message, reading.stamp_ns, names.frame("base_link"))


def battery(reading: readings.BatteryReading, names: RobotNames, _options: object) -> BatteryState:
    """Voltage and charge; what the robot does not measure is NaN."""
    message = BatteryState(
        voltage=reading.volts,
        percentage=reading.charge,
        temperature=math.nan,
        current=math.nan,
        charge=math.nan,
        capacity=math.nan,
        design_capacity=math.nan,
        power_supply_status=cdr_fields.charging_status(reading),
        power_supply_technology=BatteryState.POWER_SUPPLY_TECHNOLOGY_LIPO,
        present=True,
    )
    return stamped(message, reading.stamp_ns, names.frame("base_link"))


def tap(_reading: readings.TapReading, _names: RobotNames, _options: object) -> Empty:
    """A shock."""
    return Empty()


def sound(reading: readings.SoundReading, _names: RobotNames, _options: object) -> Float32 | None:
    """Intensity 0…1 of what is above the threshold."""
    return Float32(data=reading.words[0] / 255) if reading.is_loud else None


def remote(reading: readings.RemoteReading, _names: RobotNames, _options: object) -> Int8:
    """The command of a frame."""
    return Int8(data=reading.words[1])


def received(reading: readings.CommReading, _names: RobotNames, _options: object) -> Int16:
    """The value of an infrared frame."""
    return Int16(data=reading.words[0])


def collision(reading: readings.CollisionReading, _names: RobotNames, _options: object) -> Bool:
    """Whether something is touched."""
    return Bool(data=reading.is_touching)
