"""Current and integral of the motors' control, reported on change (`mechanics/motor_control.py`)."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from aseba_vm.kernel.record import Record
from aseba_vm.kernel.types import Ints, kernel
from thymio_sim_ros.sim.model.clock import TICK_NS
from thymio_sim_ros.sim.model.readings import CurrentReading
from thymio_sim_ros.sim.model.robot_constants import REFRESH_NS
from thymio_sim_ros.sim.model.robot_state import WheelState
from thymio_sim_ros.sim.plugin_api.aseba_binding import AsebaFace
from thymio_sim_ros.sim.plugin_api.view import BatchSensorView
from thymio_sim_ros.sim.sensors import Sensor

__all__ = ["SENSOR", "list_changed"]

_REFRESH_TICKS = REFRESH_NS // TICK_NS


class Reported(Record):
    """The last reading of each robot."""

    current_left: Ints
    current_right: Ints
    integral_left: Ints
    integral_right: Ints
    refresh_tick: Ints
    """Tick in which it is reported again without a change; 0 before the first report."""


@kernel
def list_changed(wheels: WheelState, reported: Reported, tick: Ints, changed: Ints, count: Ints) -> None:
    """Write the robots whose values differ from those reported, or that are due, to `changed`, `count[0]` of them.

    `tick[0]` is the number of the tick. The values become those reported.
    """
    found = 0
    for robot in range(reported.count):
        current_left = round(wheels.current[2 * robot])
        current_right = round(wheels.current[2 * robot + 1])
        integral_left = round(wheels.integral[2 * robot])
        integral_right = round(wheels.integral[2 * robot + 1])
        if (
            current_left != reported.current_left[robot]
            or current_right != reported.current_right[robot]
            or integral_left != reported.integral_left[robot]
            or integral_right != reported.integral_right[robot]
            or tick[0] >= reported.refresh_tick[robot]
        ):
            reported.current_left[robot] = current_left
            reported.current_right[robot] = current_right
            reported.integral_left[robot] = integral_left
            reported.integral_right[robot] = integral_right
            reported.refresh_tick[robot] = tick[0] + _REFRESH_TICKS
            changed[found] = robot
            found += 1
    count[0] = found


def _prepare(batch: BatchSensorView) -> Callable[[], Sequence[CurrentReading | None]]:
    reported, changed, count = batch.record(Reported), batch.array(len(batch), "int32"), batch.array(1, "int32")
    check = batch.bind(list_changed, batch.wheels, reported, batch.tick, changed, count)
    nothing = (None,) * len(batch)

    def measure() -> Sequence[CurrentReading | None]:
        check()
        if count[0] == 0:
            return nothing
        readings: list[CurrentReading | None] = [None] * len(batch)
        for robot in changed[: count[0]].tolist():
            words = (
                reported.view.current_left[robot],
                reported.view.current_right[robot],
                reported.view.integral_left[robot],
                reported.view.integral_right[robot],
            )
            readings[robot] = CurrentReading(batch.now_ns, words)
        return readings

    return measure


SENSOR = Sensor(
    name="current",
    period_ns=10_000_000,
    prepare_all=_prepare,
    aseba=AsebaFace(variables=(("_imot", 2), ("_integrator", 2))),
    values=(),
)
