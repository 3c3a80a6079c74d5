"""Current and integrator of the motors' control, told when they change (thymio-robot.md section 2.1).

With motors that follow at once the control loop is in its steady state: its output is the pwm of the speed aimed at,
its integral three times that, within ±4806. The current grows with the voltage that no turning takes up, which is what
the pwm aimed at has more than the pwm of the speed reached: a free wheel draws none, a wheel held at full speed 800,
above the 600 (about 0.4 A) at which the robot protects itself. It is filtered over 64 ticks. Motors with a control
loop of their own tell what is in it.
"""

from __future__ import annotations

from thymio_sim_ros.sim import units
from thymio_sim_ros.sim.aseba_face import AsebaFace
from thymio_sim_ros.sim.readings import CurrentReading
from thymio_sim_ros.sim.sensors import Sensor
from thymio_sim_ros.sim.sensors._change import is_news
from thymio_sim_ros.sim.thymio2 import FULL_TARGET, INTEGRATOR_LIMIT, MAX_SPEED_M_S, PWM_PER_SPEED_UNIT
from thymio_sim_ros.sim.view import SensorView

__all__ = ["SENSOR"]

_FILTER_TICKS = 64
_INTEGRAL_PER_PWM = 3
_LOAD_PER_M_S = -PWM_PER_SPEED_UNIT * FULL_TARGET / MAX_SPEED_M_S
_NOTHING = 0.5
"""A current below rounds to none."""


def _measure(view: SensorView) -> CurrentReading | None:
    wheels, memory = view.wheels, view.memory
    if wheels.control is not None:
        left, right = wheels.control
        words = (round(left.current), round(right.current), round(left.integral), round(right.integral))
        return CurrentReading(view.now_ns, words) if is_news(view, words) else None
    aimed, reached = wheels.commanded, wheels.speeds_m_s
    if aimed == reached == memory.get("settled") and view.now_ns < memory["refresh_ns"]:
        return None  # the rule on a free way, and cheap
    one, other = memory.get("currents", (0.0, 0.0))
    one = _filtered(one, abs(aimed[0] - reached[0]) * _LOAD_PER_M_S)
    other = _filtered(other, abs(aimed[1] - reached[1]) * _LOAD_PER_M_S)
    memory["currents"] = (one, other)
    memory["settled"] = None if one or other else aimed
    if memory.get("aimed") != aimed:
        memory["aimed"], memory["integrals"] = aimed, (_integral(aimed[0]), _integral(aimed[1]))
    words = (round(one), round(other), *memory["integrals"])
    return CurrentReading(view.now_ns, words) if is_news(view, words) else None


def _filtered(current: float, load: float) -> float:
    """The next value of a current; one that fades away ends."""
    current += (load - current) / _FILTER_TICKS
    return current if current >= _NOTHING or load >= _NOTHING else 0.0


def _integral(speed_m_s: float) -> int:
    """What the loop has gathered that keeps a wheel at a speed."""
    pwm = units.units_to_pwm(units.speed_to_units(speed_m_s))
    return max(-INTEGRATOR_LIMIT, min(INTEGRATOR_LIMIT, _INTEGRAL_PER_PWM * pwm))


SENSOR = Sensor(
    name="current",
    period_ns=10_000_000,
    measure=_measure,
    aseba=AsebaFace(variables=(("_imot", 2), ("_integrator", 2))),
)
