"""The operator's hand: lifts the robot to another place, or zeroes its odometry."""

from __future__ import annotations

from dataclasses import dataclass, field

from thymio_sim_ros.sim.actuators import Actuator
from thymio_sim_ros.sim.commands import MoveRobot, ResetOdometry
from thymio_sim_ros.sim.geometry import Pose
from thymio_sim_ros.sim.view import ActuatorView

__all__ = ["ACTUATOR", "HandState"]


@dataclass(slots=True)
class HandState:
    """What the hand is about to do in this tick, in order."""

    waiting: list[MoveRobot | ResetOdometry] = field(default_factory=list)


def _apply(state: HandState, command: MoveRobot | ResetOdometry, _now_ns: int) -> None:
    state.waiting.append(command)


def _update(state: HandState, view: ActuatorView, _dt_s: float) -> None:
    if not state.waiting:
        return
    for command in state.waiting:
        if isinstance(command, MoveRobot):
            view.place(Pose(command.x_m, command.y_m, command.yaw_rad))
        else:
            view.wheels.reset_odometry()
    state.waiting.clear()


ACTUATOR = Actuator(name="hand", accepts=(MoveRobot, ResetOdometry), begin=HandState, apply=_apply, update=_update)
