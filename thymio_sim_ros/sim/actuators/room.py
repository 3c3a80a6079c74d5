"""What an operator makes of the room round a robot: its temperature, light and noise, claps.

Sources: docs/spec/thymio-robot.md sections 7.2 and 7.4.
"""

from __future__ import annotations

from dataclasses import dataclass

from thymio_sim_ros.sim.actuators import Actuator
from thymio_sim_ros.sim.commands import Clap, SetAmbientLight, SetNoiseLevel, SetTemperature

__all__ = ["ACTUATOR", "CLAP_NS", "RoomState"]

CLAP_NS = 20_000_000
"""How long a clap sounds: the microphone's block of 16.4 ms meets it at least once, and at most twice."""


@dataclass(slots=True)
class RoomState:
    """Temperature in °C, light as prox.ground.ambiant, steady noise and the last clap as mic.intensity.

    The clap sounds until `clap_ends_ns`, and other robots hear it too.
    """

    temperature_c: float = 22.0
    ambient_light: int = 0
    noise_level: int = 0
    clap_level: int = 0
    clap_ends_ns: int = -1


def _apply(state: RoomState, command: Clap | SetAmbientLight | SetNoiseLevel | SetTemperature, now_ns: int) -> None:
    if isinstance(command, SetTemperature):
        state.temperature_c = command.celsius
    elif isinstance(command, SetAmbientLight):
        state.ambient_light = command.level
    elif isinstance(command, SetNoiseLevel):
        state.noise_level = command.intensity
    else:
        state.clap_level, state.clap_ends_ns = command.intensity, now_ns + CLAP_NS


ACTUATOR = Actuator(
    name="room", accepts=(Clap, SetAmbientLight, SetNoiseLevel, SetTemperature), begin=RoomState, apply=_apply
)
