"""Pose and velocity of the robot at 20 Hz, by odometry and true. Aseba programs do not see it."""

from __future__ import annotations

from thymio_sim_ros.sim.mechanics.wheels import twist_of
from thymio_sim_ros.sim.model.geometry import Pose, Twist
from thymio_sim_ros.sim.model.readings import PoseReading
from thymio_sim_ros.sim.plugin_api.reading_table import LazyReadings
from thymio_sim_ros.sim.plugin_api.view import BatchSensorView, SensorView
from thymio_sim_ros.sim.sensors import Sensor

__all__ = ["SENSOR"]


def _measure(view: SensorView) -> PoseReading:
    wheels = view.wheels
    return PoseReading(view.now_ns, (), wheels.odometry, wheels.twist, view.pose, view.twist, view.tilt)


def _measure_all(batch: BatchSensorView) -> LazyReadings:
    now_ns, wheels, tilts = batch.now_ns, batch.wheels, batch.tilts
    odometry, speeds = wheels.odometry.T.tolist(), wheels.speeds.T.tolist()
    poses, (linear, angular) = batch.poses.tolist(), (values.tolist() for values in batch.motion)

    def make(robot: int) -> PoseReading:
        moving, truth = Twist(linear[robot], angular[robot]), Pose(*poses[robot])
        return PoseReading(now_ns, (), Pose(*odometry[robot]), twist_of(*speeds[robot]), truth, moving, tilts[robot])

    return LazyReadings(len(batch), make)


SENSOR = Sensor(name="pose", period_ns=50_000_000, measure=_measure, measure_all=_measure_all)
