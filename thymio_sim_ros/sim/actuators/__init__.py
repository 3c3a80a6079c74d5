"""Actuators, one file each: the commands they accept, and what they do with them in every tick.

A module exports ACTUATOR. Its state on one robot is an object made by `begin`; commands change it by `apply`,
and `update`, if there is one, acts on the robot once per tick: when `is_idle` is there, only from a command on until
the state is idle. `update_all`, if there is one, does for all robots of a crowd what `update` does one by one.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

from thymio_sim_ros import registry
from thymio_sim_ros.sim.plugin_api.aseba_binding import NO_ACTUATOR_FACE, ActuatorFace
from thymio_sim_ros.sim.plugin_api.plugin_isolation import Guard
from thymio_sim_ros.sim.plugin_api.view import ActuatorView, GroupActuatorView

__all__ = ["Actuator", "all_actuators"]


@dataclass(frozen=True, slots=True)
class Actuator:
    """One actuator; `accepts` are the types of its commands. Times in ns, `update`'s last argument in s."""

    name: str
    accepts: tuple[type[Any], ...]
    begin: Callable[[], Any]
    apply: Callable[[Any, Any, int], None]
    update: Callable[[Any, ActuatorView, float], None] | None = None
    aseba: ActuatorFace = NO_ACTUATOR_FACE
    is_idle: Callable[[Any], bool] | None = None
    update_all: Callable[[Sequence[Any], GroupActuatorView, float], None] | None = None


def all_actuators() -> tuple[Actuator, ...]:
    """Every actuator of this folder and of other packages, in name order."""
    return registry.collect(sys.modules[__name__], "ACTUATOR", Actuator, guard=_guarded)


def _guarded(actuator: Actuator) -> Actuator:
    """One of another package: its errors do not stop the world."""
    guard, update = Guard(actuator.name), actuator.update
    return replace(
        actuator,
        begin=partial(guard.begin, actuator.begin),
        apply=partial(guard.run, actuator.apply),
        update=None if update is None else partial(guard.run, update),
    )
