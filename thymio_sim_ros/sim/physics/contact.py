"""Contacts, and the constants of a step that all kinds of bodies share."""

from __future__ import annotations

from dataclasses import dataclass

from thymio_sim_ros.sim.model.clock import TICK_NS

__all__ = ["ROBOT_BOUNCE", "SUB_STEPS", "SUB_STEP_S", "TICK_S", "Contact"]

SUB_STEPS = 2
TICK_S = TICK_NS * 1e-9
SUB_STEP_S = TICK_S / SUB_STEPS


ROBOT_BOUNCE = 2.0**-32
"""Elasticity of robots. pymunk multiplies the elasticities of two shapes. Those of objects are divided by this power of
two, which is exact: objects bounce off robots by their own elasticity, and robots do not bounce off each other."""


@dataclass(frozen=True, slots=True)
class Contact:
    """A robot touches a solid or another robot, named by `other`.

    `speed_m_s` is the speed of approach when the contact began; `is_new` when that was in this tick.
    """

    robot: str
    other: str
    x_m: float
    y_m: float
    speed_m_s: float
    is_new: bool
