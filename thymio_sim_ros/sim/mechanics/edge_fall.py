"""Detects when a robot leaves the floor."""

from __future__ import annotations

from thymio_sim_ros.sim.ground.floor_support import FloorSupport
from thymio_sim_ros.sim.mechanics.fall import Fall
from thymio_sim_ros.sim.model import robot_constants
from thymio_sim_ros.sim.model.clock import TICK_NS, SimClock
from thymio_sim_ros.sim.model.geometry import Tilt
from thymio_sim_ros.sim.physics import Physics, RobotBody

__all__ = ["EdgeFall"]

_MAX_TICK_DISTANCE_M = robot_constants.MAX_SPEED_M_S * TICK_NS * 1e-9
"""Longest distance of a robot in a tick, unless it is pushed."""
_MAX_SAFE_TICKS = 100


class EdgeFall:
    """The support of one robot. Invariant: its body has fallen exactly when `tilt` is not None."""

    __slots__ = ("_body", "_clock", "_fall", "_physics", "_safe_ticks")

    def __init__(self, clock: SimClock, physics: Physics, body: RobotBody) -> None:
        self._clock, self._physics, self._body = clock, physics, body
        self._fall: Fall | None = None
        self._safe_ticks = 0

    @property
    def tilt(self) -> Tilt | None:
        """Tilt while it falls and lies; None while it stands."""
        return None if self._fall is None else self._fall.tilt(self._clock.now_ns)

    @property
    def is_falling(self) -> bool:
        """Whether the robot is in the air after an edge."""
        return self._fall is not None and self._fall.is_free(self._clock.now_ns)

    def clear(self) -> None:
        """Forget a fall: the robot was placed."""
        self._fall, self._safe_ticks = None, 0

    def check_floor(self, floor_support: FloorSupport) -> None:
        """Make the robot fall if there is no floor under its origin."""
        # The clearance is a lower bound of the distance to the edge, so for some ticks the robot cannot reach it by its
        # own wheels. A robot in contact may be pushed faster and is checked in each tick.
        if self._safe_ticks > 0 and not self._body.touching:
            self._safe_ticks -= 1
        elif self._fall is None:
            safe_m = self.check_floor_at(floor_support, self._body.pose.x_m, self._body.pose.y_m)
            self._safe_ticks = int(min(safe_m / _MAX_TICK_DISTANCE_M, _MAX_SAFE_TICKS))

    def check_floor_at(self, floor_support: FloorSupport, x_m: float, y_m: float) -> float:
        """Make the robot fall if there is no floor at its position; returns a lower bound of the distance to the
        edge in m, 0 when it falls.
        """
        clearance_m = floor_support.clearance_m(x_m, y_m)
        if clearance_m < 0.0 and self._fall is None:
            self._fall = Fall(self._clock.now_ns + TICK_NS, self._body.course_rad)
            self._physics.drop_robot(self._body)
        return max(0.0, clearance_m)
