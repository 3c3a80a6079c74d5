"""Seven horizontal proximity sensors with rays over 30 degrees (docs/spec/thymio-robot.md section 7.1).

F is `units.proximity_response`; d are the distances of a sensor's rays, from right to left, and a the angles between
ray and axis. Noise is added, then the count is clamped. A wall across the axis gives F of its distance in every model.
Model "default": three rays, the largest F(d cos a), since the strongest echo dominates. Every term falls
with d, so the count of a flat wall falls with its distance at every angle; whatever is seen gives at least F of the
range, 1226, as a real sensor gives at least 1000.
Model "enki": three rays, F(left) + F(center) + F(right) - 2 F(center / cos 15°), the last term only when the center ray
hits; a thin post straight ahead is invisible. The subtracted term ends at 13.5 cm and the others at 14 cm, so the count
of a slanted wall jumps there.
Model "cone": nine rays, the mean of F(d cos a); it has no jumps, and an object that fills a part of the cone gives that
part of F.
An operator can override counts (`stimuli/sensor_override.py`).
`ranges_m` is the distance of a wall across the axis that would give the same count, as in the robot's ROS driver.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import reduce

import numpy as np

from thymio_sim_ros.sim.kernel.memory import is_available
from thymio_sim_ros.sim.model import robot_constants, units
from thymio_sim_ros.sim.model.readings import ProximityReading
from thymio_sim_ros.sim.model.robot_constants import (
    PROXIMITY_HEIGHT_M,
    PROXIMITY_NOISE,
    PROXIMITY_POSES,
    PROXIMITY_RANGE_M,
)
from thymio_sim_ros.sim.plugin_api.aseba_binding import AsebaFace
from thymio_sim_ros.sim.plugin_api.reading_table import LazyReadings
from thymio_sim_ros.sim.plugin_api.view import BatchSensorView, SensorView
from thymio_sim_ros.sim.raycast.batch import Fan, Values
from thymio_sim_ros.sim.sensors import Sensor
from thymio_sim_ros.sim.sensors._proximity_binding import ProximityCounts
from thymio_sim_ros.sim.sensors._proximity_kernel import COS_CONE
from thymio_sim_ros.sim.stimuli.sensor_override import SensorOverrideState, overridden

__all__ = ["SENSOR", "response", "responses"]

_COUNT = len(PROXIMITY_POSES)
_CONE_RAD = robot_constants.PROXIMITY_HALF_CONE_RAD
_RAYS = {"default": 3, "enki": 3, "cone": 9}
_ANGLES_RAD = {
    model: tuple(-_CONE_RAD + 2 * _CONE_RAD * ray / (count - 1) for ray in range(count))
    for model, count in _RAYS.items()
}
_COSINES = {model: tuple(map(math.cos, angles)) for model, angles in _ANGLES_RAD.items()}
_PLACES = tuple((x, y) for x, y, _ in PROXIMITY_POSES)
_DIRECTIONS = {
    model: tuple(
        tuple((math.cos(yaw + side), math.sin(yaw + side)) for side in angles) for _, _, yaw in PROXIMITY_POSES
    )
    for model, angles in _ANGLES_RAD.items()
}
"""For each sensor the unit directions of its rays in the robot's frame, right to left."""
_FANS = {
    model: Fan(_PLACES, directions, PROXIMITY_RANGE_M, PROXIMITY_HEIGHT_M) for model, directions in _DIRECTIONS.items()
}
_NOTHING = ((0,) * _COUNT, (math.inf,) * _COUNT)


def response(distances_m: Sequence[float], model: str) -> float:
    """Return the count without noise of one sensor.

    `distances_m` are those of its rays, from right to left, inf for a ray that meets nothing.
    """
    if model == "cone":
        # The distance along the axis is d cos a, the range limits d itself.
        straight = map(float.__mul__, distances_m, _COSINES[model])
        return math.fsum(map(_within_range, distances_m, straight)) / len(distances_m)
    right, center, left = distances_m
    if model == "default":
        # F falls with the distance, so the largest response is that of the smallest distance.
        return units.proximity_response(min(right * COS_CONE, center, left * COS_CONE))
    slanted = center / COS_CONE
    total = units.proximity_response(right) + units.proximity_response(center) + units.proximity_response(left)
    return total - 2.0 * units.proximity_response(slanted)


def responses(distances_m: Values, model: str) -> Values:
    """Return `response` of many sensors, shape (sensors,), for distances of shape (sensors, rays)."""
    if model == "cone":
        found = units.proximity_responses(distances_m * _COSINES[model])
        found[distances_m > PROXIMITY_RANGE_M] = 0.0
        mean: Values = reduce(np.add, found.T) / distances_m.shape[1]  # one after the other, as the kernel does
        return mean
    right, center, left = distances_m.T
    if model == "default":
        return units.proximity_responses(np.minimum(np.minimum(right * COS_CONE, center), left * COS_CONE))
    slanted = center / COS_CONE
    of = units.proximity_responses(np.stack((right, center, left, slanted)))
    total: Values = of[0] + of[1] + of[2] - 2.0 * of[3]
    return total


def _within_range(distance_m: float, straight_m: float) -> float:
    return 0.0 if distance_m > PROXIMITY_RANGE_M else units.proximity_response(straight_m)


def _measure(view: SensorView) -> ProximityReading:
    model = view.proximity_model
    around = view.surroundings(_FANS[model].reach_m, PROXIMITY_HEIGHT_M)
    override = view.state(SensorOverrideState).proximity
    if around.is_empty and not override:
        return ProximityReading(view.now_ns, *_NOTHING)
    pose, noise = view.pose, view.noise
    x, y, cos, sin = pose.x_m, pose.y_m, math.cos(pose.yaw_rad), math.sin(pose.yaw_rad)
    counts = []
    for (mount_x, mount_y), rays in zip(_PLACES, _DIRECTIONS[model], strict=True):
        origin_x, origin_y = x + cos * mount_x - sin * mount_y, y + sin * mount_x + cos * mount_y
        # Noise is drawn only for sensors that detect something, in their order; the batch does the same.
        near = around.near(origin_x, origin_y, PROXIMITY_RANGE_M)
        count = 0
        if not near.is_empty:
            directions = [(cos * dx - sin * dy, sin * dx + cos * dy) for dx, dy in rays]
            distances = near.fan(origin_x, origin_y, directions, PROXIMITY_RANGE_M)
            if min(distances) < math.inf:
                value = response(distances, model) + noise.gauss(PROXIMITY_NOISE)
                count = round(max(0.0, min(float(units.PROXIMITY_FULL), value)))
        counts.append(count)
    counts = overridden(counts, override)
    return ProximityReading(view.now_ns, tuple(counts), _ranges(counts))


def _ranges(counts: Sequence[int]) -> tuple[float, ...]:
    """Return the distances in m for counts; inf for 0."""
    return tuple([units.proximity_distance(count) if count else math.inf for count in counts])


def _measure_all(batch: BatchSensorView) -> LazyReadings:
    now_ns, model = batch.now_ns, batch.proximity_model
    sensors, distances = batch.cast(_FANS[model])
    noise = batch.noise.draw(sensors // _COUNT, PROXIMITY_NOISE)
    if is_available():
        kernel = batch.memory.get("counts")
        if kernel is None:
            kernel = batch.memory["counts"] = ProximityCounts(len(batch) * _COUNT, model, _COSINES[model])
        counts = kernel.count(sensors, distances, noise).reshape(-1, _COUNT)
    else:
        counts = np.zeros((len(batch), _COUNT), dtype=np.int32)
        values = responses(distances, model) + noise
        counts.ravel()[sensors] = np.rint(np.minimum(np.maximum(values, 0.0), units.PROXIMITY_FULL))
    overrides = [state.proximity for state in batch.states(SensorOverrideState)]

    def make(robot: int) -> ProximityReading:
        words = overridden(counts[robot].tolist(), overrides[robot])
        return ProximityReading(now_ns, tuple(words), _ranges(words))

    return LazyReadings(len(batch), make)


SENSOR = Sensor(
    name="proximity",
    period_ns=100_000_000,
    measure=_measure,
    measure_all=_measure_all,
    aseba=AsebaFace(variables=(("prox.horizontal", _COUNT),), event="prox"),
    values=(),
)
