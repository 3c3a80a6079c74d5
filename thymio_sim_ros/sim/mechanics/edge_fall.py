"""Detects when robots leave the floor."""

from __future__ import annotations

from aseba_vm.kernel.types import Ints, kernel
from thymio_sim_ros.sim.ground.floor_support import FloorSupport
from thymio_sim_ros.sim.mechanics.fall import Fall
from thymio_sim_ros.sim.model.clock import TICK_NS, SimClock
from thymio_sim_ros.sim.model.geometry import Tilt
from thymio_sim_ros.sim.model.robot_state import RobotState
from thymio_sim_ros.sim.physics import Physics, RobotBody

__all__ = ["EdgeFall", "list_unsafe"]


@kernel
def list_unsafe(robots: RobotState, unsafe: Ints, count: Ints) -> None:
    """Write the robots that have moved by the distance to the edge found last to `unsafe`, `count[0]` of them."""
    found = 0
    for robot in range(robots.count):
        dx = robots.x[robot] - robots.safe_x[robot]
        dy = robots.y[robot] - robots.safe_y[robot]
        safe = robots.safe_m[robot]
        if robots.is_standing[robot] == 1 and dx * dx + dy * dy >= safe * safe:
            unsafe[found] = robot
            found += 1
    count[0] = found


class EdgeFall:
    """The support of one robot. Invariant: its body is off the floor while `tilt` is not None."""

    __slots__ = ("_body", "_clock", "_fall", "_physics")

    def __init__(self, clock: SimClock, physics: Physics, body: RobotBody) -> None:
        self._clock, self._physics, self._body = clock, physics, body
        self._fall: Fall | None = None

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
        self._fall = None
        self._body.state.safe_m[self._body.index] = 0.0

    def check_floor(self, floor_support: FloorSupport) -> None:
        """Make the robot fall if there is no floor under its origin; else note how far it is from the edge."""
        state, index = self._body.state, self._body.index
        x_m, y_m = state.x[index], state.y[index]
        clearance_m = floor_support.clearance_m(x_m, y_m)
        if clearance_m < 0.0:
            self._fall = Fall(self._clock.now_ns + TICK_NS, self._body.course_rad)
            self._physics.take_off_floor(self._body)
        state.safe_x[index], state.safe_y[index], state.safe_m[index] = x_m, y_m, max(0.0, clearance_m)
