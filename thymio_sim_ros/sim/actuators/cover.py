"""An operator's hand over the sensors that look: what proximity and ground sensors count instead of what they see."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from thymio_sim_ros.sim.actuators import Actuator
from thymio_sim_ros.sim.commands import SetGround, SetProximity

__all__ = ["ACTUATOR", "CoverState", "covered"]


@dataclass(slots=True)
class CoverState:
    """Counts of the seven proximity and the two ground sensors; -1 or nothing at all: they see by themselves."""

    proximity: tuple[int, ...] = ()
    ground: tuple[int, ...] = ()


def covered(seen: Sequence[int], cover: Sequence[int]) -> list[int]:
    """What sensors count under a cover."""
    return [own if hand < 0 else hand for own, hand in zip(seen, cover, strict=True)] if cover else list(seen)


def _apply(state: CoverState, command: SetProximity | SetGround, _now_ns: int) -> None:
    counts = command.counts if max(command.counts) >= 0 else ()
    if isinstance(command, SetProximity):
        state.proximity = counts
    else:
        state.ground = counts


ACTUATOR = Actuator(name="cover", accepts=(SetProximity, SetGround), begin=CoverState, apply=_apply)
