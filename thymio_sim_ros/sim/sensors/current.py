"""Current and integrator of the motors' control, reported on change (docs/spec/thymio-robot.md section 2.1).

With motors that follow at once the control loop is in its steady state: its output is the pwm of the speed aimed at,
its integral three times that, within ±4806. The current grows with the voltage that no turning takes up, which is what
the pwm aimed at has more than the pwm of the speed reached: a free wheel draws none, a wheel held at full speed 800,
above the 600 (about 0.4 A) at which the robot protects itself. It is filtered over 64 ticks. Motors with a control
loop report its state.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from thymio_sim_ros.sim.model import units
from thymio_sim_ros.sim.model.readings import CurrentReading
from thymio_sim_ros.sim.model.robot_constants import FULL_TARGET, INTEGRATOR_LIMIT, MAX_SPEED_M_S, PWM_PER_SPEED_UNIT
from thymio_sim_ros.sim.plugin_api.aseba_binding import AsebaFace
from thymio_sim_ros.sim.plugin_api.view import BatchSensorView, SensorView
from thymio_sim_ros.sim.sensors import Sensor
from thymio_sim_ros.sim.sensors._publish_on_change import should_publish, should_publish_all

__all__ = ["SENSOR"]

_FILTER_TICKS = 64
_INTEGRAL_PER_PWM = 3
_LOAD_PER_M_S = -PWM_PER_SPEED_UNIT * FULL_TARGET / MAX_SPEED_M_S
_NOTHING = 0.5
"""A current below rounds to none."""
_REST = (0.0, 0.0)
_NOWHERE = (math.nan, math.nan)
"""What no wheel aims at."""


def _measure(view: SensorView) -> CurrentReading | None:
    wheels, memory = view.wheels, view.memory
    if wheels.control is not None:
        left, right = wheels.control
        words = (round(left.current), round(right.current), round(left.integral), round(right.integral))
        memory["aimed"] = _NOWHERE
        return CurrentReading(view.now_ns, words) if should_publish(view, words) else None
    aimed, reached = wheels.commanded, wheels.speeds_m_s
    one, other = currents = memory.get("currents", _REST)
    if aimed == reached == memory.get("aimed") and currents == _REST and view.now_ns < memory["refresh_ns"]:
        return None  # fast path: the usual case while nothing is touched
    one = _filtered(one, abs(aimed[0] - reached[0]) * _LOAD_PER_M_S)
    other = _filtered(other, abs(aimed[1] - reached[1]) * _LOAD_PER_M_S)
    memory["currents"] = (one, other)
    if memory.get("aimed") != aimed:
        memory["aimed"], memory["integrals"] = aimed, (_integral(aimed[0]), _integral(aimed[1]))
    words = (round(one), round(other), *memory["integrals"])
    return CurrentReading(view.now_ns, words) if should_publish(view, words) else None


def _filtered(current: float, load: float) -> float:
    """Return the next value of a filtered current; one that decays below _NOTHING becomes 0."""
    current += (load - current) / _FILTER_TICKS
    return current if current >= _NOTHING or load >= _NOTHING else 0.0


def _integral(speed_m_s: float) -> int:
    """Return the integral of the control loop in its steady state at a speed."""
    pwm = units.units_to_pwm(units.speed_to_units(speed_m_s))
    return max(-INTEGRATOR_LIMIT, min(INTEGRATOR_LIMIT, _INTEGRAL_PER_PWM * pwm))


def _measure_all(batch: BatchSensorView) -> Sequence[CurrentReading | None]:
    wheels, column_state, now_ns = batch.wheels, batch.column_state, batch.now_ns
    currents, loops = column_state.column("currents", _REST), wheels.controls
    commanded = wheels.commanded.T
    loads = np.abs(commanded - wheels.speeds.T) * _LOAD_PER_M_S
    filtered = currents + (loads - currents) / _FILTER_TICKS
    filtered[(filtered < _NOTHING) & (loads < _NOTHING)] = 0.0
    aimed, integrals = column_state.column("aimed", _NOWHERE), column_state.column("integrals", (0, 0))
    new = (aimed != commanded).any(axis=1)
    if new.any():
        pwms = units.units_to_pwms(units.speeds_to_units(commanded[new]))
        integrals[new] = np.maximum(-INTEGRATOR_LIMIT, np.minimum(INTEGRATOR_LIMIT, _INTEGRAL_PER_PWM * pwms))
        aimed[new] = commanded[new]
    controlled = list(loops)
    filtered[controlled] = currents[controlled]
    words = np.concatenate((np.rint(filtered).astype(np.int64), integrals), axis=1)
    for robot, (left, right) in loops.items():
        words[robot] = (round(left.current), round(right.current), round(left.integral), round(right.integral))
    currents[:] = filtered
    aimed[controlled] = _NOWHERE
    readings: list[CurrentReading | None] = [None] * len(batch)
    for robot in np.flatnonzero(should_publish_all(batch, words)).tolist():
        readings[robot] = CurrentReading(now_ns, tuple(words[robot].tolist()))
    return readings


SENSOR = Sensor(
    name="current",
    period_ns=10_000_000,
    measure=_measure,
    measure_all=_measure_all,
    aseba=AsebaFace(variables=(("_imot", 2), ("_integrator", 2))),
    values=(),
)
