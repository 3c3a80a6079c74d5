"""The body of a door: it slides between two places and nothing can stop it.

Its way goes as half a cosine: (1 - cos(π p / T)) / 2 of it is done when it has been opening for p of its T seconds
(playground-formats.md section 1.2); a door that turns back half-way goes back the same way.
"""

from __future__ import annotations

import math
from typing import Any

import pymunk

from thymio_sim_ros.sim.geometry import Pose
from thymio_sim_ros.sim.physics.contact import TICK_S
from thymio_sim_ros.sim.physics.outlines import shape_of
from thymio_sim_ros.sim.primitives import Solid
from thymio_sim_ros.sim.rays import Obstacle, obstacle_of

__all__ = ["DoorBody"]


class DoorBody:
    """One door. Invariant: `pose` is where it is after the last tick."""

    __slots__ = ("_moved", "_obstacle", "_opening_s", "_solid", "body", "is_moving", "pose", "reach_m", "shape")

    def __init__(self, solid: Solid, moved: set[Any]) -> None:
        """`moved`: where it adds itself when rays see it elsewhere."""
        self._moved = moved
        assert solid.slide is not None
        self._solid = solid
        self._opening_s = 0.0
        self.is_moving = False
        self.pose = solid.pose
        self._obstacle = obstacle_of(solid)
        self.body = pymunk.Body(body_type=pymunk.Body.KINEMATIC)
        self.body.position, self.body.angle = (solid.pose.x_m, solid.pose.y_m), solid.pose.yaw_rad
        self.reach_m = solid.outline.reach_m
        self.shape = shape_of(solid.outline, self.body)

    @property
    def is_fallen(self) -> bool:
        """Never: it hangs on rails."""
        return False

    @property
    def name(self) -> str:
        """Its shape's name."""
        return self._solid.name

    @property
    def solid(self) -> Solid:
        """What it is, where it is closed."""
        return self._solid

    @property
    def obstacle(self) -> Obstacle:
        """What rays see of it."""
        return self._obstacle

    def begin_tick(self, *, is_wanted_open: bool) -> None:
        """Set out for where it is to be after this tick."""
        slide = self._solid.slide
        assert slide is not None
        change_s = TICK_S if is_wanted_open else -TICK_S
        opening_s = max(0.0, min(slide.duration_s, self._opening_s + change_s))
        self.is_moving = opening_s != self._opening_s
        if not self.is_moving:
            return
        self._opening_s = opening_s
        done = (1.0 - math.cos(math.pi * opening_s / slide.duration_s)) / 2
        closed, opened = self._solid.pose, slide.opened
        pose = Pose(
            closed.x_m + (opened.x_m - closed.x_m) * done,
            closed.y_m + (opened.y_m - closed.y_m) * done,
            closed.yaw_rad + (opened.yaw_rad - closed.yaw_rad) * done,
        )
        self.body.velocity = ((pose.x_m - self.pose.x_m) / TICK_S, (pose.y_m - self.pose.y_m) / TICK_S)
        self.body.angular_velocity = (pose.yaw_rad - self.pose.yaw_rad) / TICK_S
        self.pose = pose
        self._obstacle = obstacle_of(self._solid.at(pose))
        self._moved.add(self)

    def end_tick(self) -> None:
        """Be exactly there, at rest."""
        if self.is_moving:
            self.body.position, self.body.angle = (self.pose.x_m, self.pose.y_m), self.pose.yaw_rad
            self.body.velocity, self.body.angular_velocity = (0.0, 0.0), 0.0
