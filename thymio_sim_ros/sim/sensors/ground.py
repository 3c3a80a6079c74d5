"""Two ground sensors (docs/spec/thymio-robot.md section 7.2).

Over floor the count is 60 + 884 / (1 + exp(-9 (g - 0.44))), g being the gray of the footprint, plus noise; it fades
to 0 as the footprint leaves the floor. Ambient is the operator's light, 0 at first; reflected is the count with that
added, at most 1023; delta is reflected less ambient. An operator can override counts
(`stimuli/sensor_override.py`).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from aseba_vm.kernel.types import Floats, Ints, kernel
from thymio_sim_ros.sim.ground.footprint import Spots
from thymio_sim_ros.sim.kernel.elementary import cos, sin
from thymio_sim_ros.sim.model import units
from thymio_sim_ros.sim.model.noise import NoiseKeys, normal
from thymio_sim_ros.sim.model.readings import GroundReading
from thymio_sim_ros.sim.model.robot_constants import GROUND_NOISE, GROUND_SENSORS
from thymio_sim_ros.sim.model.robot_state import RobotState
from thymio_sim_ros.sim.model.units import GROUND_FULL, ground_response
from thymio_sim_ros.sim.plugin_api.aseba_binding import AsebaFace
from thymio_sim_ros.sim.plugin_api.reading_table import LazyReadings
from thymio_sim_ros.sim.plugin_api.view import BatchSensorView
from thymio_sim_ros.sim.sensors import Sensor
from thymio_sim_ros.sim.stimuli.environment import EnvironmentState
from thymio_sim_ros.sim.stimuli.sensor_override import SensorOverrideState, overridden

__all__ = ["SENSOR", "count_all", "place_all", "response"]

_SENSORS = len(GROUND_SENSORS)
_NOWHERE_M = -1e6
"""A coordinate without floor."""


@kernel
def place_all(robots: RobotState, offset_x: Floats, offset_y: Floats, spots: Spots) -> None:
    """Write the positions of all footprints: spot `2 r + s` is that of sensor s of robot r.

    The offsets are the positions of the sensors in the robot's frame, m.
    """
    for spot in range(spots.count):
        robot = spot >> 1
        if robots.is_standing[robot] == 0:
            spots.x[spot] = _NOWHERE_M
            spots.y[spot] = _NOWHERE_M
            continue
        c = cos(robots.yaw[robot])
        s = sin(robots.yaw[robot])
        dx = offset_x[spot & 1]
        dy = offset_y[spot & 1]
        spots.x[spot] = robots.x[robot] + c * dx - s * dy
        spots.y[spot] = robots.y[robot] + s * dx + c * dy


@kernel
def response(reflectance: float, floor: float) -> float:
    """The count without noise for a `GroundSample`."""
    return floor * ground_response(reflectance)


@kernel
def count_all(spots: Spots, keys: NoiseKeys, tick: Ints, counts: Ints) -> None:
    """Write the counts of all footprints; `tick[0]` is the number of the tick, `keys` are those of the noise."""
    for spot in range(spots.count):
        robot = spot >> 1
        value = 0.0
        if spots.floor[spot] > 0.0:
            value = response(spots.reflectance[spot], spots.floor[spot])
            if keys.is_on[robot] == 1:
                value += GROUND_NOISE * normal(keys.key_1[robot], keys.key_2[robot], tick[0], spot & 1)
        counts[spot] = round(min(max(value, 0.0), GROUND_FULL))


def _prepare(batch: BatchSensorView) -> Callable[[], LazyReadings]:
    ground, spots = batch.ground, Spots(batch.memory, _SENSORS * len(batch))
    offsets = batch.array((2, _SENSORS), "float64")
    offsets[:] = np.array(GROUND_SENSORS).T
    counts = batch.array((len(batch), _SENSORS), "int32")
    place = batch.bind(place_all, batch.robots, offsets[0], offsets[1], spots)
    count = batch.bind(count_all, spots, batch.noise_keys, batch.tick, counts)
    environments, overrides = batch.states(EnvironmentState), batch.states(SensorOverrideState)
    reflectances = spots.reflectance.reshape(-1, _SENSORS)

    def measure() -> LazyReadings:
        place()
        ground.sample_all(spots.x, spots.y, spots.reflectance, spots.floor)
        count()
        now_ns, count_lists, grays = batch.now_ns, counts.tolist(), reflectances.tolist()
        lights = [environment.ambient_light for environment in environments]
        chosen = [override.ground for override in overrides]

        def make(robot: int) -> GroundReading:
            return _reading(now_ns, lights[robot], count_lists[robot], grays[robot], chosen[robot])

        return LazyReadings(len(batch), make)

    return measure


def _reading(
    now_ns: int, light: int, counts: Sequence[int], grays: Sequence[float], override: Sequence[int]
) -> GroundReading:
    left, right = overridden(counts, override)
    if override:
        grays = [
            gray if count < 0 else units.ground_reflectance(count) for gray, count in zip(grays, override, strict=True)
        ]
    return GroundReading(now_ns, _words(light, left, right), (grays[0], grays[1]))


def _words(light: int, left: int, right: int) -> tuple[int, ...]:
    """Ambient, reflected and delta for what each sensor counts of its own light; ten bits hold no more than 1023."""
    if light == 0:
        return (0, 0, left, right, left, right)
    lit_left, lit_right = min(units.GROUND_FULL, left + light), min(units.GROUND_FULL, right + light)
    return (light, light, lit_left, lit_right, lit_left - light, lit_right - light)


SENSOR = Sensor(
    name="ground",
    period_ns=100_000_000,
    prepare_all=_prepare,
    is_stateless=True,
    aseba=AsebaFace(variables=(("prox.ground.ambiant", 2), ("prox.ground.reflected", 2), ("prox.ground.delta", 2))),
    values=(),
)
