"""The two motors (docs/spec/thymio-robot.md section 2).

Targets of a program persist. A ROS command holds until it times out, after which the targets hold again;
newer targets end it at once. Each wheel slips by a new random factor every tick.
Model "ideal": motors follow without delay. Model "firmware": the robot's own control loop with its lag
(`sim/mechanics/motor_control.py`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from thymio_sim_ros.sim.actuators import Actuator
from thymio_sim_ros.sim.commands import BodyTwist, Command, MotorTargets, SetMotorModel, WheelVelocities
from thymio_sim_ros.sim.mechanics.motor_control import WheelControl
from thymio_sim_ros.sim.mechanics.wheels import WheelArrays
from thymio_sim_ros.sim.model import robot_constants, units
from thymio_sim_ros.sim.plugin_api.aseba_binding import ActuatorFace, Output
from thymio_sim_ros.sim.plugin_api.view import ActuatorView, BatchActuatorView

__all__ = ["ACTUATOR", "MotorState", "wanted_speeds"]

_AT_REST = (0.0, 0.0)


@dataclass(slots=True)
class MotorState:
    """Wheel speeds in m/s: those of the targets, and those in force; the loop of each wheel, if there is one."""

    targets_m_s: tuple[float, float] = _AT_REST
    speeds_m_s: tuple[float, float] = _AT_REST
    ends_ns: int | None = None
    control: tuple[WheelControl, WheelControl] | None = None
    batch_changes: tuple[set[int], int] | None = None
    """In a batch: the set of robots with a new command, and the number of this robot in it."""


def wanted_speeds(command: WheelVelocities | BodyTwist) -> tuple[float, float]:
    """Return the speeds of the left and right wheel in m/s that a command asks for, not limited."""
    if isinstance(command, BodyTwist):
        turn = command.angular_rad_s * robot_constants.WHEEL_TRACK_M / 2
        return command.linear_m_s - turn, command.linear_m_s + turn
    return command.left_rad_s * robot_constants.WHEEL_RADIUS_M, command.right_rad_s * robot_constants.WHEEL_RADIUS_M


def wheel_speeds(command: WheelVelocities | BodyTwist) -> tuple[float, float]:
    """Return the speeds of the left and right wheel in m/s, both scaled down together to the limit."""
    left, right = wanted_speeds(command)
    largest = max(abs(left), abs(right))
    scale = robot_constants.MAX_SPEED_M_S / largest if largest > robot_constants.MAX_SPEED_M_S else 1.0
    return (left * scale, right * scale)


def _apply(state: MotorState, command: MotorTargets | WheelVelocities | BodyTwist | SetMotorModel, now_ns: int) -> None:
    if isinstance(command, SetMotorModel):
        state.control = (WheelControl(), WheelControl()) if command.model == "firmware" else None
    elif isinstance(command, MotorTargets):
        state.targets_m_s = (units.units_to_speed(command.left), units.units_to_speed(command.right))
        state.speeds_m_s = state.targets_m_s
        state.ends_ns = None
    else:
        state.speeds_m_s = wheel_speeds(command)
        state.ends_ns = now_ns + command.timeout_ns if command.timeout_ns else None
    if state.batch_changes is not None:
        changed, number = state.batch_changes
        changed.add(number)


def _time_out(state: MotorState, now_ns: int) -> bool:
    """Restore the targets if a command has timed out; return whether it has now."""
    is_over = state.ends_ns is not None and now_ns >= state.ends_ns
    if is_over:
        state.speeds_m_s, state.ends_ns = state.targets_m_s, None
    return is_over


def _update(state: MotorState, view: ActuatorView, dt_s: float) -> None:
    _time_out(state, view.now_ns)
    noise, wheels = view.noise, view.wheels
    slip = (noise.uniform(*robot_constants.SLIP), noise.uniform(*robot_constants.SLIP))
    wheels.control = state.control
    speeds = state.speeds_m_s if state.control is None else _controlled(state, wheels.speeds_m_s, dt_s)
    wheels.drive(speeds, slip, robot_constants.MAX_SPEED_M_S)


def _controlled(state: MotorState, wheels_m_s: Sequence[float], dt_s: float) -> tuple[float, float]:
    """Return the speeds in m/s that the control loops give to the wheels."""
    assert state.control is not None
    unit_m_s = robot_constants.MAX_SPEED_M_S / robot_constants.FULL_TARGET
    left, right = (
        wheel.tick(target_m_s / unit_m_s, speed_m_s / unit_m_s, dt_s) * unit_m_s
        for wheel, target_m_s, speed_m_s in zip(state.control, state.speeds_m_s, wheels_m_s, strict=True)
    )
    return (left, right)


class _BatchTargets:
    """Target speeds of the motors of a batch, updated when a command has come."""

    def __init__(self, states: Sequence[MotorState]) -> None:
        self.commanded = np.zeros((2, len(states)))
        self.timed: set[int] = set()
        """Numbers of those whose command times out."""
        self.controlled: set[int] = set()
        """Numbers of those with control loops."""
        self.changed = set(range(len(states)))
        for number, state in enumerate(states):
            state.batch_changes = (self.changed, number)

    def refresh(self, states: Sequence[MotorState], wheels: WheelArrays, now_ns: int) -> None:
        """Update the arrays for robots whose commands have changed."""
        for number in self.timed:
            if _time_out(states[number], now_ns):
                self.changed.add(number)
        if not self.changed:
            return
        self.commanded = self.commanded.copy()
        for number in self.changed:
            state = states[number]
            self.commanded[:, number] = state.speeds_m_s
            wheels.set_control(number, state.control)
            _include(self.timed, number, is_in=state.ends_ns is not None)
            _include(self.controlled, number, is_in=state.control is not None)
        self.changed.clear()


def _include(numbers: set[int], number: int, *, is_in: bool) -> None:
    if is_in:
        numbers.add(number)
    else:
        numbers.discard(number)


def _update_all(states: Sequence[MotorState], batch: BatchActuatorView, dt_s: float) -> None:
    wheels = batch.wheels
    targets = batch.memory.get("targets")
    if targets is None:
        targets = batch.memory["targets"] = _BatchTargets(states)
    targets.refresh(states, wheels, batch.now_ns)
    commanded = targets.commanded
    if targets.controlled:
        commanded, turning = commanded.copy(), wheels.speeds.T.tolist()
        for number in targets.controlled:
            commanded[:, number] = _controlled(states[number], turning[number], dt_s)
    wheels.drive(commanded, batch.noise.draw(*robot_constants.SLIP, 2), robot_constants.MAX_SPEED_M_S)


def _targets(words: Sequence[int]) -> Command:
    return MotorTargets(words[0], words[1])


ACTUATOR = Actuator(
    name="motors",
    accepts=(MotorTargets, WheelVelocities, BodyTwist, SetMotorModel),
    begin=MotorState,
    apply=_apply,
    update=_update,
    update_all=_update_all,
    aseba=ActuatorFace(outputs=(Output((("motor.left.target", 1), ("motor.right.target", 1)), _targets),)),
)
