"""The sending half of infrared communication (docs/spec/thymio-robot.md section 7.5); see also `sensors/comm.py`.

All seven emitters send the same value in every frame. A negative value is a pulse without data, which no robot decodes.
Off is the state after a reset; switching off zeroes what was sent and what was received.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from thymio_sim_ros.sim.actuators import Actuator
from thymio_sim_ros.sim.commands import Command, EnableComm, SetCommPayload
from thymio_sim_ros.sim.plugin_api.aseba_binding import ActuatorFace, Native, Output

__all__ = ["ACTUATOR", "FULL_PAYLOAD", "CommState"]

FULL_PAYLOAD = 2047
"""The largest value that is sent (docs/spec/thymio-robot.md section 7.5)."""


@dataclass(slots=True)
class CommState:
    """Whether communication is enabled, and the value to send, at most FULL_PAYLOAD."""

    is_enabled: bool = False
    payload: int = 0

    @property
    def is_sending(self) -> bool:
        """Whether other robots can decode a value."""
        return self.is_enabled and self.payload >= 0


def _apply(state: CommState, command: EnableComm | SetCommPayload, _now_ns: int) -> None:
    if isinstance(command, SetCommPayload):
        state.payload = min(command.value, FULL_PAYLOAD)
        return
    state.is_enabled = command.is_enabled
    if not command.is_enabled:
        state.payload = 0


def _payload(words: Sequence[int]) -> Command:
    return SetCommPayload(words[0])


def _enable(words: Sequence[int]) -> Command:
    return EnableComm(words[0] != 0)


def _zeroes(words: Sequence[int]) -> Mapping[str, Sequence[int]]:
    return {} if words[0] else {"prox.comm.rx": (0,), "prox.comm.tx": (0,)}


ACTUATOR = Actuator(
    name="comm",
    accepts=(EnableComm, SetCommPayload),
    begin=CommState,
    apply=_apply,
    aseba=ActuatorFace(
        outputs=(Output((("prox.comm.tx", 1),), _payload),),
        natives=(Native("prox.comm.enable", ("state",), _enable, "Switch infrared communication on or off", _zeroes),),
        at_reset=(EnableComm(False),),
    ),
)
