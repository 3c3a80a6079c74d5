"""The Aseba side of a sensor or an actuator; `device/` derives variables, events and native functions from it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from thymio_sim_ros.sim.commands import Command

__all__ = ["NO_ACTUATOR_FACE", "NO_SENSOR_FACE", "ActuatorFace", "AsebaFace", "Native", "Output"]


@dataclass(frozen=True, slots=True)
class AsebaFace:
    """A sensor: variables (name, words) that hold its reading's words in order, and the event it raises.

    `unseen` names the words after them, which no variable holds: only the robot's own rules look at them. With
    `edge_events`, every variable whose value changed also raises the local event of its own name. With `above`, the
    name of a variable, the event is raised only while that variable is not 0 and the first word exceeds it.
    """

    variables: tuple[tuple[str, int], ...] = ()
    event: str | None = None
    edge_events: bool = False
    above: str | None = None
    unseen: tuple[str, ...] = ()

    @property
    def size(self) -> int:
        """Number of words in a reading."""
        return sum(size for _, size in self.variables) + len(self.unseen)


@dataclass(frozen=True, slots=True)
class Output:
    """Variables (name, words) that a program writes; together, in order, they make one command."""

    variables: tuple[tuple[str, int], ...]
    command: Callable[[Sequence[int]], Command]


def _nothing(_words: Sequence[int]) -> Mapping[str, Sequence[int]]:
    return {}


@dataclass(frozen=True, slots=True)
class Native:
    """A native function; the words of its arguments, one after the other, make one command.

    A parameter is a name for one word, or `name:words` for an array. `writes` says which whole variables the call
    itself sets, and to what. A ValueError of `command` is a fault of the program, with its text.
    """

    name: str
    parameters: tuple[str, ...]
    command: Callable[[Sequence[int]], Command]
    description: str = ""
    writes: Callable[[Sequence[int]], Mapping[str, Sequence[int]]] = _nothing

    @property
    def signature(self) -> tuple[tuple[str, int], ...]:
        """Name and number of words of each parameter."""
        parts = (parameter.partition(":") for parameter in self.parameters)
        return tuple((name, int(words or 1)) for name, _, words in parts)


@dataclass(frozen=True, slots=True)
class ActuatorFace:
    """An actuator: variables and native functions that command it, and its commands at a reset of the robot.

    A reset also sends the commands of its variables, which are then all zero.
    """

    outputs: tuple[Output, ...] = ()
    natives: tuple[Native, ...] = ()
    at_reset: tuple[Command, ...] = ()


NO_SENSOR_FACE = AsebaFace()
NO_ACTUATOR_FACE = ActuatorFace()
