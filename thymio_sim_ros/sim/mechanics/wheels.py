"""The wheels of robots: target speeds, angles, and the odometry computed from them."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from thymio_sim_ros.sim.kernel.memory import is_available
from thymio_sim_ros.sim.kernel.wheel_odometry_binding import WheelOdometryBinding
from thymio_sim_ros.sim.mechanics.motor_control import WheelControl
from thymio_sim_ros.sim.model.geometry import Pose, Twist
from thymio_sim_ros.sim.model.robot_constants import WHEEL_RADIUS_M, WHEEL_TRACK_M

__all__ = ["WheelArrays", "Wheels", "twist_of"]

Values = npt.NDArray[np.float64]


class Wheels:
    """Speeds in m/s at the rim, left then right.

    `commanded` is what the motors aim at, `ground` what reaches the floor after slip. While nothing holds the robot,
    the wheels turn as commanded; what an obstacle takes from the ground speed, it takes from the wheels. `control` are
    the loops that the motors follow, if they do not follow at once.
    """

    __slots__ = ("angles_rad", "commanded", "control", "ground", "place", "speeds_m_s")

    def __init__(self) -> None:
        self.commanded = (0.0, 0.0)
        self.control: tuple[WheelControl, WheelControl] | None = None
        self.ground = (0.0, 0.0)
        self.speeds_m_s = (0.0, 0.0)
        self.angles_rad = (0.0, 0.0)
        self.place = (0.0, 0.0, 0.0)
        """The odometry's x, y and yaw."""

    @property
    def odometry(self) -> Pose:
        """Pose by wheel odometry."""
        return Pose(*self.place)

    @property
    def twist(self) -> Twist:
        """The body's velocity by wheel odometry."""
        return twist_of(*self.speeds_m_s)

    def drive(self, commanded: tuple[float, float], slip: tuple[float, float], limit_m_s: float) -> None:
        """Set target speeds; the speeds over ground are these times slip, both clamped to the limit."""
        left, right = commanded
        ground = (left * slip[0], right * slip[1])
        if not (
            -limit_m_s <= left <= limit_m_s and -limit_m_s <= right <= limit_m_s
            and -limit_m_s <= ground[0] <= limit_m_s and -limit_m_s <= ground[1] <= limit_m_s
        ):  # fmt: skip
            commanded = (_limited(left, limit_m_s), _limited(right, limit_m_s))
            ground = (_limited(ground[0], limit_m_s), _limited(ground[1], limit_m_s))
        self.commanded, self.ground = commanded, ground

    def roll(self, covered_m_s: tuple[float, float], dt_s: float) -> None:
        """Advance angles and odometry by a tick, given the mean speed over ground at each wheel."""
        # The rim turns as commanded, less what an obstacle took from the ground speed. The equal case is separate so
        # that undisturbed wheels have exactly the commanded speed.
        if covered_m_s == self.ground:
            self.speeds_m_s = self.commanded
        else:
            self.speeds_m_s = (
                self.commanded[0] + (covered_m_s[0] - self.ground[0]),
                self.commanded[1] + (covered_m_s[1] - self.ground[1]),
            )
        left, right = self.speeds_m_s
        if left == 0.0 and right == 0.0:
            return
        # Midpoint rule: the displacement lies along the mean heading of the tick.
        distance, turn = (left + right) / 2 * dt_s, (right - left) / WHEEL_TRACK_M * dt_s
        x_m, y_m, yaw_rad = self.place
        heading = yaw_rad + turn / 2
        self.place = (x_m + distance * math.cos(heading), y_m + distance * math.sin(heading), yaw_rad + turn)
        angle_left, angle_right = self.angles_rad
        per_m = dt_s / WHEEL_RADIUS_M
        self.angles_rad = (angle_left + left * per_m, angle_right + right * per_m)

    def reset_odometry(self) -> None:
        """Set the odometry to zero."""
        self.place = (0.0, 0.0, 0.0)


def twist_of(left_m_s: float, right_m_s: float) -> Twist:
    """Return the velocity of a body whose wheels roll at these speeds (m/s)."""
    return Twist((left_m_s + right_m_s) / 2, (right_m_s - left_m_s) / WHEEL_TRACK_M)


def _limited(speed_m_s: float, limit_m_s: float) -> float:
    return max(-limit_m_s, min(limit_m_s, speed_m_s))


class WheelArrays:
    """The wheels of a batch: the computations of `Wheels` on arrays of shape (2, robots), left first.

    The arrays are authoritative. After `write_back`, and until the next `drive` or `roll`, each `Wheels` may be read
    and changed.
    """

    def __init__(self, wheels: Sequence[Wheels], *, is_compiled: bool | None = None) -> None:
        """`is_compiled`: use kernels, or numpy; None: kernels if available. The results are the same."""
        self._wheels = tuple(wheels)
        self._is_compiled = is_available() if is_compiled is None else is_compiled
        self._odometry_binding: WheelOdometryBinding | None = None
        self.is_written_back = True
        """Whether the `Wheels` are authoritative until the next `load`."""
        self._given: Values | None = None
        """The array that was commanded last, not clamped; `_allowed` is the same clamped."""
        self._allowed: Values = np.zeros((2, 0))
        self.load()

    @property
    def ground(self) -> Values:
        """Speeds that reach the floor in m/s, shape (2, robots)."""
        self.load()
        return self._ground

    @property
    def speeds(self) -> Values:
        """Speeds at the rim in m/s, shape (2, robots)."""
        self.load()
        return self._speeds

    @property
    def commanded(self) -> Values:
        """Target speeds of the motors in m/s, shape (2, robots)."""
        self.load()
        return self._commanded

    @property
    def angles(self) -> Values:
        """Angles of the wheels in rad, shape (2, robots)."""
        self.load()
        return self._angles

    @property
    def odometry(self) -> Values:
        """Poses by wheel odometry, shape (3, robots): x, y in m, yaw in rad."""
        self.load()
        return self._odometry

    @property
    def controls(self) -> dict[int, tuple[WheelControl, WheelControl]]:
        """Control loops of the motors by robot number; motors that follow at once have none."""
        return {number: wheels.control for number, wheels in enumerate(self._wheels) if wheels.control is not None}

    def set_control(self, number: int, control: tuple[WheelControl, WheelControl] | None) -> None:
        """Set the control loops of one robot's motors; None: they follow at once."""
        self._wheels[number].control = control

    def write_back(self) -> None:
        """Write the arrays back to the `Wheels`."""
        if self.is_written_back:
            return
        self.is_written_back = True
        columns = (self._commanded, self._ground, self._speeds, self._angles)
        pairs = zip(*(zip(*values.tolist(), strict=True) for values in columns), strict=True)
        for wheels, values, place in zip(self._wheels, pairs, zip(*self._odometry.tolist(), strict=True), strict=True):
            wheels.commanded, wheels.ground, wheels.speeds_m_s, wheels.angles_rad = values
            wheels.place = place

    def load(self) -> None:
        """Read the `Wheels` into the arrays, if they may have been changed."""
        if not self.is_written_back:
            return
        self.is_written_back = False
        self._commanded = _rows([wheels.commanded for wheels in self._wheels], 2)
        self._ground = _rows([wheels.ground for wheels in self._wheels], 2)
        self._speeds = _rows([wheels.speeds_m_s for wheels in self._wheels], 2)
        self._angles = _rows([wheels.angles_rad for wheels in self._wheels], 2)
        self._odometry = _rows([wheels.place for wheels in self._wheels], 3)
        if self._odometry_binding is not None:
            self._odometry_binding.odometry[:], self._odometry_binding.angles[:] = self._odometry, self._angles

    def drive(self, commanded: Values, slip: Values, limit_m_s: float) -> None:
        """Set target speeds, shape (2, robots); `commanded` must not be modified afterwards.

        The speeds over ground are these times `slip`; both are clamped to the limit.
        """
        self.load()
        # Commands change seldom, so the same array is clamped only once.
        if commanded is not self._given:
            self._given = commanded
            self._allowed = np.maximum(-limit_m_s, np.minimum(limit_m_s, commanded))
        self._commanded = self._allowed
        self._ground = ground = commanded * slip
        np.minimum(ground, limit_m_s, out=ground)
        np.maximum(ground, -limit_m_s, out=ground)

    def roll(self, covered_m_s: Values, dt_s: float) -> None:
        """Advance angles and odometry by a tick; `covered_m_s` has shape (2, robots)."""
        self.load()
        if self._is_compiled:
            self._roll_compiled(covered_m_s, dt_s)
            return
        self._speeds = speeds = covered_m_s - self._ground
        speeds += self._commanded
        left, right = speeds
        distance, turn = left + right, right - left
        distance *= dt_s / 2
        turn /= WHEEL_TRACK_M
        turn *= dt_s
        before, self._odometry = self._odometry, np.empty_like(self._odometry)
        heading = turn / 2
        heading += before[2]
        place = self._odometry[:2]
        np.cos(heading, out=place[0])
        np.sin(heading, out=place[1])
        place *= distance
        place += before[:2]
        np.add(before[2], turn, out=self._odometry[2])
        self._angles = self._angles + speeds * (dt_s / WHEEL_RADIUS_M)

    def _roll_compiled(self, covered_m_s: Values, dt_s: float) -> None:
        binding = self._odometry_binding
        if binding is None or binding.dt_s != dt_s:
            binding = self._odometry_binding = WheelOdometryBinding(
                len(self._wheels), dt_s, WHEEL_TRACK_M, WHEEL_RADIUS_M
            )
            binding.odometry[:], binding.angles[:] = self._odometry, self._angles
        self._speeds, self._odometry, self._angles = binding.roll(covered_m_s, self._ground, self._commanded)


def _rows(values: Sequence[Sequence[float]], width: int) -> Values:
    return np.ascontiguousarray(np.array(values, dtype=float).reshape(-1, width).T)
