"""Handling by an operator: to move the robot, lift it, hold it at an angle, tap it, or set its odometry."""

from __future__ import annotations

from dataclasses import dataclass, field

from thymio_sim_ros.sim.commands import Lift, MoveRobot, ResetOdometry, SetOdometry, Tap, Tilt
from thymio_sim_ros.sim.model import geometry
from thymio_sim_ros.sim.plugin_api.view import ActuatorView
from thymio_sim_ros.sim.stimuli import Stimulus

__all__ = ["STIMULUS", "HandlingState"]


@dataclass(slots=True)
class HandlingState:
    """Commands to run in this tick, in order; the angle at which the robot is held; the number of taps so far."""

    pending: list[MoveRobot | Lift | ResetOdometry | SetOdometry] = field(default_factory=list)
    tilt: geometry.Tilt = geometry.LEVEL
    taps: int = 0


def _apply(
    state: HandlingState, command: MoveRobot | Lift | ResetOdometry | SetOdometry | Tilt | Tap, _now_ns: int
) -> None:
    if isinstance(command, Tilt):
        state.tilt = geometry.Tilt(command.roll_rad, command.pitch_rad)
    elif isinstance(command, Tap):
        state.taps += 1
    else:
        state.pending.append(command)


def _update(state: HandlingState, view: ActuatorView, _dt_s: float) -> None:
    if not state.pending:
        return
    for command in state.pending:
        if isinstance(command, MoveRobot):
            view.place(geometry.Pose(command.x_m, command.y_m, command.yaw_rad))
        elif isinstance(command, Lift):
            view.lift(is_lifted=command.is_lifted)
        elif isinstance(command, SetOdometry):
            view.wheels.set_odometry(geometry.Pose(command.x_m, command.y_m, command.yaw_rad))
        else:
            view.wheels.set_odometry(geometry.Pose(0.0, 0.0, 0.0))
    state.pending.clear()


STIMULUS = Stimulus(
    name="handling",
    accepts=(MoveRobot, Lift, ResetOdometry, SetOdometry, Tilt, Tap),
    begin=HandlingState,
    apply=_apply,
    update=_update,
    is_idle=lambda state: not state.pending,
)
