"""The surroundings of a robot: temperature, ambient light, background noise and claps.

Sources: docs/spec/thymio-robot.md sections 7.2 and 7.4.
"""

from __future__ import annotations

from dataclasses import dataclass

from thymio_sim_ros.sim.commands import Clap, SetAmbientLight, SetNoiseLevel, SetTemperature
from thymio_sim_ros.sim.stimuli import Stimulus

__all__ = ["CLAP_NS", "STIMULUS", "EnvironmentState"]

CLAP_NS = 20_000_000
"""Duration of a clap: one or two blocks of the microphone, which are 16.4 ms long, contain it."""


@dataclass(slots=True)
class EnvironmentState:
    """Temperature in °C, light as prox.ground.ambiant, background noise and the last clap as mic.intensity.

    The clap lasts until `clap_ends_ns`, and other robots hear it too.
    """

    temperature_c: float = 22.0
    ambient_light: int = 0
    noise_level: int = 0
    clap_level: int = 0
    clap_ends_ns: int = -1

    def sound_level(self, now_ns: int) -> float:
        """The level of a clap that sounds now; 0 is silent."""
        return self.clap_level if now_ns <= self.clap_ends_ns else 0.0


def _apply(
    state: EnvironmentState, command: Clap | SetAmbientLight | SetNoiseLevel | SetTemperature, now_ns: int
) -> None:
    if isinstance(command, SetTemperature):
        state.temperature_c = command.celsius
    elif isinstance(command, SetAmbientLight):
        state.ambient_light = command.level
    elif isinstance(command, SetNoiseLevel):
        state.noise_level = command.intensity
    else:
        state.clap_level, state.clap_ends_ns = command.intensity, now_ns + CLAP_NS


STIMULUS = Stimulus(
    name="environment",
    accepts=(Clap, SetAmbientLight, SetNoiseLevel, SetTemperature),
    begin=EnvironmentState,
    apply=_apply,
)
