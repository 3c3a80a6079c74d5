"""The firmware's control of one wheel, and the wheel that follows it (docs/spec/thymio-robot.md section 2.1).

In every tick, with speed and target in Thymio units and the output's sign against the speed's:
error = speed − target; integral += error, within ±4806; output = 5 error + integral / 3; then the mean of this and the
last output; then within ±801, the integral losing half of the excess. A target of 0 for ten ticks lets the wheel go.
A filtered current above 600 for three ticks halves the output until it is under 300.

Where no reference says anything: the wheel is a lag of 0.1 s behind the speed that its voltage gives, −1.6 pwm per
unit; the current is the part of the voltage that no turning takes up. The robot's 97.7 Hz are our tick, 100 Hz.
"""

from __future__ import annotations

import math

from thymio_sim_ros.sim.model.robot_constants import INTEGRATOR_LIMIT, PWM_LIMIT, PWM_PER_SPEED_UNIT

__all__ = ["WheelControl"]

_PROPORTIONAL, _INTEGRAL_DIVISOR = 5.0, 3.0
_RELEASE_TICKS = 10
_CURRENT_TICKS = 64
_HIGH_CURRENT, _LOW_CURRENT, _HIGH_TICKS = 600.0, 300.0, 3
_LAG_S = 0.1


class WheelControl:
    """State of one wheel's control: `output` as motor.*.pwm, `integral`, filtered `current`."""

    __slots__ = ("_high_ticks", "_is_halved", "_zero_ticks", "current", "integral", "output")

    def __init__(self) -> None:
        self.output = 0.0
        self.integral = 0.0
        self.current = 0.0
        self._zero_ticks = 0
        self._high_ticks = 0
        self._is_halved = False

    def tick(self, target: float, speed: float, dt_s: float) -> float:
        """Advance by a tick; returns the speed of the wheel after it, in Thymio units like `target` and `speed`."""
        self._control(target, speed)
        applied = self.output / 2 if self._is_halved else self.output
        self._watch_current(abs(applied - PWM_PER_SPEED_UNIT * speed))
        free = applied / PWM_PER_SPEED_UNIT
        return speed + (free - speed) * (1 - math.exp(-dt_s / _LAG_S))

    def _control(self, target: float, speed: float) -> None:
        error = speed - target
        self.integral = max(-INTEGRATOR_LIMIT, min(INTEGRATOR_LIMIT, self.integral + error))
        output = (self.output + _PROPORTIONAL * error + self.integral / _INTEGRAL_DIVISOR) / 2
        excess = abs(output) - PWM_LIMIT
        if excess > 0:
            self.integral -= math.copysign(excess / 2, output)
            output = math.copysign(PWM_LIMIT, output)
        self._zero_ticks = self._zero_ticks + 1 if target == 0.0 else 0
        if self._zero_ticks >= _RELEASE_TICKS:
            output = self.integral = 0.0
        self.output = output

    def _watch_current(self, load: float) -> None:
        self.current += (load - self.current) / _CURRENT_TICKS
        self._high_ticks = self._high_ticks + 1 if self.current > _HIGH_CURRENT else 0
        if self._high_ticks >= _HIGH_TICKS:
            self._is_halved = True
        elif self.current < _LOW_CURRENT:
            self._is_halved = False
