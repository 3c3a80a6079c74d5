"""The battery, once a second and when it is set (docs/spec/thymio-robot.md section 7.4), no noise.

Two words are V * 198.9 each, the third is 1 while a charger is connected. `charge` is linear from 3.4 V, where
the last light goes out, to 4.1 V of a full lithium cell (the upper end is an assumption; section 8.4 gives the lower).
"""

from __future__ import annotations

from thymio_sim_ros.sim.commands import ConnectCharger, SetBattery
from thymio_sim_ros.sim.model import units
from thymio_sim_ros.sim.model.readings import BatteryReading
from thymio_sim_ros.sim.plugin_api.aseba_binding import AsebaFace
from thymio_sim_ros.sim.plugin_api.display import DisplayedValue
from thymio_sim_ros.sim.plugin_api.view import SensorView
from thymio_sim_ros.sim.sensors import Sensor
from thymio_sim_ros.sim.stimuli.battery import BatteryState

__all__ = ["SENSOR", "charge"]

_EMPTY_V, _FULL_V = 3.4, 4.1
_UNITS_PER_V = 198.9
_FULL_SCALE_V = 4.2


def charge(volts: float) -> float:
    """The charge 0…1 at a voltage in V."""
    return max(0.0, min(1.0, (volts - _EMPTY_V) / (_FULL_V - _EMPTY_V)))


def _measure(view: SensorView) -> BatteryReading:
    battery = view.state(BatteryState)
    word = units.volts_to_units(battery.volts)
    words = (word, word, int(battery.is_charging))
    return BatteryReading(view.now_ns, words, battery.volts, charge(battery.volts), battery.is_charging)


SENSOR = Sensor(
    name="battery",
    period_ns=1_000_000_000,
    phase_ns=10_000_000,
    measure=_measure,
    is_stateless=True,
    wakes_on=(SetBattery, ConnectCharger),
    aseba=AsebaFace(variables=(("_vbat", 2),), unseen=("1 while charging",)),
    values=(DisplayedValue("", "V", 1 / _UNITS_PER_V, digits=2, full_scale=_FULL_SCALE_V * _UNITS_PER_V),),
)
