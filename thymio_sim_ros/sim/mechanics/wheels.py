"""The wheels of robots: speeds, angles, and the odometry computed from them."""

from __future__ import annotations

from aseba_vm.kernel.types import kernel
from thymio_sim_ros.sim.kernel.elementary import cos, sin
from thymio_sim_ros.sim.mechanics.motor_control import report_ideal
from thymio_sim_ros.sim.model.clock import TICK_NS
from thymio_sim_ros.sim.model.geometry import Pose, Twist
from thymio_sim_ros.sim.model.robot_constants import WHEEL_RADIUS_M, WHEEL_TRACK_M
from thymio_sim_ros.sim.model.robot_state import RobotState, WheelState
from thymio_sim_ros.sim.physics.robot_body import RobotBody

__all__ = ["Wheels", "roll", "twist_of"]

_TICK_S = TICK_NS * 1e-9
_TRACK_M = WHEEL_TRACK_M
_RADIUS_M = WHEEL_RADIUS_M


@kernel
def roll(robots: RobotState, wheels: WheelState) -> None:
    """After a tick: advance wheels and odometry.

    While nothing holds a robot, its wheels turn as the motors aim; what an obstacle takes from the speed over ground,
    it takes from the wheels.
    """
    for wheel in range(wheels.count):
        rim = wheels.covered[wheel] - wheels.ground[wheel] + wheels.aimed[wheel]
        wheels.rim[wheel] = rim
        wheels.angle[wheel] = wheels.angle[wheel] + rim * (_TICK_S / _RADIUS_M)
        if wheels.is_controlled[wheel] == 0:
            report_ideal(wheels, wheel)
    for robot in range(robots.count):
        left = wheels.rim[2 * robot]
        right = wheels.rim[2 * robot + 1]
        if left == 0.0 and right == 0.0:
            continue
        distance = (left + right) / 2.0 * _TICK_S
        turn = (right - left) / _TRACK_M * _TICK_S
        heading = robots.odometry_yaw[robot] + turn / 2.0
        robots.odometry_x[robot] = robots.odometry_x[robot] + distance * cos(heading)
        robots.odometry_y[robot] = robots.odometry_y[robot] + distance * sin(heading)
        robots.odometry_yaw[robot] = robots.odometry_yaw[robot] + turn


class Wheels:
    """The wheels of one robot; speeds are in m/s at the rim, left then right."""

    __slots__ = ("_body",)

    def __init__(self, body: RobotBody) -> None:
        self._body = body

    @property
    def speeds_m_s(self) -> tuple[float, float]:
        """Speeds in the last tick."""
        rim, left = self._body.wheels.rim, 2 * self._body.index
        return rim[left], rim[left + 1]

    @property
    def wanted_m_s(self) -> tuple[float, float]:
        """Speeds that the motors aim at."""
        wanted, left = self._body.wheels.wanted, 2 * self._body.index
        return wanted[left], wanted[left + 1]

    @property
    def angles_rad(self) -> tuple[float, float]:
        """Angles by which they have turned."""
        angle, left = self._body.wheels.angle, 2 * self._body.index
        return angle[left], angle[left + 1]

    @property
    def odometry(self) -> Pose:
        """Pose by wheel odometry."""
        state, index = self._body.state, self._body.index
        return Pose(state.odometry_x[index], state.odometry_y[index], state.odometry_yaw[index])

    @property
    def twist(self) -> Twist:
        """The body's velocity by wheel odometry."""
        return twist_of(*self.speeds_m_s)

    def want(self, left_m_s: float, right_m_s: float) -> None:
        """Set the speeds that the motors aim at from now on."""
        wanted, left = self._body.wheels.wanted, 2 * self._body.index
        wanted[left], wanted[left + 1] = left_m_s, right_m_s

    def set_controlled(self, *, is_controlled: bool) -> None:
        """Drive the wheels by new control loops, or let them follow at once."""
        state, left = self._body.wheels, 2 * self._body.index
        for wheel in (left, left + 1):
            state.is_controlled[wheel] = int(is_controlled)
            state.output[wheel] = state.integral[wheel] = state.current[wheel] = 0.0
            state.zero_ticks[wheel] = state.high_ticks[wheel] = state.is_halved[wheel] = 0

    def set_odometry(self, pose: Pose) -> None:
        """Let the odometry go on from a pose."""
        state, index = self._body.state, self._body.index
        state.odometry_x[index], state.odometry_y[index], state.odometry_yaw[index] = pose.x_m, pose.y_m, pose.yaw_rad


def twist_of(left_m_s: float, right_m_s: float) -> Twist:
    """The velocity of a body whose wheels roll at these speeds (m/s)."""
    return Twist((left_m_s + right_m_s) / 2, (right_m_s - left_m_s) / WHEEL_TRACK_M)
