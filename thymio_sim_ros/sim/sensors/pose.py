"""Where the robot is, at 20 Hz: by its wheels and in truth. Programs see nothing of it."""

from __future__ import annotations

from thymio_sim_ros.sim.mechanics.wheels import twist_of
from thymio_sim_ros.sim.model.geometry import Pose, Twist
from thymio_sim_ros.sim.model.readings import PoseReading
from thymio_sim_ros.sim.plugin_api.reading_table import Later
from thymio_sim_ros.sim.plugin_api.view import GroupView, SensorView
from thymio_sim_ros.sim.sensors import Sensor

__all__ = ["SENSOR"]


def _measure(view: SensorView) -> PoseReading:
    wheels = view.wheels
    return PoseReading(view.now_ns, (), wheels.odometry, wheels.twist, view.pose, view.twist, view.tilt)


def _measure_all(group: GroupView) -> Later:
    now_ns, wheels, tilts = group.now_ns, group.wheels, group.tilts
    odometry, speeds = wheels.odometry.T.tolist(), wheels.speeds.T.tolist()
    poses, (linear, angular) = group.poses.tolist(), (values.tolist() for values in group.motion)

    def make(robot: int) -> PoseReading:
        moving, truth = Twist(linear[robot], angular[robot]), Pose(*poses[robot])
        return PoseReading(now_ns, (), Pose(*odometry[robot]), twist_of(*speeds[robot]), truth, moving, tilts[robot])

    return Later(len(group), make)


SENSOR = Sensor(name="pose", period_ns=50_000_000, measure=_measure, measure_all=_measure_all)
