"""Pose and velocity of the robot at 20 Hz, by odometry and true. Aseba programs do not see it."""

from __future__ import annotations

from collections.abc import Callable

from thymio_sim_ros.sim.mechanics.wheels import twist_of
from thymio_sim_ros.sim.model.geometry import Pose, Twist
from thymio_sim_ros.sim.model.readings import PoseReading
from thymio_sim_ros.sim.plugin_api.reading_table import LazyReadings
from thymio_sim_ros.sim.plugin_api.view import BatchSensorView
from thymio_sim_ros.sim.sensors import Sensor

__all__ = ["SENSOR"]


def _prepare(batch: BatchSensorView) -> Callable[[], LazyReadings]:
    state, rim = batch.robots, batch.wheels.rim
    columns = (
        state.x, state.y, state.yaw, state.odometry_x, state.odometry_y, state.odometry_yaw, state.speed,
        state.turn_rate,
    )  # fmt: skip

    def measure() -> LazyReadings:
        now_ns, tilts, heights_m, speeds = batch.now_ns, batch.tilts, batch.heights_m, rim.tolist()
        x, y, yaw, odometry_x, odometry_y, odometry_yaw, speed, turn_rate = [column.tolist() for column in columns]

        def make(robot: int) -> PoseReading:
            return PoseReading(
                now_ns,
                (),
                Pose(odometry_x[robot], odometry_y[robot], odometry_yaw[robot]),
                twist_of(speeds[2 * robot], speeds[2 * robot + 1]),
                Pose(x[robot], y[robot], yaw[robot]),
                Twist(speed[robot], turn_rate[robot]),
                tilts[robot],
                heights_m[robot],
            )

        return LazyReadings(len(batch), make)

    return measure


SENSOR = Sensor(name="pose", period_ns=50_000_000, prepare_all=_prepare, is_stateless=True)
