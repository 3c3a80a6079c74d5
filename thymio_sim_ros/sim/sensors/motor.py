"""Speed and angle of the wheels (docs/spec/thymio-robot.md section 2): as commanded, less what an obstacle takes.

The pwm is that of the speed, or of the control loop where motors have one (section 2.1).
"""

from __future__ import annotations

import numpy as np

from thymio_sim_ros.sim.model import units
from thymio_sim_ros.sim.model.readings import MotorReading
from thymio_sim_ros.sim.model.robot_constants import WHEEL_RADIUS_M
from thymio_sim_ros.sim.plugin_api.aseba_binding import AsebaFace
from thymio_sim_ros.sim.plugin_api.reading_table import LazyReadings
from thymio_sim_ros.sim.plugin_api.view import BatchSensorView, SensorView
from thymio_sim_ros.sim.sensors import Sensor

__all__ = ["SENSOR"]


def _measure(view: SensorView) -> MotorReading:
    wheels, memory = view.wheels, view.memory
    speeds = wheels.speeds_m_s
    if speeds != memory.get("speeds"):
        memory["speeds"], memory["faces"] = speeds, _faces(*speeds)
    words, velocities = memory["faces"]
    if wheels.control is not None:
        words = (*words[:2], *(round(loop.output) for loop in wheels.control))
    return MotorReading(view.now_ns, words, wheels.angles_rad, velocities)


def _faces(left_m_s: float, right_m_s: float) -> tuple[tuple[int, int, int, int], tuple[float, float]]:
    """Return the words and the angular velocities in rad/s of wheels at these speeds."""
    left, right = units.speed_to_units(left_m_s), units.speed_to_units(right_m_s)
    words = (left, right, units.units_to_pwm(left), units.units_to_pwm(right))
    return words, (left_m_s / WHEEL_RADIUS_M, right_m_s / WHEEL_RADIUS_M)


def _measure_all(batch: BatchSensorView) -> LazyReadings:
    now_ns, wheels = batch.now_ns, batch.wheels
    speeds = units.speeds_to_units(wheels.speeds)
    words = list(zip(*np.concatenate((speeds, units.units_to_pwms(speeds))).tolist(), strict=True))
    for robot, loops in wheels.controls.items():
        words[robot] = (*words[robot][:2], *(round(loop.output) for loop in loops))
    angles = list(zip(*wheels.angles.tolist(), strict=True))
    velocities = list(zip(*(wheels.speeds / WHEEL_RADIUS_M).tolist(), strict=True))
    return LazyReadings(len(batch), lambda robot: MotorReading(now_ns, words[robot], angles[robot], velocities[robot]))


SENSOR = Sensor(
    name="motor",
    period_ns=10_000_000,
    measure=_measure,
    measure_all=_measure_all,
    aseba=AsebaFace(
        variables=(
            ("motor.left.speed", 1),
            ("motor.right.speed", 1),
            ("motor.left.pwm", 1),
            ("motor.right.pwm", 1),
        ),
        event="motor",
    ),
    values=(),
)
