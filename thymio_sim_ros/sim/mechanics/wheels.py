"""The wheels of robots: target speeds, angles, and the odometry computed from them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from aseba_vm.kernel.types import kernel
from thymio_sim_ros.sim.mechanics.motor_control import WheelControl
from thymio_sim_ros.sim.model.clock import TICK_NS
from thymio_sim_ros.sim.model.geometry import Pose, Twist
from thymio_sim_ros.sim.model.robot_constants import WHEEL_RADIUS_M, WHEEL_TRACK_M
from thymio_sim_ros.sim.physics.robot_body import RobotBody
from thymio_sim_ros.sim.physics.robot_state import RobotState
from thymio_sim_ros.sim.physics.trigonometry import cos, sin

__all__ = ["WheelArrays", "Wheels", "roll", "twist_of"]

Values = npt.NDArray[np.float64]

_TICK_S = TICK_NS * 1e-9
_TRACK_M = WHEEL_TRACK_M
_RADIUS_M = WHEEL_RADIUS_M


@kernel
def roll(robots: RobotState) -> None:
    """Advance wheels and odometry by a tick.

    While nothing holds a robot, its wheels turn as the motors aim; what an obstacle takes from the speed over ground,
    it takes from the wheels.
    """
    for robot in range(robots.count):
        left = robots.covered_left[robot] - robots.ground_left[robot] + robots.aimed_left[robot]
        right = robots.covered_right[robot] - robots.ground_right[robot] + robots.aimed_right[robot]
        robots.rim_left[robot] = left
        robots.rim_right[robot] = right
        if left == 0.0 and right == 0.0:
            continue
        distance = (left + right) / 2.0 * _TICK_S
        turn = (right - left) / _TRACK_M * _TICK_S
        heading = robots.odometry_yaw[robot] + turn / 2.0
        robots.odometry_x[robot] = robots.odometry_x[robot] + distance * cos(heading)
        robots.odometry_y[robot] = robots.odometry_y[robot] + distance * sin(heading)
        robots.odometry_yaw[robot] = robots.odometry_yaw[robot] + turn
        robots.angle_left[robot] = robots.angle_left[robot] + left * (_TICK_S / _RADIUS_M)
        robots.angle_right[robot] = robots.angle_right[robot] + right * (_TICK_S / _RADIUS_M)


class Wheels:
    """The wheels of one robot; speeds are in m/s at the rim, left then right.

    `control` are the loops that the motors follow, if they do not follow at once.
    """

    __slots__ = ("_body", "control")

    def __init__(self, body: RobotBody) -> None:
        self._body = body
        self.control: tuple[WheelControl, WheelControl] | None = None

    @property
    def commanded(self) -> tuple[float, float]:
        """Speeds that the motors aim at."""
        state, index = self._body.state, self._body.index
        return state.aimed_left[index], state.aimed_right[index]

    @property
    def ground(self) -> tuple[float, float]:
        """Speeds that reach the floor after slip."""
        state, index = self._body.state, self._body.index
        return state.ground_left[index], state.ground_right[index]

    @property
    def speeds_m_s(self) -> tuple[float, float]:
        """Speeds in the last tick."""
        state, index = self._body.state, self._body.index
        return state.rim_left[index], state.rim_right[index]

    @property
    def angles_rad(self) -> tuple[float, float]:
        """Angles by which they have turned."""
        state, index = self._body.state, self._body.index
        return state.angle_left[index], state.angle_right[index]

    @property
    def odometry(self) -> Pose:
        """Pose by wheel odometry."""
        state, index = self._body.state, self._body.index
        return Pose(state.odometry_x[index], state.odometry_y[index], state.odometry_yaw[index])

    @property
    def twist(self) -> Twist:
        """The body's velocity by wheel odometry."""
        return twist_of(*self.speeds_m_s)

    def drive(self, commanded: tuple[float, float], slip: tuple[float, float], limit_m_s: float) -> None:
        """Set target speeds; the speeds over ground are these times slip, both clamped to the limit."""
        state, index = self._body.state, self._body.index
        left, right = commanded
        state.aimed_left[index], state.aimed_right[index] = _limited(left, limit_m_s), _limited(right, limit_m_s)
        state.ground_left[index] = _limited(left * slip[0], limit_m_s)
        state.ground_right[index] = _limited(right * slip[1], limit_m_s)

    def reset_odometry(self) -> None:
        """Set the odometry to zero."""
        state, index = self._body.state, self._body.index
        state.odometry_x[index] = state.odometry_y[index] = state.odometry_yaw[index] = 0.0


def twist_of(left_m_s: float, right_m_s: float) -> Twist:
    """Return the velocity of a body whose wheels roll at these speeds (m/s)."""
    return Twist((left_m_s + right_m_s) / 2, (right_m_s - left_m_s) / WHEEL_TRACK_M)


def _limited(speed_m_s: float, limit_m_s: float) -> float:
    return -limit_m_s if speed_m_s < -limit_m_s else limit_m_s if speed_m_s > limit_m_s else speed_m_s


class WheelArrays:
    """The wheels of all robots, as arrays of shape (2, robots), left first."""

    def __init__(self, state: RobotState, wheels: Sequence[Wheels]) -> None:
        self._state, self._wheels, self._count = state, tuple(wheels), len(wheels)

    def _rows(self, *arrays: Values) -> Values:
        return np.array([array[: self._count] for array in arrays])

    @property
    def speeds(self) -> Values:
        """Speeds at the rim in the last tick, m/s."""
        return self._rows(self._state.rim_left, self._state.rim_right)

    @property
    def commanded(self) -> Values:
        """Speeds that the motors aim at, m/s."""
        return self._rows(self._state.aimed_left, self._state.aimed_right)

    @property
    def angles(self) -> Values:
        """Angles by which they have turned, rad."""
        return self._rows(self._state.angle_left, self._state.angle_right)

    @property
    def odometry(self) -> Values:
        """Poses by wheel odometry: rows x, y in m, yaw in rad."""
        return self._rows(self._state.odometry_x, self._state.odometry_y, self._state.odometry_yaw)

    @property
    def controls(self) -> dict[int, tuple[WheelControl, WheelControl]]:
        """The loops that motors follow, by robot; motors that follow at once have none."""
        return {number: wheels.control for number, wheels in enumerate(self._wheels) if wheels.control is not None}

    def set_control(self, number: int, control: tuple[WheelControl, WheelControl] | None) -> None:
        """Set the loops that one robot's motors follow."""
        self._wheels[number].control = control

    def drive(self, commanded: Values, slip: Values, limit_m_s: float) -> None:
        """Set target speeds, shape (2, robots); see `Wheels.drive`."""
        state, count = self._state, self._count
        ground = np.minimum(np.maximum(commanded * slip, -limit_m_s), limit_m_s)
        aimed = np.minimum(np.maximum(commanded, -limit_m_s), limit_m_s)
        state.aimed_left[:count], state.aimed_right[:count] = aimed
        state.ground_left[:count], state.ground_right[:count] = ground
