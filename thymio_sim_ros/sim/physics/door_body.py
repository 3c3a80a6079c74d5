"""The body of a door: it slides between two positions and pushes what is in its way.

Its way goes as half a cosine: (1 - cos(π p / T)) / 2 of it is done when it has been opening for p of its T seconds
(docs/spec/playground-formats.md section 1.2); a door that turns back half-way goes back the same way. What cannot get
out of its way stops it: it goes back by a tick, rests, and tries again.
"""

from __future__ import annotations

import math
from typing import Any

import pymunk

from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.model.primitives import Solid
from thymio_sim_ros.sim.physics.contact import TICK_S
from thymio_sim_ros.sim.physics.shape_factory import shape_of
from thymio_sim_ros.sim.raycast.scalar import Obstacle, obstacle_of

__all__ = ["DoorBody"]

_TOUCHED_M = 0.0005
"""Overlap from which on it pushes: more than the engine leaves between touching bodies."""
_AHEAD = 0.1
"""Fraction of its speed that an object in its way gets at least; the rest slides along the object."""
_GIVES_WAY = 0.9
"""Fraction of the pushing speed; an object that has reached it gives way."""
_REST_TICKS = 100
"""After it was stopped; in the first of them it goes back."""


class DoorBody:
    """One door. Invariant: `pose` is where it is after the last tick.

    `is_moving` while it is on its way, even when it rests.
    """

    __slots__ = (
        "_is_opening",
        "_moved",
        "_obstacle",
        "_opening_s",
        "_rest_ticks",
        "_solid",
        "body",
        "is_moving",
        "pose",
        "reach_m",
        "shape",
    )

    def __init__(self, solid: Solid, moved: set[Any]) -> None:
        """Create the closed door; it adds itself to `moved` whenever its obstacle has changed."""
        self._moved = moved
        assert solid.slide is not None
        self._solid = solid
        self._opening_s = 0.0
        self._rest_ticks = 0
        self._is_opening = self.is_moving = False
        self.pose = solid.pose
        self._obstacle = obstacle_of(solid)
        self.body = pymunk.Body(body_type=pymunk.Body.KINEMATIC)
        self.body.position, self.body.angle = (solid.pose.x_m, solid.pose.y_m), solid.pose.yaw_rad
        self.reach_m = solid.outline.reach_m
        self.shape = shape_of(solid.outline, self.body)

    @property
    def is_fallen(self) -> bool:
        """Always False: doors do not fall."""
        return False

    @property
    def name(self) -> str:
        """Name of its shape."""
        return self._solid.name

    @property
    def solid(self) -> Solid:
        """The solid at its closed position."""
        return self._solid

    @property
    def obstacle(self) -> Obstacle:
        """The obstacle that rays see."""
        return self._obstacle

    def begin_tick(self, *, is_wanted_open: bool) -> None:
        """Set the velocity that brings it to its position after this tick."""
        if is_wanted_open != self._is_opening:
            self._is_opening, self._rest_ticks = is_wanted_open, 0
        change_s = TICK_S if is_wanted_open else -TICK_S
        opening_s = self._after(change_s)
        self.is_moving = opening_s != self._opening_s
        if not self.is_moving:
            return
        if self._rest_ticks > 0:
            self._rest_ticks -= 1
            if self._rest_ticks + 1 < _REST_TICKS:
                return
            opening_s = self._after(-change_s)
        slide = self._solid.slide
        assert slide is not None
        done = (1.0 - math.cos(math.pi * opening_s / slide.duration_s)) / 2
        closed, opened = self._solid.pose, slide.opened
        pose = Pose(
            closed.x_m + (opened.x_m - closed.x_m) * done,
            closed.y_m + (opened.y_m - closed.y_m) * done,
            closed.yaw_rad + (opened.yaw_rad - closed.yaw_rad) * done,
        )
        self.body.velocity = ((pose.x_m - self.pose.x_m) / TICK_S, (pose.y_m - self.pose.y_m) / TICK_S)
        self.body.angular_velocity = (pose.yaw_rad - self.pose.yaw_rad) / TICK_S
        self._opening_s, self.pose = opening_s, pose
        self._obstacle = obstacle_of(self._solid.at(pose))
        self._moved.add(self)

    def end_tick(self, space: pymunk.Space) -> None:
        """Put the body exactly at that position, at rest; test whether something stops the door."""
        if not self.is_moving:
            return
        self.body.position, self.body.angle = (self.pose.x_m, self.pose.y_m), self.pose.yaw_rad
        if self._rest_ticks == 0 and self._is_stopped(space):
            self._rest_ticks = _REST_TICKS
        self.body.velocity, self.body.angular_velocity = (0.0, 0.0), 0.0

    def _after(self, change_s: float) -> float:
        """The opening time after a change, within 0 and the duration of the slide."""
        slide = self._solid.slide
        assert slide is not None
        return max(0.0, min(slide.duration_s, self._opening_s + change_s))

    def _is_stopped(self, space: pymunk.Space) -> bool:
        """Whether an object or robot in its way does not give way."""
        for met in space.shape_query(self.shape):
            other = met.shape.body if met.shape is not None else None
            if other is None or other.body_type != pymunk.Body.DYNAMIC:
                continue
            normal = met.contact_point_set.normal
            for point in met.contact_point_set.points:
                speed = self.body.velocity_at_world_point(point.point_a)
                pushed_m_s, given_m_s = speed.dot(normal), other.velocity_at_world_point(point.point_a).dot(normal)
                is_ahead = -point.distance > _TOUCHED_M and pushed_m_s > speed.length * _AHEAD
                if is_ahead and given_m_s < pushed_m_s * _GIVES_WAY:
                    return True
        return False
