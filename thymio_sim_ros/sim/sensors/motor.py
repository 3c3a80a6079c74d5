"""Speed and angle of the wheels (docs/spec/thymio-robot.md section 2): as commanded, less what an obstacle takes.

The pwm is that of the speed, or of the control loop where motors have one (section 2.1).
"""

from __future__ import annotations

from collections.abc import Callable

from thymio_sim_ros.sim.model.readings import MotorReading
from thymio_sim_ros.sim.model.robot_constants import WHEEL_RADIUS_M
from thymio_sim_ros.sim.model.units import speed_to_units
from thymio_sim_ros.sim.plugin_api.aseba_binding import AsebaFace
from thymio_sim_ros.sim.plugin_api.reading_table import LazyReadings
from thymio_sim_ros.sim.plugin_api.view import BatchSensorView
from thymio_sim_ros.sim.sensors import Sensor

__all__ = ["SENSOR"]


def _prepare(batch: BatchSensorView) -> Callable[[], LazyReadings]:
    wheels = batch.wheels
    rim, angle, output = (part[: 2 * len(batch)] for part in (wheels.rim, wheels.angle, wheels.output))

    def measure() -> LazyReadings:
        now_ns, speeds, angles, pwms = batch.now_ns, rim.tolist(), angle.tolist(), output.tolist()

        def make(robot: int) -> MotorReading:
            left, right = 2 * robot, 2 * robot + 1
            words = (
                speed_to_units(speeds[left]), speed_to_units(speeds[right]), round(pwms[left]), round(pwms[right])
            )  # fmt: skip
            velocities = (speeds[left] / WHEEL_RADIUS_M, speeds[right] / WHEEL_RADIUS_M)
            return MotorReading(now_ns, words, (angles[left], angles[right]), velocities)

        return LazyReadings(len(batch), make)

    return measure


SENSOR = Sensor(
    name="motor",
    period_ns=10_000_000,
    prepare_all=_prepare,
    is_stateless=True,
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
