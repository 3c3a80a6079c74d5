"""Conversions of the readings of smaller sensors to messages (docs/spec/ros-interface.md sections 3 and 4.1)."""

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
"""Variances of the ROS driver (docs/spec/ros-interface.md section 3)."""

ABSENT = -1.0
"""First element of the covariance of a quantity that an Imu does not measure (REP 145)."""


RAY_WIDTH_M = 0.003


def rays(reading: readings.ProximityReading, names: RobotNames, _options: object) -> Marker:
    """Return the seven rays of the proximity sensors as lines of the measured length, for viewers."""
    marker = Marker(ns="rays", action=Marker.ADD, type=Marker.LINE_LIST, frame_locked=True)
    marker.scale.x = RAY_WIDTH_M
    ends, colors = cdr_fields.ray_lines(reading)
    marker.points = [Point(x=x, y=y, z=z) for x, y, z in ends]
    marker.colors = [ColorRGBA(r=r, g=g, b=b, a=a) for r, g, b, a in colors]
    return stamped(marker, reading.stamp_ns, names.frame("base_link"))


def imu(reading: readings.AccelerometerReading, names: RobotNames, _options: object) -> Imu:
    """Return the acceleration along forward, left and up; all other quantities are marked as absent."""
    message = Imu()
    message.orientation_covariance[0] = message.angular_velocity_covariance[0] = ABSENT
    vector = message.linear_acceleration
    vector.x, vector.y, vector.z = reading.acceleration_m_s2
    message.linear_acceleration_covariance[::4] = (ACCELERATION_VARIANCE,) * 3
    return stamped(message, reading.stamp_ns, names.frame("base_link"))


def temperature(reading: readings.TemperatureReading, names: RobotNames, _options: object) -> Temperature:
    """Return the temperature in °C, with the robot's resolution of 0.1 °C."""
    message = Temperature(temperature=reading.words[0] / 10, variance=TEMPERATURE_VARIANCE)
    return stamped(message, reading.stamp_ns, names.frame("base_link"))


def battery(reading: readings.BatteryReading, names: RobotNames, _options: object) -> BatteryState:
    """Return voltage and charge; quantities that the robot does not measure are NaN."""
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
    """Return the message of a tap."""
    return Empty()


def sound(reading: readings.SoundReading, _names: RobotNames, _options: object) -> Float32 | None:
    """Return the intensity 0…1 of a sound above the threshold, or None."""
    return Float32(data=reading.words[0] / 255) if reading.is_loud else None


def remote(reading: readings.RemoteReading, _names: RobotNames, _options: object) -> Int8:
    """Return the command of a remote control frame."""
    return Int8(data=reading.words[1])


def received(reading: readings.CommReading, _names: RobotNames, _options: object) -> Int16:
    """Return the value of an infrared frame."""
    return Int16(data=reading.words[0])


def collision(reading: readings.CollisionReading, _names: RobotNames, _options: object) -> Bool:
    """Return whether the robot touches something."""
    return Bool(data=reading.is_touching)
