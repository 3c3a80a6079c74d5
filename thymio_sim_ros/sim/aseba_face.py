"""What a sensor or an actuator looks like to an Aseba program; `device/` derives its bindings from it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from thymio_sim_ros.sim.commands import Command

__all__ = ["NO_ACTUATOR_FACE", "NO_SENSOR_FACE", "ActuatorFace", "AsebaFace", "Native", "Output"]


@dataclass(frozen=True, slots=True)
class AsebaFace:
    """A sensor: variables (name, words) that hold its reading's words in order, and the event it raises.

    With `edge_events`, every variable whose value changed also raises the local event of its own name.
    """

    variables: tuple[tuple[str, int], ...] = ()
    event: str | None = None
    edge_events: bool = False


@dataclass(frozen=True, slots=True)
class Output:
    """Variables (name, words) that a program writes; together, in order, they make one command."""

    variables: tuple[tuple[str, int], ...]
    command: Callable[[Sequence[int]], Command]


@dataclass(frozen=True, slots=True)
class Native:
    """A native function of one-word parameters; its arguments make one command.

    `variable`, if any, is a variable of as many words that the arguments are copied to.
    """

    name: str
    parameters: tuple[str, ...]
    command: Callable[[Sequence[int]], Command]
    description: str = ""
    variable: str | None = None


@dataclass(frozen=True, slots=True)
class ActuatorFace:
    """An actuator: the variables it obeys, and the native functions that reach it."""

    outputs: tuple[Output, ...] = ()
    natives: tuple[Native, ...] = ()


NO_SENSOR_FACE = AsebaFace()
NO_ACTUATOR_FACE = ActuatorFace()
