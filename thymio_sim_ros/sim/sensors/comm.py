"""The receiving half of infrared communication, ten frames a second (docs/spec/thymio-robot.md section 7.5), no noise.

A robot that is enabled sends from all seven proximity sensors at once. A sensor that sees some of another robot's
emitters measures the intensity m / (1 + 1 / S) of that robot, with m = 4600 and

    S = sum of w (c - x0²) / (d - x0)²        c = 917 cm², x0 = 0.2 cm, d the distance of an emitter
    w = cos(a)¹⁸ cos(b)⁹                      a off the emitter's axis, b off the receiver's, at most 0.644 rad

over its emitters within 0.48 m with nothing that is 34 mm high in between. From 1400 on (and up to 7000, which is never
reached) the value is understood; of several robots each sensor understands the one it sees best. The value of the
strongest sensor becomes prox.comm.rx; a sensor that understood nothing in a frame has payload and intensity 0. A frame
in which no sensor understood anything leaves everything as it was.

The drift of the robot's frames, which avoids collisions of two that send at once, is not needed and left out.
"""

from __future__ import annotations

import math

from thymio_sim_ros.sim.actuators.comm import CommState
from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.model.readings import CommReading
from thymio_sim_ros.sim.model.robot_constants import PROXIMITY_HEIGHT_M, PROXIMITY_POSES
from thymio_sim_ros.sim.plugin_api.aseba_binding import AsebaFace
from thymio_sim_ros.sim.plugin_api.view import SensorView
from thymio_sim_ros.sim.raycast.scalar import Surroundings
from thymio_sim_ros.sim.sensors import Sensor

__all__ = ["RANGE_M", "SENSOR", "intensity", "strength"]

RANGE_M = 0.48
_FULL = 4600.0
_LEAST = 1400.0
_C_M2 = 0.0917
_X0_M = 0.002
_SCALE_M2 = _C_M2 - _X0_M**2
_COS_VIEW = math.cos(0.644)
_EMITTER_POWER, _RECEIVER_POWER = 18, 9
_HULL_M = 0.01
"""The last stretch of a line of sight lies inside the hull of the robot that sends."""
_MOUNT_M = max(math.hypot(x, y) for x, y, _ in PROXIMITY_POSES)

_Mount = tuple[float, float, float, float]
"""Place and axis of a proximity sensor in the world's frame: x, y, and the unit vector of its heading."""


def strength(distance_m: float, cos_emitter: float, cos_receiver: float) -> float:
    """The part of S from one emitter, given the cosines of the angles off both axes; 0 if it is not visible."""
    if distance_m > RANGE_M or cos_emitter <= 0.0 or cos_receiver < _COS_VIEW:
        return 0.0
    weight = cos_emitter**_EMITTER_POWER * cos_receiver**_RECEIVER_POWER
    if distance_m <= _X0_M:
        return math.inf
    return float(weight * _SCALE_M2 / (distance_m - _X0_M) ** 2)


def intensity(total: float) -> float:
    """The intensity of a robot for the sum S of its emitters."""
    return _FULL / (1.0 + 1.0 / total) if total > 0.0 else 0.0


def _mounts(pose: Pose) -> list[_Mount]:
    """The proximity sensors of a robot at a pose."""
    return [
        (*pose.place((x, y)), math.cos(pose.yaw_rad + yaw), math.sin(pose.yaw_rad + yaw))
        for x, y, yaw in PROXIMITY_POSES
    ]


def _ahead(receiver: _Mount, emitters: list[_Mount]) -> list[tuple[float, float, float, float]]:
    """The emitters that a receiver detects if nothing is in between: part of S, direction, distance."""
    x, y, axis_x, axis_y = receiver
    visible = []
    for emitter_x, emitter_y, emitter_axis_x, emitter_axis_y in emitters:
        dx, dy = emitter_x - x, emitter_y - y
        distance = math.hypot(dx, dy)
        if not 0.0 < distance <= RANGE_M:
            continue
        dx, dy = dx / distance, dy / distance
        part = strength(distance, -dx * emitter_axis_x - dy * emitter_axis_y, dx * axis_x + dy * axis_y)
        if part > 0.0:
            visible.append((part, dx, dy, distance))
    return visible


def _received(receiver: _Mount, emitters: list[_Mount], around: Surroundings) -> float:
    """The intensity of the robot with these emitters at a receiver; 0 if it is too low to be understood."""
    ahead = _ahead(receiver, emitters)
    if intensity(sum(part for part, *_ in ahead)) < _LEAST:
        return 0.0
    x, y, *_ = receiver
    total = 0.0
    for part, dx, dy, distance in ahead:
        if around.fan(x, y, ((dx, dy),), max(0.0, distance - _HULL_M)) == (math.inf,):
            total += part
    total_intensity = intensity(total)
    return total_intensity if total_intensity >= _LEAST else 0.0


def _measure(view: SensorView) -> CommReading | None:
    if not view.state(CommState).is_enabled or not view.is_standing:
        return None
    x, y, reach_m = view.pose.x_m, view.pose.y_m, RANGE_M + 2 * _MOUNT_M
    senders = [
        (_mounts(other.pose), other.state(CommState).payload)
        for other in view.others
        if other.state(CommState).is_sending
        and other.is_standing
        and math.hypot(other.pose.x_m - x, other.pose.y_m - y) <= reach_m
    ]
    if not senders:
        return None
    around = view.surroundings(RANGE_M + _MOUNT_M, PROXIMITY_HEIGHT_M)
    payloads, intensities = [], []
    for receiver in _mounts(view.pose):
        received = [(_received(receiver, mounts, around), payload) for mounts, payload in senders]
        best, payload = max(received, key=lambda pair: pair[0])
        payloads.append(payload if best else 0)
        intensities.append(round(best))
    strongest = max(intensities)
    if strongest == 0:
        return None
    value = payloads[intensities.index(strongest)]
    return CommReading(view.now_ns, (value, *payloads, *intensities))


SENSOR = Sensor(
    name="comm",
    period_ns=100_000_000,
    measure=_measure,
    is_stateless=True,
    aseba=AsebaFace(
        variables=(("prox.comm.rx", 1), ("prox.comm.rx._payloads", 7), ("prox.comm.rx._intensities", 7)),
        event="prox.comm",
    ),
    values=(),
)
