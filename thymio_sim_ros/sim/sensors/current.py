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
from thymio_sim_ros.sim.thymio2 import INTEGRATOR_LIMIT
from thymio_sim_ros.sim.view import SensorView

__all__ = ["SENSOR"]

_FILTER_TICKS = 64
_INTEGRAL_PER_PWM = 3
_NONE = (0.0, 0.0)


def _measure(view: SensorView) -> CurrentReading | None:
    wheels, memory = view.wheels, view.memory
    if wheels.control is not None:
        left, right = wheels.control
        words = (round(left.current), round(right.current), round(left.integral), round(right.integral))
        return CurrentReading(view.now_ns, words) if is_news(view, words) else None
    aimed, reached = wheels.commanded, wheels.speeds_m_s
    if aimed == reached == memory.get("settled") and view.now_ns < memory["refresh_ns"]:
        return None  # the rule on a free way, and cheap
    currents = memory.get("currents", _NONE)
    if aimed != reached or currents != _NONE:
        currents = memory["currents"] = (
            _filter(currents[0], _pwm(aimed[0]) - _pwm(reached[0])),
            _filter(currents[1], _pwm(aimed[1]) - _pwm(reached[1])),
        )
    memory["settled"] = reached if currents == _NONE else None
    words = (round(currents[0]), round(currents[1]), _integral(aimed[0]), _integral(aimed[1]))
    return CurrentReading(view.now_ns, words) if is_news(view, words) else None


def _pwm(speed_m_s: float) -> int:
    return units.units_to_pwm(units.speed_to_units(speed_m_s))


def _filter(current: float, load: int) -> float:
    current += (abs(load) - current) / _FILTER_TICKS
    return current if current >= 0.5 or load else 0.0


def _integral(speed_m_s: float) -> int:
    return max(-INTEGRATOR_LIMIT, min(INTEGRATOR_LIMIT, _INTEGRAL_PER_PWM * _pwm(speed_m_s)))


SENSOR = Sensor(
    name="current",
    period_ns=10_000_000,
    measure=_measure,
    aseba=AsebaFace(variables=(("_imot", 2), ("_integrator", 2))),
)
