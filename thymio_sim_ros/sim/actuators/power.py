"""The battery as an operator sets it (docs/spec/thymio-robot.md section 7.4); it does not run down by itself."""

from __future__ import annotations

from dataclasses import dataclass

from thymio_sim_ros.sim.actuators import Actuator
from thymio_sim_ros.sim.commands import ConnectCharger, SetBattery

__all__ = ["ACTUATOR", "PowerState"]


@dataclass(slots=True)
class PowerState:
    """Voltage, 4.0 V at first, and whether a charger is connected."""

    volts: float = 4.0
    is_charging: bool = False


def _apply(state: PowerState, command: SetBattery | ConnectCharger, _now_ns: int) -> None:
    if isinstance(command, SetBattery):
        state.volts = command.volts
    else:
        state.is_charging = command.is_connected


ACTUATOR = Actuator(name="power", accepts=(SetBattery, ConnectCharger), begin=PowerState, apply=_apply)
