"""The body of one robot: a pymunk body, its contacts, and its element of the robots' motion."""

from __future__ import annotations

import math
from dataclasses import replace

import pymunk

from thymio_sim_ros.sim.model import robot_constants
from thymio_sim_ros.sim.model.geometry import Pose, wrap_angle
from thymio_sim_ros.sim.model.robot_state import RobotState, WheelState
from thymio_sim_ros.sim.physics.contact import ROBOT_BOUNCE, Contact
from thymio_sim_ros.sim.physics.driving import MOMENT_KG_M2
from thymio_sim_ros.sim.raycast.scalar import ConvexObstacle

__all__ = ["ROBOT_TYPE", "RobotBody"]

ROBOT_TYPE = 1
"""pymunk's collision type of robots."""
_PASSING = pymunk.ShapeFilter(group=1)
"""Shapes of one group do not touch each other."""
_AT_REST_M_S = 1e-6
_HULL = robot_constants.hull()


class RobotBody:
    """One robot's body. `state` has its motion at `index`, after the last tick; `wheels` has that of its wheels."""

    __slots__ = (
        "_held",
        "_obstacle",
        "_pose",
        "body",
        "index",
        "is_standing",
        "name",
        "shape",
        "state",
        "touching",
        "wheels",
    )

    def __init__(self, name: str, pose: Pose, held: dict[RobotBody, None], *, is_solid: bool = True) -> None:
        """`held`: where it adds itself when a contact begins or ends. It is placed once it has been attached.

        `is_solid`: whether it touches other robots.
        """
        self._held = held
        self.name = name
        self.touching: dict[pymunk.Shape, Contact] = {}
        self.is_standing = True
        """Whether it stands on the floor; otherwise nothing touches or sees it until it is placed."""
        self.state: RobotState
        self.wheels: WheelState
        self.index = 0
        self._pose = pose
        self._obstacle: tuple[Pose, ConvexObstacle] | None = None
        self.body = pymunk.Body(robot_constants.MASS_KG, MOMENT_KG_M2)
        self.body.position, self.body.angle = (pose.x_m, pose.y_m), pose.yaw_rad
        self.shape = pymunk.Poly(self.body, _HULL)
        self.shape.collision_type = ROBOT_TYPE
        self.shape.elasticity = ROBOT_BOUNCE
        if not is_solid:
            self.shape.filter = _PASSING

    def attach(self, state: RobotState, wheels: WheelState, index: int) -> None:
        """Use an element of the views of these records from now on."""
        self.state, self.wheels, self.index = state, wheels, index

    @property
    def pose(self) -> Pose:
        """True pose; the same object as long as it does not move."""
        state, index, known = self.state, self.index, self._pose
        x_m, y_m, yaw_rad = state.x[index], state.y[index], state.yaw[index]
        if known.yaw_rad != yaw_rad or known.x_m != x_m or known.y_m != y_m:
            self._pose = known = Pose(x_m, y_m, yaw_rad)
        return known

    @property
    def speed_m_s(self) -> float:
        """Speed along the heading."""
        speed: float = self.state.speed[self.index]
        return speed

    @property
    def turn_rate_rad_s(self) -> float:
        """Rate of turn, counter-clockwise."""
        rate: float = self.state.turn_rate[self.index]
        return rate

    @property
    def reach_m(self) -> float:
        """Largest distance of any of its points from its origin."""
        return robot_constants.HULL_RADIUS_M

    @property
    def obstacle(self) -> ConvexObstacle:
        """Its obstacle for the rays of others."""
        pose = self.pose
        if self._obstacle is None or self._obstacle[0] is not pose:
            self._obstacle = (pose, ConvexObstacle(pose.place_all(_HULL), robot_constants.HULL_HEIGHT_M))
        return self._obstacle[1]

    @property
    def course_rad(self) -> float:
        """The direction in which it moves, in its own frame; 0 at rest."""
        if not self.state.was_touching[self.index]:
            return math.pi if self.speed_m_s < 0.0 else 0.0
        vx, vy = self.body.velocity
        return wrap_angle(math.atan2(vy, vx) - self.pose.yaw_rad) if math.hypot(vx, vy) > _AT_REST_M_S else 0.0

    def place(self, pose: Pose) -> None:
        """Place it at a pose, at rest; it stands on the floor from now on."""
        self.is_standing = True
        body, state, index = self.body, self.state, self.index
        body.position, body.angle = (pose.x_m, pose.y_m), pose.yaw_rad
        body.velocity, body.angular_velocity = (0.0, 0.0), 0.0
        state.x[index], state.y[index], state.yaw[index] = pose.x_m, pose.y_m, pose.yaw_rad
        state.is_standing[index] = 1
        self._stop()
        if body.space is not None:
            body.space.reindex_shapes_for_body(body)

    def leave_floor(self) -> None:
        """Leave the floor: from now on the wheels have no grip."""
        self.is_standing = False
        self.touching.clear()
        state, index = self.state, self.index
        state.is_standing[index] = state.is_touching[index] = state.was_touching[index] = 0
        self._stop()

    def hold(self) -> None:
        """Note that a contact has begun or ended. Also called while a space is freed, when `state` may be gone."""
        self._held[self] = None

    def update_touching(self) -> None:
        """Write to the record whether it is in contact."""
        self.state.is_touching[self.index] = 1 if self.touching else 0

    def begin_tick(self) -> None:
        """Its contacts are no longer new; in contact, it has covered nothing yet in this tick."""
        state, index = self.state, self.index
        state.was_touching[index] = state.is_touching[index]
        self.wheels.covered[2 * index] = self.wheels.covered[2 * index + 1] = 0.0
        for key, contact in self.touching.items():
            if contact.is_new:
                self.touching[key] = replace(contact, is_new=False)

    def _stop(self) -> None:
        state, index = self.state, self.index
        state.speed[index] = state.turn_rate[index] = state.velocity_x[index] = state.velocity_y[index] = 0.0
