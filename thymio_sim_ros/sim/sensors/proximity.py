"""Seven horizontal proximity sensors, three rays each (thymio-robot.md section 7.1).

A sensor's count is F(left) + F(centre) + F(right) - 2 F(centre / cos 15°), the last term only when the centre ray
hits; F is `units.proximity_response`. Then noise, then limits. For a wall across the axis that is F(d).
Model "default": a side ray that misses what the centre ray hits counts as centre / cos 15°, so that thin things
are seen. Model "enki": exactly the sum, with which a thin post straight ahead is invisible.
`ranges_m` is the distance of a wall across the axis that would give the same count, as the robot's driver has it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from thymio_sim_ros.sim import thymio2, units
from thymio_sim_ros.sim.aseba_face import AsebaFace
from thymio_sim_ros.sim.readings import ProximityReading
from thymio_sim_ros.sim.sensors import Sensor
from thymio_sim_ros.sim.thymio2 import (
    PROXIMITY_HEIGHT_M,
    PROXIMITY_NOISE,
    PROXIMITY_POSES,
    PROXIMITY_RANGE_M,
)
from thymio_sim_ros.sim.view import SensorView

__all__ = ["SENSOR", "response"]

_COUNT = len(PROXIMITY_POSES)
_REACH_M = PROXIMITY_RANGE_M + max(math.hypot(x, y) for x, y, _ in PROXIMITY_POSES)
_CONE_RAD = thymio2.PROXIMITY_HALF_CONE_RAD
_COS_CONE = math.cos(_CONE_RAD)
_MOUNTS = tuple(
    (x, y, tuple((math.cos(yaw + side), math.sin(yaw + side)) for side in (-_CONE_RAD, 0.0, _CONE_RAD)))
    for x, y, yaw in PROXIMITY_POSES
)
"""Each sensor in the robot's frame: position and the unit directions of its rays, right to left."""
_NOTHING = ((0,) * _COUNT, (math.inf,) * _COUNT)


def response(distances_m: Sequence[float], model: str) -> float:
    """Count without noise of one sensor whose rays (right, centre, left) met things this far away, inf for nothing."""
    right, centre, left = distances_m
    slanted = centre / _COS_CONE
    if model != "enki" and centre < math.inf:
        right, left = min(right, slanted) if right == math.inf else right, slanted if left == math.inf else left
    total = units.proximity_response(right) + units.proximity_response(centre) + units.proximity_response(left)
    return total - 2.0 * units.proximity_response(slanted)


def _measure(view: SensorView) -> ProximityReading:
    around = view.surroundings(_REACH_M, PROXIMITY_HEIGHT_M)
    if around.is_empty:
        return ProximityReading(view.now_ns, *_NOTHING)
    pose, noise, model = view.pose, view.noise, view.proximity_model
    x, y, cos, sin = pose.x_m, pose.y_m, math.cos(pose.yaw_rad), math.sin(pose.yaw_rad)
    counts, ranges = [], []
    for mount_x, mount_y, rays in _MOUNTS:
        origin_x, origin_y = x + cos * mount_x - sin * mount_y, y + sin * mount_x + cos * mount_y
        near = around.near(origin_x, origin_y, PROXIMITY_RANGE_M)
        count = 0
        if not near.is_empty:
            directions = [(cos * dx - sin * dy, sin * dx + cos * dy) for dx, dy in rays]
            distances = near.fan(origin_x, origin_y, directions, PROXIMITY_RANGE_M)
            if min(distances) < math.inf:
                value = response(distances, model) + noise.gauss(PROXIMITY_NOISE)
                count = round(max(0.0, min(float(units.PROXIMITY_FULL), value)))
        counts.append(count)
        ranges.append(units.proximity_distance(count) if count else math.inf)
    return ProximityReading(view.now_ns, tuple(counts), tuple(ranges))


SENSOR = Sensor(
    name="proximity",
    period_ns=100_000_000,
    measure=_measure,
    aseba=AsebaFace(variables=(("prox.horizontal", _COUNT),), event="prox"),
)
