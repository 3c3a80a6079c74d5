"""Speed and angle of the wheels (thymio-robot.md section 2): as commanded, less what an obstacle takes.

The pwm is that of the speed, or of the control loop where motors have one (section 2.1).
"""

from __future__ import annotations

from thymio_sim_ros.sim import units
from thymio_sim_ros.sim.aseba_face import AsebaFace
from thymio_sim_ros.sim.readings import MotorReading
from thymio_sim_ros.sim.sensors import Sensor
from thymio_sim_ros.sim.thymio2 import WHEEL_RADIUS_M
from thymio_sim_ros.sim.view import SensorView

__all__ = ["SENSOR"]


def _measure(view: SensorView) -> MotorReading:
    wheels = view.wheels
    left, right = wheels.speeds_m_s
    speeds = (units.speed_to_units(left), units.speed_to_units(right))
    if wheels.control is None:
        pwms = (units.units_to_pwm(speeds[0]), units.units_to_pwm(speeds[1]))
    else:
        pwms = (round(wheels.control[0].output), round(wheels.control[1].output))
    return MotorReading(
        view.now_ns,
        (*speeds, *pwms),
        wheels.angles_rad,
        (left / WHEEL_RADIUS_M, right / WHEEL_RADIUS_M),
    )


SENSOR = Sensor(
    name="motor",
    period_ns=10_000_000,
    measure=_measure,
    aseba=AsebaFace(
        variables=(
            ("motor.left.speed", 1),
            ("motor.right.speed", 1),
            ("motor.left.pwm", 1),
            ("motor.right.pwm", 1),
        ),
        event="motor",
    ),
)
