"""Records contacts in each robot's `touching`, from pymunk's callbacks for contacts that begin and end."""

from __future__ import annotations

import math
from typing import Any

import pymunk

from thymio_sim_ros.sim.physics.contact import ROBOT_BOUNCE, Contact
from thymio_sim_ros.sim.physics.robot_body import ROBOT_TYPE, RobotBody

__all__ = ["ContactTracker"]

_RIGID_TYPE, _BOUNCING_TYPE = 2, 3
"""pymunk's collision types of what never bounces, as walls and doors, and of objects that bounce."""


class ContactTracker:
    """The contacts in a space. Invariant: every shape in it has a name here, every robot's shape its robot."""

    def __init__(self, space: pymunk.Space) -> None:
        self._names: dict[pymunk.Shape, str] = {}
        self._robots: dict[pymunk.Shape, RobotBody] = {}
        for other in (ROBOT_TYPE, _RIGID_TYPE, _BOUNCING_TYPE):
            space.on_collision(ROBOT_TYPE, other, self._on_begin, separate=self._on_separate)
        space.on_collision(_BOUNCING_TYPE, _BOUNCING_TYPE, pre_solve=_bounce)

    def watch(self, shape: pymunk.Shape, owner: RobotBody | str) -> None:
        """Register the shape of a robot, or of an object or wall of this name, before it is added to the space."""
        if isinstance(owner, RobotBody):
            self._robots[shape] = owner
            self._names[shape] = owner.name
        else:
            shape.collision_type = _BOUNCING_TYPE if shape.elasticity > 0.0 else _RIGID_TYPE
            self._names[shape] = owner

    def forget(self, shape: pymunk.Shape) -> None:
        """Remove the contacts with a shape."""
        for robot in self._robots.values():
            if robot.touching.pop(shape, None) is not None:
                robot.hold()

    def unwatch(self, shape: pymunk.Shape) -> None:
        """Unregister a shape that has left the space for good. Raises KeyError for one that is not registered."""
        self.forget(shape)
        self._robots.pop(shape, None)
        del self._names[shape]

    def _on_begin(self, arbiter: pymunk.Arbiter, _space: pymunk.Space, _data: Any) -> None:
        one, other = arbiter.shapes
        points = arbiter.contact_point_set
        x, y = _middle(points)
        # Relative velocity of the two bodies at the contact, along the normal from the first shape to the second.
        speed = max(0.0, (_velocity(one, (x, y)) - _velocity(other, (x, y))).dot(points.normal))
        for mine, its in ((one, other), (other, one)):
            robot = self._robots.get(mine)
            if robot is not None:
                robot.touching[its] = Contact(robot.name, self._names[its], x, y, speed, True)
                robot.hold()

    def _on_separate(self, arbiter: pymunk.Arbiter, _space: pymunk.Space, _data: Any) -> None:
        one, other = arbiter.shapes
        for mine, its in ((one, other), (other, one)):
            robot = self._robots.get(mine)
            if robot is not None:
                robot.touching.pop(its, None)
                robot.hold()


def _bounce(arbiter: pymunk.Arbiter, _space: pymunk.Space, _data: Any) -> None:
    """Undo the division of elasticities (see `ROBOT_BOUNCE`) for two objects."""
    arbiter.restitution *= ROBOT_BOUNCE * ROBOT_BOUNCE


def _middle(points: pymunk.ContactPointSet) -> tuple[float, float]:
    """The middle of a contact in the world's frame.

    `fsum` is exact, so the result does not depend on the order of points and shapes, which mirrored worlds change.
    """
    ends = [end for point in points.points for end in (point.point_a, point.point_b)]
    return (math.fsum(end.x for end in ends) / len(ends), math.fsum(end.y for end in ends) / len(ends))


def _velocity(shape: pymunk.Shape, point: tuple[float, float]) -> pymunk.Vec2d:
    """The velocity of a shape's body at a point in the world's frame."""
    assert shape.body is not None
    return shape.body.velocity_at_world_point(point)
