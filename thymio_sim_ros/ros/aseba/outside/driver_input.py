"""Converts topics of the Thymio's ROS driver back to integer readings.

Source: docs/spec/ros-interface.md section 3.

Values that the driver does not publish stay zero (`MISSING`). Single ranges are assembled to one reading when all have
arrived, or when one arrives a second time.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING, Protocol, TypeVar

from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node
from rclpy.subscription import Subscription
from sensor_msgs.msg import Imu, Range, Temperature
from std_msgs.msg import Bool, Empty, Float32, Int8, Int16

from thymio_sim_ros.ros.interface import qos
from thymio_sim_ros.ros.interface.names import PROXIMITY, SIDES, RobotNames
from thymio_sim_ros.sim.commands import BUTTONS, MotorTargets
from thymio_sim_ros.sim.model import units
from thymio_sim_ros.sim.model.robot_constants import WHEEL_TRACK_M

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.messages.message_class import Message

__all__ = ["MISSING", "Feed", "proximity_count", "subscribe", "twist_of"]

Feed = Callable[[str, Sequence[int]], None]
"""Receives the integer reading of a sensor."""

MISSING = (
    "the ROS driver does not publish ambient light, intensities of infrared communication, raw buttons and the address "
    "of the remote control: these stay 0"
)
"""Inputs that programs do not get, as text for the user."""

M = TypeVar("M", bound="Message")


class _Listen(Protocol):
    """Subscribes to a topic of the robot."""

    def __call__(self, topic: str, kind: type[M], handle: Callable[[M], object]) -> Subscription: ...


FULL_SOUND = 255
COMM_SENSORS = 7
_REFLECTING, _DARK = (round(units.ground_response(gray)) for gray in (1.0, 0.0))


class _ReadingAssembler:
    """Assembles single values to one reading."""

    def __init__(self, size: int, finish: Callable[[Sequence[int]], None]) -> None:
        self._values = [0] * size
        self._seen: set[int] = set()
        self._finish = finish

    def add(self, index: int, value: int) -> None:
        """Store a value; the reading is complete with the last one, or when a value repeats before the others came."""
        if index in self._seen:
            self._flush()
        self._values[index] = value
        self._seen.add(index)
        if len(self._seen) == len(self._values):
            self._flush()

    def _flush(self) -> None:
        self._seen.clear()
        self._finish(self._values)


def subscribe(node: Node, names: RobotNames, feed: Feed) -> list[Subscription]:
    """Subscribe to the driver topics of one robot and return the subscriptions."""

    def listen(topic: str, kind: type[M], handle: Callable[[M], object]) -> Subscription:
        return node.create_subscription(kind, names.topic(topic), handle, qos.SENSOR)

    return [*_ranges(listen, feed), *_buttons(listen, feed), *_others(listen, feed)]


def twist_of(command: MotorTargets) -> Twist:
    """Return the body velocity for wheel targets."""
    left, right = units.units_to_speed(command.left), units.units_to_speed(command.right)
    twist = Twist()
    twist.linear.x, twist.angular.z = (left + right) / 2.0, (right - left) / WHEEL_TRACK_M
    return twist


def proximity_count(message: Range) -> int:
    """Return the sensor count of a range: 0 for no obstacle (+inf, driver: -1), the maximum for too close (-inf)."""
    value = message.range
    if math.isnan(value) or value in (-1.0, math.inf) or value > message.max_range:
        return 0
    return units.PROXIMITY_FULL if value <= message.min_range else round(units.proximity_response(value))


def _is_reflecting(message: Range) -> bool:
    """Whether the ground reflects: -inf or 0 means yes, +inf or 1 no."""
    return bool(message.range < message.min_range)


def _ranges(listen: _Listen, feed: Feed) -> Iterator[Subscription]:
    ground = _ReadingAssembler(len(SIDES), lambda counts: feed("ground", (0, 0, *counts, *counts)))
    proximity = _ReadingAssembler(len(PROXIMITY), partial(feed, "proximity"))
    for index, side in enumerate(SIDES):
        yield listen(f"ground/{side}", Range, partial(_set_ground, ground, index))
    for index, name in enumerate(PROXIMITY):
        yield listen(f"proximity/{name}", Range, partial(_set_proximity, proximity, index))


def _set_ground(ground: _ReadingAssembler, index: int, message: Range) -> None:
    ground.add(index, _REFLECTING if _is_reflecting(message) else _DARK)


def _set_proximity(proximity: _ReadingAssembler, index: int, message: Range) -> None:
    proximity.add(index, proximity_count(message))


def _buttons(listen: _Listen, feed: Feed) -> Iterator[Subscription]:
    pressed = [0] * len(BUTTONS)

    def on_button(message: Bool, index: int) -> None:
        pressed[index] = int(message.data)
        feed("buttons", pressed)

    for index, name in enumerate(BUTTONS):
        yield listen(f"buttons/{name}", Bool, partial(on_button, index=index))


def _others(listen: _Listen, feed: Feed) -> Iterator[Subscription]:
    yield listen("imu", Imu, lambda message: feed("accelerometer", _acceleration(message)))
    yield listen(
        "temperature", Temperature, lambda message: feed("temperature", [units.celsius_to_units(message.temperature)])
    )
    yield listen("tap", Empty, lambda _message: feed("tap", [1]))
    yield listen("sound", Float32, lambda message: feed("sound", [round(message.data * FULL_SOUND), 0]))
    yield listen("remote", Int8, lambda message: feed("remote", [0, message.data]))
    yield listen("comm/received", Int16, lambda message: feed("comm", [message.data, *[0] * (2 * COMM_SENSORS)]))
    yield listen("odom", Odometry, lambda message: feed("motor", _wheels(message)))


def _acceleration(message: Imu) -> list[int]:
    """Return `acc`, whose axes point right, back and down, while those of Imu point forward, left and up.

    Source: docs/spec/thymio-robot.md section 7.3.
    """
    vector = message.linear_acceleration
    return [units.acceleration_to_units(value) for value in (-vector.y, vector.x, vector.z)]


def _wheels(message: Odometry) -> list[int]:
    forward, turn = message.twist.twist.linear.x, message.twist.twist.angular.z * WHEEL_TRACK_M / 2.0
    speeds = [units.speed_to_units(forward - turn), units.speed_to_units(forward + turn)]
    return [*speeds, *map(units.units_to_pwm, speeds)]
