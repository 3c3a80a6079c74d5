"""The two motors (docs/spec/thymio-robot.md section 2).

Targets of a program persist. A ROS command holds until it times out, after which the targets hold again;
newer targets end it at once. How wheels follow is in `sim/mechanics/motor_control.py`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from thymio_sim_ros.sim.actuators import Actuator
from thymio_sim_ros.sim.commands import BodyTwist, Command, MotorTargets, SetMotorModel, WheelVelocities
from thymio_sim_ros.sim.model import robot_constants, units
from thymio_sim_ros.sim.plugin_api.aseba_binding import ActuatorFace, Output
from thymio_sim_ros.sim.plugin_api.view import ActuatorView

__all__ = ["ACTUATOR", "MotorState", "wanted_speeds", "wheel_speeds"]

_AT_REST = (0.0, 0.0)


@dataclass(slots=True)
class MotorState:
    """Wheel speeds in m/s: those of the targets, and those in force."""

    targets_m_s: tuple[float, float] = _AT_REST
    speeds_m_s: tuple[float, float] = _AT_REST
    ends_ns: int | None = None
    """When the targets are in force again."""
    new_model: str | None = None
    """One of `commands.MOTOR_MODELS`, until it is set."""
    is_set: bool = True
    """Whether the wheels have the speeds in force."""


def wanted_speeds(command: WheelVelocities | BodyTwist) -> tuple[float, float]:
    """The speeds of the left and right wheel in m/s that a command asks for, not limited."""
    if isinstance(command, BodyTwist):
        turn = command.angular_rad_s * robot_constants.WHEEL_TRACK_M / 2
        return command.linear_m_s - turn, command.linear_m_s + turn
    return command.left_rad_s * robot_constants.WHEEL_RADIUS_M, command.right_rad_s * robot_constants.WHEEL_RADIUS_M


def wheel_speeds(command: WheelVelocities | BodyTwist) -> tuple[float, float]:
    """The speeds of the left and right wheel in m/s, both scaled down together to the limit."""
    left, right = wanted_speeds(command)
    largest = max(abs(left), abs(right))
    scale = robot_constants.MAX_SPEED_M_S / largest if largest > robot_constants.MAX_SPEED_M_S else 1.0
    return (left * scale, right * scale)


def _apply(state: MotorState, command: MotorTargets | WheelVelocities | BodyTwist | SetMotorModel, now_ns: int) -> None:
    if isinstance(command, SetMotorModel):
        state.new_model = command.model
    elif isinstance(command, MotorTargets):
        state.targets_m_s = (units.units_to_speed(command.left), units.units_to_speed(command.right))
        state.speeds_m_s = state.targets_m_s
        state.ends_ns = None
    else:
        state.speeds_m_s = wheel_speeds(command)
        state.ends_ns = now_ns + command.timeout_ns if command.timeout_ns else None
    state.is_set = False


def _update(state: MotorState, view: ActuatorView, _dt_s: float) -> None:
    if state.ends_ns is not None and view.now_ns >= state.ends_ns:
        state.speeds_m_s, state.ends_ns = state.targets_m_s, None
    if state.new_model is not None:
        view.wheels.set_controlled(is_controlled=state.new_model == "firmware")
        state.new_model = None
    view.wheels.want(*state.speeds_m_s)
    state.is_set = True


def _is_idle(state: MotorState) -> bool:
    return state.is_set and state.ends_ns is None


def _targets(words: Sequence[int]) -> Command:
    return MotorTargets(words[0], words[1])


ACTUATOR = Actuator(
    name="motors",
    accepts=(MotorTargets, WheelVelocities, BodyTwist, SetMotorModel),
    begin=MotorState,
    apply=_apply,
    update=_update,
    is_idle=_is_idle,
    aseba=ActuatorFace(outputs=(Output((("motor.left.target", 1), ("motor.right.target", 1)), _targets),)),
)
