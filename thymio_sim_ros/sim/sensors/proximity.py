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
from collections.abc import Callable

from aseba_vm.kernel.types import Floats, Ints, kernel
from thymio_sim_ros.sim.model import robot_constants, units
from thymio_sim_ros.sim.model.noise import NoiseKeys, normal
from thymio_sim_ros.sim.model.readings import ProximityReading
from thymio_sim_ros.sim.model.robot_constants import (
    PROXIMITY_HEIGHT_M,
    PROXIMITY_NOISE,
    PROXIMITY_POSES,
    PROXIMITY_RANGE_M,
)
from thymio_sim_ros.sim.model.units import PROXIMITY_FULL, proximity_response
from thymio_sim_ros.sim.plugin_api.aseba_binding import AsebaFace
from thymio_sim_ros.sim.plugin_api.reading_table import LazyReadings
from thymio_sim_ros.sim.plugin_api.view import BatchSensorView
from thymio_sim_ros.sim.raycast.raycaster import Fan
from thymio_sim_ros.sim.sensors import Sensor
from thymio_sim_ros.sim.stimuli.sensor_override import SensorOverrideState, overridden

__all__ = ["SENSOR", "count_all", "response"]

_DEFAULT, _CONE = map(robot_constants.PROXIMITY_MODELS.index, ("default", "cone"))
_SENSORS = len(PROXIMITY_POSES)
_FAR = math.inf
_RAYS = {"default": 3, "enki": 3, "cone": 9}
_HALF_CONE_RAD = robot_constants.PROXIMITY_HALF_CONE_RAD
_COS_CONE = math.cos(_HALF_CONE_RAD)
_DISTANCES_M = (math.inf, *map(units.proximity_distance, range(1, PROXIMITY_FULL + 1)))
"""The distance of a wall across the axis, by count."""
_ANGLES_RAD = {
    model: tuple(-_HALF_CONE_RAD + 2 * _HALF_CONE_RAD * ray / (count - 1) for ray in range(count))
    for model, count in _RAYS.items()
}
"""Angles between the rays of a sensor and its axis, right to left, by model."""
_FANS = {
    model: Fan(
        [(x, y) for x, y, _ in PROXIMITY_POSES],
        [[(math.cos(yaw + side), math.sin(yaw + side)) for side in angles] for _, _, yaw in PROXIMITY_POSES],
        PROXIMITY_RANGE_M,
        PROXIMITY_HEIGHT_M,
    )
    for model, angles in _ANGLES_RAD.items()
}


@kernel
def response(distances: Floats, first: int, last: int, cosines: Floats, model: int) -> float:
    """The count without noise of one sensor, of whose rays `first` to `last - 1` at least one meets something.

    Args:
        distances: lengths of rays in m, those of a sensor from right to left, inf for a ray that meets nothing.
        first: index of its first ray.
        last: index behind its last ray.
        cosines: of the angles between its rays and its axis.
        model: index in `PROXIMITY_MODELS`.
    """
    if model == _CONE:
        total = 0.0
        for ray in range(first, last):
            if distances[ray] <= PROXIMITY_RANGE_M:  # the distance along the axis is d cos a, the range limits d itself
                total += proximity_response(distances[ray] * cosines[ray - first])
        return total / (last - first)
    right = distances[first]
    center = distances[first + 1]
    left = distances[first + 2]
    if model == _DEFAULT:
        # F falls with the distance, so the largest response is that of the smallest distance.
        return proximity_response(min(min(right * _COS_CONE, center), left * _COS_CONE))
    total = proximity_response(right) + proximity_response(center) + proximity_response(left)
    return total - 2.0 * proximity_response(center / _COS_CONE)


@kernel
def count_all(
    distances: Floats, rays: int, cosines: Floats, model: int, keys: NoiseKeys, tick: Ints, counts: Ints
) -> None:
    """Write the counts of all sensors to `counts`, shape (robots, sensors).

    Args:
        distances: lengths of the rays, shape (robots, sensors, rays), see `response`.
        rays: number of rays of a sensor.
        cosines: of the angles between the rays and the axis of a sensor.
        model: index in `PROXIMITY_MODELS`.
        keys: those of the noise of each robot.
        tick: one element, the number of the tick.
        counts: result.
    """
    for robot in range(keys.count):
        for sensor in range(_SENSORS):
            number = robot * _SENSORS + sensor
            first = number * rays
            nearest = _FAR
            for ray in range(first, first + rays):
                nearest = min(nearest, distances[ray])
            value = 0.0
            if nearest < _FAR:
                value = response(distances, first, first + rays, cosines, model)
                if keys.is_on[robot] == 1:
                    value += PROXIMITY_NOISE * normal(keys.key_1[robot], keys.key_2[robot], tick[0], sensor)
            counts[number] = round(min(max(value, 0.0), PROXIMITY_FULL))


def _prepare(batch: BatchSensorView) -> Callable[[], LazyReadings]:
    model = batch.proximity_model
    cast, distances = batch.bind_rays(_FANS[model])
    cosines = batch.array(len(_ANGLES_RAD[model]), "float64")
    cosines[:] = [math.cos(angle) for angle in _ANGLES_RAD[model]]
    counts = batch.array((len(batch), _SENSORS), "int32")
    number = robot_constants.PROXIMITY_MODELS.index(model)
    count = batch.bind(count_all, distances, _RAYS[model], cosines, number, batch.noise_keys, batch.tick, counts)
    overrides = batch.states(SensorOverrideState)

    def measure() -> LazyReadings:
        cast()
        count()
        now_ns, count_lists, chosen = batch.now_ns, counts.tolist(), [override.proximity for override in overrides]

        def make(robot: int) -> ProximityReading:
            words = tuple(overridden(count_lists[robot], chosen[robot]))
            return ProximityReading(now_ns, words, tuple([_DISTANCES_M[word] for word in words]))

        return LazyReadings(len(batch), make)

    return measure


SENSOR = Sensor(
    name="proximity",
    period_ns=100_000_000,
    prepare_all=_prepare,
    is_stateless=True,
    aseba=AsebaFace(variables=(("prox.horizontal", _SENSORS),), event="prox"),
    values=(),
)
