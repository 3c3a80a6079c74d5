"""A robot that has fallen off an edge.

Its origin, the center of mass, is not over the floor (docs/spec/thymio-robot.md section 1.1). It falls
freely for as long as from a table of 0.2 m, tilts in the direction of its motion, and then lies with its wheels in the
air until it is moved. Height and tilt are assumptions: no source gives them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from thymio_sim_ros.sim.model.geometry import LEVEL, Tilt

__all__ = ["FALL_NS", "Fall"]

FALL_NS = 200_000_000
"""sqrt(2 h / g) of a height of 0.2 m."""
_SLANT_RAD = math.radians(50)
"""Tilt of a fallen robot."""


@dataclass(frozen=True, slots=True)
class Fall:
    """When a robot lost the floor, and which way it went then: 0 forwards, counter-clockwise, in its own frame."""

    began_ns: int
    course_rad: float

    def is_free(self, now_ns: int) -> bool:
        """Whether it is still in the air."""
        return now_ns - self.began_ns < FALL_NS

    def tilt(self, now_ns: int) -> Tilt:
        """The tilt: it grows linearly in the air, then stays."""
        slant = _SLANT_RAD * min(1.0, (now_ns - self.began_ns) / FALL_NS)
        if slant == 0.0:
            return LEVEL
        return Tilt(-slant * math.sin(self.course_rad), slant * math.cos(self.course_rad))
