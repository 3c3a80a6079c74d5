"""Actuators, one module each: what the robot does when it gets a command, such as to drive or to light up.

A module exports ACTUATOR. What operators and surroundings do to a robot is in `sim/stimuli/`.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from functools import partial

from thymio_sim_ros.files import registry
from thymio_sim_ros.sim.plugin_api.aseba_binding import NO_ACTUATOR_FACE, ActuatorFace
from thymio_sim_ros.sim.plugin_api.command_plugin import CommandPlugin, isolated

__all__ = ["Actuator", "all_actuators"]


@dataclass(frozen=True, slots=True)
class Actuator(CommandPlugin):
    """An actuator. `aseba` declares the variables and native functions by which Aseba programs command it."""

    aseba: ActuatorFace = NO_ACTUATOR_FACE


def all_actuators() -> tuple[Actuator, ...]:
    """All actuators, of this package and of other packages, in name order."""
    return registry.collect(sys.modules[__name__], "ACTUATOR", Actuator, guard=partial(isolated, "actuator"))
