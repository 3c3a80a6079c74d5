"""The operator's hand: lifts the robot to another place, holds it at an angle, knocks on it, or zeroes its odometry."""

from __future__ import annotations

from dataclasses import dataclass, field

from thymio_sim_ros.sim.actuators import Actuator
from thymio_sim_ros.sim.commands import MoveRobot, ResetOdometry, Tap, Tilt
from thymio_sim_ros.sim.model import geometry
from thymio_sim_ros.sim.plugin_api.view import ActuatorView

__all__ = ["ACTUATOR", "HandState"]


@dataclass(slots=True)
class HandState:
    """What the hand is about to do in this tick, in order; the angle it holds the robot at; knocks so far."""

    waiting: list[MoveRobot | ResetOdometry] = field(default_factory=list)
    tilt: geometry.Tilt = geometry.LEVEL
    taps: int = 0


def _apply(state: HandState, command: MoveRobot | ResetOdometry | Tilt | Tap, _now_ns: int) -> None:
    if isinstance(command, Tilt):
        state.tilt = geometry.Tilt(command.roll_rad, command.pitch_rad)
    elif isinstance(command, Tap):
        state.taps += 1
    else:
        state.waiting.append(command)


def _update(state: HandState, view: ActuatorView, _dt_s: float) -> None:
    if not state.waiting:
        return
    for command in state.waiting:
        if isinstance(command, MoveRobot):
            view.place(geometry.Pose(command.x_m, command.y_m, command.yaw_rad))
        else:
            view.wheels.reset_odometry()
    state.waiting.clear()


ACTUATOR = Actuator(
    name="hand",
    accepts=(MoveRobot, ResetOdometry, Tilt, Tap),
    begin=HandState,
    apply=_apply,
    update=_update,
    is_idle=lambda state: not state.waiting,
)
