"""Stimuli, one module each: what an operator or the surroundings do to a robot, such as to press a button or to clap.

A module exports STIMULUS. Commands from ROS, the page or a test apply stimuli; Aseba programs cannot. Sensors read
the state of a stimulus by `SensorView.state`.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from functools import partial

from thymio_sim_ros.files import registry
from thymio_sim_ros.sim.plugin_api.command_plugin import CommandPlugin, isolated

__all__ = ["Stimulus", "all_stimuli"]


@dataclass(frozen=True, slots=True)
class Stimulus(CommandPlugin):
    """A stimulus."""


def all_stimuli() -> tuple[Stimulus, ...]:
    """All stimuli, of this package and of other packages, in name order."""
    return registry.collect(sys.modules[__name__], "STIMULUS", Stimulus, guard=partial(isolated, "stimulus"))
