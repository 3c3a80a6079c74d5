"""The lidar of a world that has one: the distance of what its beams meet, all around (`sim/model/lidar.py`).

A beam ends at the first thing that is at least as high as the beams, other robots included; the robot's own hull is not
seen. Normal noise is added to a distance, which then stays within the limits of the scanner. A robot that has fallen or
is lifted sees nothing.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from aseba_vm.kernel.types import Floats, Ints, kernel
from thymio_sim_ros.sim.model.lidar import LIDAR, LIDAR_HEIGHT_M, LIDAR_MIN_M, LIDAR_PLACE, Lidar
from thymio_sim_ros.sim.model.noise import NoiseKeys, normal
from thymio_sim_ros.sim.model.readings import LidarReading
from thymio_sim_ros.sim.plugin_api.reading_table import LazyReadings
from thymio_sim_ros.sim.plugin_api.view import BatchSensorView
from thymio_sim_ros.sim.raycast.raycaster import Fan
from thymio_sim_ros.sim.sensors import Sensor

__all__ = ["SENSOR", "add_noise"]

_FAR = math.inf
_MOST_SECTORS = 24


@kernel
def add_noise(distances: Floats, beams: int, range_m: float, noise_m: float, keys: NoiseKeys, tick: Ints) -> None:
    """Add noise to the distances of all beams, shape (robots, beams), m; inf stays."""
    for robot in range(keys.count):
        scale = noise_m if keys.is_on[robot] == 1 else 0.0
        for beam in range(beams):
            number = robot * beams + beam
            if distances[number] < _FAR:
                value = distances[number]
                if scale > 0.0:
                    value += scale * normal(keys.key_1[robot], keys.key_2[robot], tick[0], beam)
                distances[number] = min(max(value, LIDAR_MIN_M), range_m)


def _fan(lidar: Lidar) -> Fan:
    """The beams as sectors of equally many, so that the ray caster skips what is not in front of a sector."""
    sectors = max(number for number in range(1, _MOST_SECTORS + 1) if lidar.beams % number == 0)
    beams = lidar.beams // sectors
    angles = [[(sector * beams + beam) * lidar.step_rad for beam in range(beams)] for sector in range(sectors)]
    directions = [[(math.cos(angle), math.sin(angle)) for angle in sector] for sector in angles]
    return Fan([LIDAR_PLACE] * sectors, directions, lidar.range_m, LIDAR_HEIGHT_M)


def _prepare(batch: BatchSensorView) -> Callable[[], LazyReadings]:
    lidar = batch.lidar
    assert lidar is not None  # else the sensor is not in the world
    cast, distances = batch.bind_rays(_fan(lidar))
    disturb = batch.bind(add_noise, distances, lidar.beams, lidar.range_m, lidar.noise_m, batch.noise_keys, batch.tick)
    rows = distances.reshape(len(batch), lidar.beams)

    def measure() -> LazyReadings:
        cast()
        disturb()
        now_ns, ranges = batch.now_ns, rows.copy()
        return LazyReadings(len(batch), lambda robot: LidarReading(now_ns, (), tuple(ranges[robot].tolist()), lidar))

    return measure


SENSOR = Sensor(
    name=LIDAR, period_ns=Lidar().period_ns, prepare_all=_prepare, is_stateless=True, is_add_on=True, values=()
)
