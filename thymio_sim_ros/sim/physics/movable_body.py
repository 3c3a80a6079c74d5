"""The body of a box or cylinder that can be pushed.

It rubs on the floor by Coulomb's law with the real g, and a little by its speed; it may bounce off a robot, but off
nothing else (docs/spec/thymio-robot.md section 11, last line).
The floor holds its turning as if all of its weight lay at the load's lever.
"""

from __future__ import annotations

import math
from typing import Any

import pymunk

from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.model.primitives import Disc, Solid
from thymio_sim_ros.sim.physics.contact import ROBOT_BOUNCE
from thymio_sim_ros.sim.physics.shape_factory import shape_of
from thymio_sim_ros.sim.raycast.scalar import Obstacle, obstacle_of

__all__ = ["AT_REST_M_S", "MovableBody"]

_GRAVITY_M_S2 = 9.81
AT_REST_M_S = 1e-6
"""Slower than this, at its rim too, is at rest."""


class MovableBody:
    """One movable solid. Invariant: `pose` is the body's after the last tick; it changes only when it moves."""

    __slots__ = (
        "_moved",
        "_obstacle",
        "_solid",
        "body",
        "is_fallen",
        "is_moving",
        "joints",
        "pose",
        "reach_m",
        "shape",
    )

    def __init__(self, solid: Solid, floor: pymunk.Body, moved: set[Any]) -> None:
        """Create the body; it adds itself to `moved` whenever its obstacle has changed or is gone."""
        self._moved = moved
        load = solid.load
        assert load is not None
        self._solid = solid
        self.is_moving = self.is_fallen = False
        self._obstacle: Obstacle | None = None
        outline = solid.outline
        self.reach_m = outline.reach_m
        if isinstance(outline, Disc):
            moment = pymunk.moment_for_circle(load.mass_kg, 0.0, outline.radius_m)
        else:
            moment = pymunk.moment_for_poly(load.mass_kg, outline.vertices)
        self.body = pymunk.Body(load.mass_kg, moment)
        self.shape = shape_of(outline, self.body)
        self.shape.elasticity = load.restitution / ROBOT_BOUNCE
        slide = pymunk.PivotJoint(floor, self.body, (0.0, 0.0), (0.0, 0.0))
        turn = pymunk.GearJoint(floor, self.body, 0.0, 1.0)
        slide.max_bias = turn.max_bias = 0.0
        slide.max_force = load.friction * load.mass_kg * _GRAVITY_M_S2
        turn.max_force = slide.max_force * load.lever_m
        self.joints = (slide, turn)
        self.place(solid.pose)

    @property
    def name(self) -> str:
        """Name of its shape."""
        return self._solid.name

    @property
    def solid(self) -> Solid:
        """The solid at its start pose."""
        return self._solid

    @property
    def obstacle(self) -> Obstacle:
        """The obstacle that rays see."""
        if self._obstacle is None:
            self._obstacle = obstacle_of(self._solid.at(self.pose))
        return self._obstacle

    def place(self, pose: Pose) -> None:
        """Move it to a pose, at rest; a fallen object stands on the floor again."""
        self.is_fallen = False
        self._stop()
        self.body.position, self.body.angle = (pose.x_m, pose.y_m), pose.yaw_rad
        self._set_pose(pose)
        if self.body.space is not None:
            self.body.space.reindex_shapes_for_body(self.body)

    def fall(self) -> None:
        """Fall: nothing touches or sees it until `place`."""
        self.is_fallen, self.is_moving = True, False
        self._moved.add(self)

    def end_tick(self, x_m: float, y_m: float, angle: float, vx: float, vy: float, spin: float) -> None:
        """Update pose and flags from the state of the body (m, rad, s); stop it below `AT_REST_M_S`."""
        speed = math.hypot(vx, vy)
        speed += abs(spin) * self.reach_m
        self.is_moving = speed > AT_REST_M_S
        if not self.is_moving and speed > 0.0 and not self.body.is_sleeping:
            self._stop()
        if (x_m, y_m, angle) != (self.pose.x_m, self.pose.y_m, self.pose.yaw_rad):
            self._set_pose(Pose(x_m, y_m, angle))

    def _stop(self) -> None:
        self.is_moving = False
        self.body.velocity, self.body.angular_velocity = (0.0, 0.0), 0.0

    def _set_pose(self, pose: Pose) -> None:
        self.pose = pose
        self._obstacle = None
        self._moved.add(self)
