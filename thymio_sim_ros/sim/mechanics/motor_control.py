"""Kernels: how motors follow commands (docs/spec/thymio-robot.md section 2.1).

Motors of the model "ideal" follow at once. Their control loop is in its steady state: its output is the pwm of the
speed aimed at, its integral three times that, within ±4806.

Motors of the model "firmware" have the robot's control loop. In every tick, with speed and target in Thymio units and
the output's sign against the speed's: error = speed − target; integral += error, within ±4806; output = 5 error +
integral / 3; then the mean of this and the last output; then within ±801, the integral losing half of the excess. A
target of 0 for ten ticks lets the wheel go. A filtered current above 600 for three ticks halves the output until it is
under 300.

The current grows with the voltage that no turning takes up, which is what the pwm given has more than the pwm of the
speed reached: a free wheel draws none, a wheel held at full speed 800, above the 600 (about 0.4 A) at which the robot
protects itself. It is filtered over 64 ticks.

Where no reference says anything: a controlled wheel is a lag of 0.1 s behind the speed that its voltage gives, −1.6 pwm
per unit. The robot's 97.7 Hz are our tick, 100 Hz. Each wheel slips by a new random factor in every tick.
"""

from __future__ import annotations

import math

from aseba_vm.kernel.types import Ints, kernel
from thymio_sim_ros.sim.model import robot_constants
from thymio_sim_ros.sim.model.clock import TICK_NS
from thymio_sim_ros.sim.model.noise import NoiseKeys, uniform
from thymio_sim_ros.sim.model.robot_constants import INTEGRATOR_LIMIT, PWM_LIMIT, PWM_PER_SPEED_UNIT
from thymio_sim_ros.sim.model.robot_state import WheelState
from thymio_sim_ros.sim.model.units import speed_to_units, units_to_pwm

__all__ = ["control", "drive", "report_ideal"]

_PROPORTIONAL = 5.0
_INTEGRAL_DIVISOR = 3.0
_RELEASE_TICKS = 10
_CURRENT_TICKS = 64
_HIGH_CURRENT = 600.0
_LOW_CURRENT = 300.0
_HIGH_TICKS = 3
_FOLLOWED = 1.0 - math.exp(-TICK_NS * 1e-9 / 0.1)
"""Part of a difference in speed that a controlled wheel makes up for in a tick."""
_NOTHING = 0.5
"""A current below rounds to none."""

_LIMIT_M_S = robot_constants.MAX_SPEED_M_S
_UNIT_M_S = robot_constants.MAX_SPEED_M_S / robot_constants.FULL_TARGET
_LEAST_SLIP, _MOST_SLIP = robot_constants.SLIP


@kernel
def drive(wheels: WheelState, keys: NoiseKeys, tick: Ints, moving: Ints) -> None:
    """Before a tick: set the speeds of all wheels, and `moving[0]` to whether one of them is not 0.

    `tick[0]` is the number of the tick, `keys` are those of the slip.
    """
    moving[0] = 0
    for wheel in range(wheels.count):
        robot = wheel >> 1
        speed = wheels.wanted[wheel]
        if wheels.is_controlled[wheel] == 1:
            speed = control(wheels, wheel, speed / _UNIT_M_S, wheels.rim[wheel] / _UNIT_M_S) * _UNIT_M_S
        slip = (_LEAST_SLIP + _MOST_SLIP) / 2.0
        if keys.is_on[robot] == 1:
            share = uniform(keys.key_1[robot], keys.key_2[robot], tick[0], wheel & 1)
            slip = _LEAST_SLIP + (_MOST_SLIP - _LEAST_SLIP) * share
        if speed != 0.0:
            moving[0] = 1
        wheels.aimed[wheel] = min(max(speed, -_LIMIT_M_S), _LIMIT_M_S)
        wheels.ground[wheel] = min(max(speed * slip, -_LIMIT_M_S), _LIMIT_M_S)


@kernel
def control(wheels: WheelState, wheel: int, target: float, speed: float) -> float:
    """Advance the control loop of a wheel by a tick; return the speed after it, in Thymio units like its arguments."""
    error = speed - target
    integral = min(max(wheels.integral[wheel] + error, -INTEGRATOR_LIMIT), INTEGRATOR_LIMIT)
    output = (wheels.output[wheel] + _PROPORTIONAL * error + integral / _INTEGRAL_DIVISOR) / 2.0
    excess = abs(output) - PWM_LIMIT
    if excess > 0.0:
        sign = 1.0 if output > 0.0 else -1.0
        integral = integral - sign * excess / 2.0
        output = sign * PWM_LIMIT
    wheels.zero_ticks[wheel] = wheels.zero_ticks[wheel] + 1 if target == 0.0 else 0
    if wheels.zero_ticks[wheel] >= _RELEASE_TICKS:
        output = 0.0
        integral = 0.0
    wheels.output[wheel] = output
    wheels.integral[wheel] = integral

    applied = output / 2.0 if wheels.is_halved[wheel] == 1 else output
    current = wheels.current[wheel]
    current = current + (abs(applied - PWM_PER_SPEED_UNIT * speed) - current) / _CURRENT_TICKS
    wheels.current[wheel] = current
    wheels.high_ticks[wheel] = wheels.high_ticks[wheel] + 1 if current > _HIGH_CURRENT else 0
    if wheels.high_ticks[wheel] >= _HIGH_TICKS:
        wheels.is_halved[wheel] = 1
    elif current < _LOW_CURRENT:
        wheels.is_halved[wheel] = 0
    reached: float = speed + (applied / PWM_PER_SPEED_UNIT - speed) * _FOLLOWED
    return reached


@kernel
def report_ideal(wheels: WheelState, wheel: int) -> None:
    """After a tick: set output, integral and current of a wheel that follows at once."""
    load = abs(wheels.aimed[wheel] - wheels.rim[wheel]) / _UNIT_M_S * -PWM_PER_SPEED_UNIT
    current = wheels.current[wheel]
    current = current + (load - current) / _CURRENT_TICKS
    wheels.current[wheel] = current if current >= _NOTHING or load >= _NOTHING else 0.0
    wheels.output[wheel] = units_to_pwm(speed_to_units(wheels.rim[wheel]))
    steady = _INTEGRAL_DIVISOR * units_to_pwm(speed_to_units(wheels.aimed[wheel]))
    wheels.integral[wheel] = min(max(steady, -INTEGRATOR_LIMIT), INTEGRATOR_LIMIT)
