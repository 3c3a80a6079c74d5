"""SI units ↔ Thymio integers: the only place where one becomes the other.

Sources: docs/spec/thymio-robot.md sections 2 (motors), 7.1 (proximity), 7.2 (ground), 7.3 (acc), 7.4 (others), 8.1
(LEDs).
"""

from __future__ import annotations

import math

from aseba_vm.kernel.types import kernel
from thymio_sim_ros.sim.commands import LED_FULL
from thymio_sim_ros.sim.kernel.elementary import exp
from thymio_sim_ros.sim.model.robot_constants import (
    ACC_LIMIT,
    ACC_PER_G,
    FULL_TARGET,
    GRAVITY_M_S2,
    MAX_SPEED_M_S,
    PROXIMITY_RANGE_M,
    PWM_LIMIT,
    PWM_PER_SPEED_UNIT,
)

_UNITS_PER_M_S = FULL_TARGET / MAX_SPEED_M_S * (1 + 1e-9)
"""A hair more, so that a target does not lose one when it comes back as a speed."""

PROXIMITY_FULL = 4505
"""The largest proximity count."""
_PROXIMITY_X0_M = 0.0003
_PROXIMITY_C_M2 = 0.0073
_PROXIMITY_SCALE = PROXIMITY_FULL * (_PROXIMITY_C_M2 - _PROXIMITY_X0_M**2)

GROUND_FULL = 1023
"""The largest ground count (10 bits)."""
_GROUND_BLACK = 60.0
_GROUND_SPAN = 884.0
_GROUND_SLOPE = 9.0
_GROUND_MIDDLE = 0.44


@kernel
def speed_to_units(speed_m_s: float) -> int:
    """The ground speed of a wheel in m/s as motor.*.speed, truncated as in the reference."""
    return int(speed_m_s * _UNITS_PER_M_S)


def units_to_speed(target: int) -> float:
    """motor.*.target as ground speed in m/s; the wheels are limited, not the target.

    Source: docs/spec/thymio-robot.md section 2.
    """
    return target * (MAX_SPEED_M_S / FULL_TARGET)


@kernel
def units_to_pwm(speed: int) -> int:
    """motor.*.pwm for a speed in Thymio units."""
    pwm = int(PWM_PER_SPEED_UNIT * speed)
    return pwm if -PWM_LIMIT <= pwm <= PWM_LIMIT else PWM_LIMIT if pwm > 0 else -PWM_LIMIT


@kernel
def proximity_response(distance_m: float) -> float:
    """The response F of one ray to an obstacle at a distance in m; 0 beyond the range.

    F(x) = m (c - x0²) / (x² - 2 x0 x + c) with m = 4505, x0 = 0.3 mm, c = 73 cm²; F = m below x0.
    """
    if distance_m > PROXIMITY_RANGE_M:
        return 0.0
    if distance_m < _PROXIMITY_X0_M:
        return float(PROXIMITY_FULL)
    return _PROXIMITY_SCALE / (distance_m * distance_m - 2.0 * _PROXIMITY_X0_M * distance_m + _PROXIMITY_C_M2)


def proximity_distance(count: float) -> float:
    """The distance in m of a wall across the axis that gives this count above 0; at most the range."""
    if count >= PROXIMITY_FULL:
        return 0.0
    square = _PROXIMITY_X0_M**2 - _PROXIMITY_C_M2 + _PROXIMITY_SCALE / count
    return min(PROXIMITY_RANGE_M, _PROXIMITY_X0_M + math.sqrt(max(0.0, square)))


@kernel
def ground_response(reflectance: float) -> float:
    """The count of a ground sensor over a gray 0…1: 60 + 884 / (1 + exp(-9 (g - 0.44)))."""
    return _GROUND_BLACK + _GROUND_SPAN / (1.0 + exp(-_GROUND_SLOPE * (reflectance - _GROUND_MIDDLE)))


def ground_reflectance(count: float) -> float:
    """The gray 0…1 over which a ground sensor gives a count."""
    above = count - _GROUND_BLACK
    if not 0.0 < above < _GROUND_SPAN:
        return 0.0 if above <= 0.0 else 1.0
    return min(1.0, max(0.0, _GROUND_MIDDLE - math.log(_GROUND_SPAN / above - 1.0) / _GROUND_SLOPE))


@kernel
def acceleration_to_units(acceleration_m_s2: float) -> int:
    """One axis of acc for m/s²: 23 for each g, within ±32 (section 7.3)."""
    return round(min(max(acceleration_m_s2 * (ACC_PER_G / GRAVITY_M_S2), -ACC_LIMIT), ACC_LIMIT))


def units_to_acceleration(count: int) -> float:
    """One axis of acc in m/s²."""
    return count * (GRAVITY_M_S2 / ACC_PER_G)


def celsius_to_units(celsius: float) -> int:
    """Temperature for °C: tenths of a degree (section 7.4)."""
    return round(10.0 * celsius)


def volts_to_units(volts: float) -> int:
    """Each word of _vbat for V: their sum times 1000/3978 is hundredths of a volt (section 7.4)."""
    return round(volts * 100.0 * 3978.0 / 1000.0 / 2.0)


def units_to_volts(total: int) -> float:
    """The voltage in V for the sum of both words of _vbat."""
    return total * 1000.0 / 3978.0 / 100.0


def saturate_led(word: int) -> int:
    """The brightness 0…32 of an Aseba word: its low byte, of which 32 or more is full (section 8.1)."""
    level = word & 0xFF
    return level if level < LED_FULL else LED_FULL
