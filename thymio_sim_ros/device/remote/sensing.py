"""Readings of a remote robot, made from its variables.

SI values are computed from the integers by the inverse of the documented responses (`sim/model/units.py`). Only changes
between two polls are seen: two taps, two equal frames of a remote control or of another robot between them are one.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from aseba_vm import TargetDescription
from thymio_sim_ros.device.layout import compatible_plugins
from thymio_sim_ros.sim.model import readings, units
from thymio_sim_ros.sim.model.geometry import Pose, Twist
from thymio_sim_ros.sim.model.readings import Reading
from thymio_sim_ros.sim.model.robot_constants import WHEEL_RADIUS_M, WHEEL_TRACK_M
from thymio_sim_ros.sim.sensors import Sensor
from thymio_sim_ros.sim.sensors.battery import charge

__all__ = ["POSE", "RemoteSensing"]

POSE, MOTOR = "pose", "motor"
"""Odometry is integrated from the speeds of the wheels."""
LONGEST_STEP_S = 3.0
"""Longest time between two readings over which speeds are integrated: a robot that is silent for longer is gone."""

Value = Callable[[str], tuple[int, ...] | None]
"""Returns the words of a variable by name, None if unknown."""


def _proximity(stamp_ns: int, words: tuple[int, ...], _value: Value) -> Reading:
    ranges = tuple(units.proximity_distance(count) if count > 0 else math.inf for count in words)
    return readings.ProximityReading(stamp_ns, words, ranges)


def _ground(stamp_ns: int, words: tuple[int, ...], _value: Value) -> Reading:
    left, right = (units.ground_reflectance(delta) for delta in words[4:6])
    return readings.GroundReading(stamp_ns, words, (left, right))


def _sound(stamp_ns: int, words: tuple[int, ...], value: Value) -> Reading:
    (threshold,) = value("mic.threshold") or (0,)
    return readings.SoundReading(stamp_ns, words, words[0] > threshold != 0)


def _temperature(stamp_ns: int, words: tuple[int, ...], _value: Value) -> Reading:
    return readings.TemperatureReading(stamp_ns, words, words[0] / 10)


def _battery(stamp_ns: int, words: tuple[int, ...], _value: Value) -> Reading:
    volts = units.units_to_volts(sum(words[:2]))
    return readings.BatteryReading(stamp_ns, words, volts, charge(volts), is_charging=False)


_PLAIN: Mapping[str, Callable[[int, tuple[int, ...]], Reading]] = {
    "buttons": readings.ButtonsReading,
    "accelerometer": readings.AccelerometerReading,
    "tap": readings.TapReading,
    "remote": readings.RemoteReading,
    "comm": readings.CommReading,
    "button_counts": readings.ButtonCountsReading,
    "current": readings.CurrentReading,
}
_COMPUTED: Mapping[str, Callable[[int, tuple[int, ...], Value], Reading]] = {
    "proximity": _proximity,
    "ground": _ground,
    "sound": _sound,
    "temperature": _temperature,
    "battery": _battery,
}
_ON_CHANGE = frozenset({"tap", "remote", "comm", "current"})
"""Sensors that report changes only. Their first values are not changes, apart from `current`."""


_ZERO = Pose(0.0, 0.0, 0.0)


@dataclass(slots=True)
class _Odometry:
    """Pose and angles of the wheels by their speeds."""

    pose: Pose = _ZERO
    angles_rad: list[float] = field(default_factory=lambda: [0.0, 0.0])
    speeds_m_s: tuple[float, float] = (0.0, 0.0)
    at_ns: int | None = None

    def add(self, speeds_m_s: tuple[float, float], now_ns: int) -> None:
        """Integrate up to now with the mean of the speeds before and now."""
        step_s = 0.0 if self.at_ns is None else (now_ns - self.at_ns) * 1e-9
        if 0.0 < step_s <= LONGEST_STEP_S:
            left, right = ((a + b) / 2 * step_s for a, b in zip(self.speeds_m_s, speeds_m_s, strict=True))
            turn = (right - left) / WHEEL_TRACK_M
            heading, distance = self.pose.yaw_rad + turn / 2, (left + right) / 2
            x_m, y_m = self.pose.x_m + distance * math.cos(heading), self.pose.y_m + distance * math.sin(heading)
            self.pose = Pose(x_m, y_m, self.pose.yaw_rad + turn)
            for side, way_m in enumerate((left, right)):
                self.angles_rad[side] += way_m / WHEEL_RADIUS_M
        self.speeds_m_s, self.at_ns = speeds_m_s, now_ns

    @property
    def twist(self) -> Twist:
        """Velocity of the body."""
        left, right = self.speeds_m_s
        return Twist((left + right) / 2, (right - left) / WHEEL_TRACK_M)


class RemoteSensing:
    """Converts polled variables of one robot. `sensors` are those that it has, in the order in which they measure."""

    def __init__(self, target: TargetDescription) -> None:
        self._addresses = target.addresses
        declared = {sensor.name: sensor for sensor in compatible_plugins()[0]}
        found = [sensor for sensor in declared.values() if self._has(sensor)]
        self.missing = tuple(
            sensor.name for sensor in declared.values() if sensor.aseba.variables and sensor not in found
        )
        """Names of the sensors whose variables the robot lacks."""
        self._found: dict[str, Sensor] = {sensor.name: sensor for sensor in found}
        self._odometry = _Odometry()
        self._due_ns: dict[str, int] = {}
        self._last: dict[str, tuple[int, ...]] = {}

    @property
    def sensors(self) -> tuple[str, ...]:
        """Names of the sensors that have readings."""
        return (*self._found, POSE) if MOTOR in self._found else tuple(self._found)

    @property
    def angles_rad(self) -> tuple[float, float]:
        """Angles of the wheels, not wrapped."""
        left, right = self._odometry.angles_rad
        return left, right

    def reconnect(self) -> None:
        """Continue odometry from its pose: what the robot did while it was not connected is not known."""
        self._odometry.at_ns = None

    def reset_odometry(self) -> None:
        """Set the odometry to zero; the angles of the wheels stay."""
        self._odometry.pose = _ZERO

    def readings(self, value: Value, now_ns: int) -> Iterator[tuple[str, Reading]]:
        """Yield name and reading of each sensor that is due, from values that were just read."""
        for name, sensor in self._found.items():
            words = self._words(sensor, value)
            if words is None:
                continue
            if name == MOTOR:
                left, right = (units.units_to_speed(word) for word in words[:2])
                self._odometry.add((left, right), now_ns)
            if self._is_due(sensor, words, now_ns):
                yield name, self._reading(name, words, value, now_ns)
        if self._odometry.at_ns == now_ns:
            pose, twist = self._odometry.pose, self._odometry.twist
            yield POSE, readings.PoseReading(now_ns, (), pose, twist, pose, twist)

    def _has(self, sensor: Sensor) -> bool:
        """Whether the robot has the first variable of a sensor: older robots lack some of the others."""
        names = sensor.aseba.variables
        return bool(names) and self._addresses.get(names[0][0], (0, 0))[1] == names[0][1]

    def _words(self, sensor: Sensor, value: Value) -> tuple[int, ...] | None:
        """Words of a reading; 0 for variables that the robot lacks. None if some were not read yet."""
        words: list[int] = []
        for name, size in sensor.aseba.variables:
            found: Sequence[int] | None = (0,) * size
            if self._addresses.get(name, (0, 0))[1] == size:
                found = value(name)
            if found is None:
                return None
            words += found
        return (*words, *[0] * len(sensor.aseba.unseen))

    def _is_due(self, sensor: Sensor, words: tuple[int, ...], now_ns: int) -> bool:
        name = sensor.name
        before, self._last[name] = self._last.get(name), words
        if name in _ON_CHANGE:
            return words != before and (before is not None or name == "current") and (name != "tap" or words[0] != 0)
        if now_ns < self._due_ns.get(name, 0):
            return name == "buttons" and words != before
        self._due_ns[name] = (now_ns // sensor.period_ns + 1) * sensor.period_ns
        return True

    def _reading(self, name: str, words: tuple[int, ...], value: Value, now_ns: int) -> Reading:
        if name == MOTOR:
            left, right = (speed / WHEEL_RADIUS_M for speed in self._odometry.speeds_m_s)
            return readings.MotorReading(now_ns, words, self.angles_rad, (left, right))
        if name in _COMPUTED:
            return _COMPUTED[name](now_ns, words, value)
        return _PLAIN.get(name, readings.PlainReading)(now_ns, words)
