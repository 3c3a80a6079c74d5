"""The accelerometer, 16 times a second the mean of the time since: proper acceleration.

Source: docs/spec/thymio-robot.md section 7.3.

At rest it is g upwards. For a robot whose left side is lifted by the roll r and whose front is lowered by the pitch p,
with g seen in its frame: forward -g sin p, left g sin r cos p, up g cos r cos p. To this comes what its motion
adds: forward dv / dt, left v * w (on a curve), and, when something hits it, the speed lost or won sidewards over dt.
In free fall it is nothing, and the landing adds, upwards, the speed of the fall over dt.
acc[0] is the part to the right, acc[1] forward, acc[2] upwards, 23 for each g, even noise of ±0.2 before rounding,
within ±32.
"""

from __future__ import annotations

import math

from thymio_sim_ros.sim.mechanics.fall import FALL_NS
from thymio_sim_ros.sim.model.geometry import LEVEL, Pose, Tilt
from thymio_sim_ros.sim.model.readings import AccelerometerReading
from thymio_sim_ros.sim.model.robot_constants import ACC_LIMIT, ACC_NOISE, ACC_PER_G, GRAVITY_M_S2
from thymio_sim_ros.sim.model.units import acceleration_to_units
from thymio_sim_ros.sim.physics import Contact
from thymio_sim_ros.sim.plugin_api.aseba_binding import AsebaFace
from thymio_sim_ros.sim.plugin_api.display import DisplayedValue
from thymio_sim_ros.sim.plugin_api.view import SensorView
from thymio_sim_ros.sim.sensors import Sensor

__all__ = ["SENSOR", "gravity"]

_PERIOD_NS = 62_500_000
_LANDING_M_S = GRAVITY_M_S2 * FALL_NS * 1e-9
_NOISE_M_S2 = ACC_NOISE * GRAVITY_M_S2 / ACC_PER_G


def gravity(tilt: Tilt) -> tuple[float, float, float]:
    """Return what a robot at rest at an angle measures in m/s²: forward, left, up."""
    if tilt == LEVEL:
        return (0.0, 0.0, GRAVITY_M_S2)
    level = GRAVITY_M_S2 * math.cos(tilt.pitch_rad)
    return (-GRAVITY_M_S2 * math.sin(tilt.pitch_rad), level * math.sin(tilt.roll_rad), level * math.cos(tilt.roll_rad))


def sideways(pose: Pose, contact: Contact) -> float:
    """Return the speed in m/s to the left that a robot gains when a contact begins, away from the point of contact."""
    dx, dy = pose.x_m - contact.x_m, pose.y_m - contact.y_m
    distance = math.hypot(dx, dy)
    if distance == 0.0:
        return 0.0
    return contact.speed_m_s * (dy * math.cos(pose.yaw_rad) - dx * math.sin(pose.yaw_rad)) / distance


def _feel(view: SensorView) -> None:
    hits = sum(sideways(view.pose, contact) for contact in view.contacts if contact.is_new)
    view.memory["hit_m_s"] = view.memory.get("hit_m_s", 0.0) + hits


def _measure(view: SensorView) -> AccelerometerReading:
    memory, twist, noise = view.memory, view.twist, view.noise
    dt_s = (view.now_ns - memory.get("since_ns", view.now_ns - _PERIOD_NS)) * 1e-9
    if view.is_falling:
        forward = left = up = 0.0
        memory["is_falling"] = True
    else:
        forward, left, up = gravity(view.tilt)
        forward += (twist.linear_m_s - memory.get("speed_m_s", 0.0)) / dt_s
        left += twist.linear_m_s * twist.angular_rad_s + memory.pop("hit_m_s", 0.0) / dt_s
        if memory.pop("is_falling", False) and view.is_fallen:
            up += _LANDING_M_S / dt_s
    memory["since_ns"], memory["speed_m_s"] = view.now_ns, twist.linear_m_s
    words = (
        acceleration_to_units(noise.uniform(-_NOISE_M_S2, _NOISE_M_S2) - left),
        acceleration_to_units(noise.uniform(-_NOISE_M_S2, _NOISE_M_S2) + forward),
        acceleration_to_units(noise.uniform(-_NOISE_M_S2, _NOISE_M_S2) + up),
    )
    return AccelerometerReading(view.now_ns, words)


SENSOR = Sensor(
    name="accelerometer",
    period_ns=_PERIOD_NS,
    measure=_measure,
    wakes_on=(Contact,),
    on_wake=_feel,
    aseba=AsebaFace(variables=(("acc", 3),), event="acc"),
    label="acceleration",
    values=tuple(
        DisplayedValue(axis, "m/s²", GRAVITY_M_S2 / ACC_PER_G, digits=1, full_scale=ACC_LIMIT) for axis in "xyz"
    ),
)
