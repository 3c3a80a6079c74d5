"""Key presses on an RC5 remote control (docs/spec/thymio-robot.md section 7.4).

While a key is held, a remote control repeats its frame. The toggle bit flips with every new press, so that the receiver
can tell a key pressed again from a repeated frame, which it ignores.
"""

from __future__ import annotations

from dataclasses import dataclass

from thymio_sim_ros.sim.commands import RemoteKey
from thymio_sim_ros.sim.stimuli import Stimulus

__all__ = ["STIMULUS", "RemoteState"]


@dataclass(slots=True)
class RemoteState:
    """The last frame received, and the number of frames so far, without repetitions."""

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


STIMULUS = Stimulus(name="remote", accepts=(RemoteKey,), begin=RemoteState, apply=_apply)
