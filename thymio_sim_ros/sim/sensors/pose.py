"""Where the robot is, at 20 Hz: by its wheels and in truth. Programs see nothing of it."""

from __future__ import annotations

from thymio_sim_ros.sim.readings import PoseReading
from thymio_sim_ros.sim.sensors import Sensor
from thymio_sim_ros.sim.view import SensorView

__all__ = ["SENSOR"]


def _measure(view: SensorView) -> PoseReading:
    wheels = view.wheels
    return PoseReading(view.now_ns, (), wheels.odometry, wheels.twist, view.pose, view.twist, view.tilt)


SENSOR = Sensor(name="pose", period_ns=50_000_000, measure=_measure)
