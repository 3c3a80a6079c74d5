"""The level above which a sound is reported: mic.threshold (docs/spec/thymio-robot.md section 5)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from thymio_sim_ros.sim.actuators import Actuator
from thymio_sim_ros.sim.commands import Command, SetSoundThreshold
from thymio_sim_ros.sim.plugin_api.aseba_binding import ActuatorFace, Output

__all__ = ["ACTUATOR", "MicrophoneState"]


@dataclass(slots=True)
class MicrophoneState:
    """The threshold; 0 is off."""

    threshold: int = 0

    def is_exceeded(self, intensity: int) -> bool:
        """Whether a sound of this intensity is reported."""
        return intensity > self.threshold != 0


def _apply(state: MicrophoneState, command: SetSoundThreshold, _now_ns: int) -> None:
    state.threshold = command.level


def _threshold(words: Sequence[int]) -> Command:
    return SetSoundThreshold(words[0])


ACTUATOR = Actuator(
    name="microphone",
    accepts=(SetSoundThreshold,),
    begin=MicrophoneState,
    apply=_apply,
    aseba=ActuatorFace(outputs=(Output((("mic.threshold", 1),), _threshold),)),
)
