"""Voltage and charger of the battery (docs/spec/thymio-robot.md section 7.4); it does not run down by itself."""

from __future__ import annotations

from dataclasses import dataclass

from thymio_sim_ros.sim.commands import ConnectCharger, SetBattery
from thymio_sim_ros.sim.stimuli import Stimulus

__all__ = ["STIMULUS", "BatteryState"]


@dataclass(slots=True)
class BatteryState:
    """Voltage, 4.0 V at the start, and whether a charger is connected."""

    volts: float = 4.0
    is_charging: bool = False


def _apply(state: BatteryState, command: SetBattery | ConnectCharger, _now_ns: int) -> None:
    if isinstance(command, SetBattery):
        state.volts = command.volts
    else:
        state.is_charging = command.is_connected


STIMULUS = Stimulus(name="battery", accepts=(SetBattery, ConnectCharger), begin=BatteryState, apply=_apply)
