"""Speed and angle of the wheels (docs/spec/thymio-robot.md section 2): as commanded, less what an obstacle takes.

The pwm is that of the speed, or of the control loop where motors have one (section 2.1).
"""

from __future__ import annotations

from collections.abc import Callable

from aseba_vm.kernel.types import Floats, Ints, kernel
from thymio_sim_ros.sim.model.readings import MotorReading
from thymio_sim_ros.sim.model.robot_constants import WHEEL_RADIUS_M
from thymio_sim_ros.sim.model.robot_state import WheelState
from thymio_sim_ros.sim.model.units import speed_to_units
from thymio_sim_ros.sim.plugin_api.aseba_binding import AsebaFace
from thymio_sim_ros.sim.plugin_api.reading_table import LazyReadings
from thymio_sim_ros.sim.plugin_api.view import BatchSensorView
from thymio_sim_ros.sim.sensors import Sensor

__all__ = ["SENSOR"]


@kernel
def report_all(wheels: WheelState, count: int, words: Ints, velocities: Floats) -> None:
    """Write what `count` wheels report: the words, shape (robots, 4), and the rates of turn in rad/s."""
    for wheel in range(count):
        first = 4 * (wheel >> 1) + (wheel & 1)
        words[first] = speed_to_units(wheels.rim[wheel])
        words[first + 2] = round(wheels.output[wheel])
        velocities[wheel] = wheels.rim[wheel] / WHEEL_RADIUS_M


def _prepare(batch: BatchSensorView) -> Callable[[], LazyReadings]:
    angles = batch.wheels.angle[: 2 * len(batch)].reshape(-1, 2)
    words, velocities = batch.array((len(batch), 4), "int32"), batch.array((len(batch), 2), "float64")
    report = batch.bind(report_all, batch.wheels, 2 * len(batch), words, velocities)

    def measure() -> LazyReadings:
        report()
        now_ns, columns = batch.now_ns, (words.tolist(), angles.tolist(), velocities.tolist())

        def make(robot: int) -> MotorReading:
            numbers, (left, right), (left_rate, right_rate) = [column[robot] for column in columns]
            return MotorReading(now_ns, tuple(numbers), (left, right), (left_rate, right_rate))

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
