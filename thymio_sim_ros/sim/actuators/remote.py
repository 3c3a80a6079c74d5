"""The remote control in the operator's hand (docs/spec/thymio-robot.md section 7.4).

While a key is held, a remote control repeats its frame; every new press turns the toggle bit over, which is how the
receiver tells a repeated frame, to be ignored, from a key pressed again.
"""

from __future__ import annotations

from dataclasses import dataclass

from thymio_sim_ros.sim.actuators import Actuator
from thymio_sim_ros.sim.commands import RemoteKey

__all__ = ["ACTUATOR", "RemoteState"]


@dataclass(slots=True)
class RemoteState:
    """The last frame received, and how many that were no repetition there have been."""

    address: int = 0
    command: int = 0
    toggle: bool = False
    frames: int = 0


def _apply(state: RemoteState, key: RemoteKey, _now_ns: int) -> None:
    toggle = not state.toggle if key.toggle is None else key.toggle
    if state.frames and (key.address, key.command, toggle) == (state.address, state.command, state.toggle):
        return
    state.address, state.command, state.toggle = key.address, key.command, toggle
    state.frames += 1


ACTUATOR = Actuator(name="remote", accepts=(RemoteKey,), begin=RemoteState, apply=_apply)
