"""Conversions of the readings of smaller sensors to messages (docs/spec/ros-interface.md sections 3 and 4.1)."""

from __future__ import annotations

import math
from array import array

from geometry_msgs.msg import Point
from sensor_msgs.msg import BatteryState, Imu, LaserScan, Temperature
from std_msgs.msg import Bool, ColorRGBA, Empty, Float32, Int8, Int16
from visualization_msgs.msg import Marker

from thymio_sim_ros.ros.interface.headers import stamped
from thymio_sim_ros.ros.interface.names import SCAN_FRAME, RobotNames
from thymio_sim_ros.sim.model import readings
from thymio_sim_ros.sim.model.lidar import LIDAR_MIN_M
from thymio_sim_ros.sim.model.robot_constants import PROXIMITY_HEIGHT_M, PROXIMITY_POSES, PROXIMITY_RANGE_M

ACCELERATION_VARIANCE = 0.07
TEMPERATURE_VARIANCE = 0.01
"""Variances of the ROS driver (docs/spec/ros-interface.md section 3)."""

ABSENT = -1.0
"""First element of the covariance of a quantity that an Imu does not measure (REP 145)."""


RAY_WIDTH_M = 0.003
FREE, HIT = ColorRGBA(r=0.45, g=0.75, b=1.0, a=0.6), ColorRGBA(r=1.0, g=0.3, b=0.2, a=1.0)
"""Colors of rays without and with an obstacle."""


def rays(reading: readings.ProximityReading, names: RobotNames, _options: object) -> Marker:
    """Return the seven rays of the proximity sensors as lines of the measured length, for viewers."""
    marker = Marker(ns="rays", action=Marker.ADD, type=Marker.LINE_LIST, frame_locked=True)
    marker.scale.x = RAY_WIDTH_M
    for (x, y, yaw), range_m in zip(PROXIMITY_POSES, reading.ranges_m, strict=True):
        is_free = math.isinf(range_m)
        length = PROXIMITY_RANGE_M if is_free else range_m
        end_x, end_y = x + length * math.cos(yaw), y + length * math.sin(yaw)
        marker.points += [Point(x=x, y=y, z=PROXIMITY_HEIGHT_M), Point(x=end_x, y=end_y, z=PROXIMITY_HEIGHT_M)]
        marker.colors += [FREE if is_free else HIT] * 2
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
        power_supply_status=(
            BatteryState.POWER_SUPPLY_STATUS_CHARGING
            if reading.is_charging
            else BatteryState.POWER_SUPPLY_STATUS_DISCHARGING
        ),
        power_supply_technology=BatteryState.POWER_SUPPLY_TECHNOLOGY_LIPO,
        present=True,
    )
    return stamped(message, reading.stamp_ns, names.frame("base_link"))


def scan(reading: readings.LidarReading, names: RobotNames, _options: object) -> LaserScan:
    """Return the distances of the lidar; all beams measure at once: no time increment, no intensities."""
    lidar = reading.lidar
    message = LaserScan(
        angle_min=0.0,
        angle_max=(lidar.beams - 1) * lidar.step_rad,
        angle_increment=lidar.step_rad,
        time_increment=0.0,
        scan_time=1.0 / lidar.rate_hz,
        range_min=LIDAR_MIN_M,
        range_max=lidar.range_m,
        ranges=array("f", reading.ranges_m),
    )
    return stamped(message, reading.stamp_ns, names.frame(SCAN_FRAME))


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
