"""Two ground sensors (docs/spec/thymio-robot.md section 7.2).

Over floor the count is 60 + 884 / (1 + exp(-9 (g - 0.44))), g being the gray of the footprint, plus noise; it fades
to 0 as the footprint leaves the floor. Ambient is the operator's light, 0 at first; reflected is the count with that
added, at most 1023; delta is reflected less ambient. An operator can override counts
(`stimuli/sensor_override.py`).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thymio_sim_ros.sim.ground.sampling import GroundSample
from thymio_sim_ros.sim.model import units
from thymio_sim_ros.sim.model.readings import GroundReading
from thymio_sim_ros.sim.model.robot_constants import GROUND_NOISE, GROUND_SENSORS
from thymio_sim_ros.sim.plugin_api.aseba_binding import AsebaFace
from thymio_sim_ros.sim.plugin_api.reading_table import LazyReadings
from thymio_sim_ros.sim.plugin_api.view import BatchSensorView, SensorView
from thymio_sim_ros.sim.sensors import Sensor
from thymio_sim_ros.sim.stimuli.environment import EnvironmentState
from thymio_sim_ros.sim.stimuli.sensor_override import SensorOverrideState, overridden

__all__ = ["SENSOR", "response"]

_PLACES = np.array(GROUND_SENSORS)


def response(sample: GroundSample) -> float:
    """Return the count without noise for what a footprint sees."""
    return sample.floor * units.ground_response(sample.reflectance)


def _measure(view: SensorView) -> GroundReading:
    left, right = (view.ground_at(x, y) for x, y in GROUND_SENSORS)
    counts = (_count(left, view), _count(right, view))
    light, override = view.state(EnvironmentState).ambient_light, view.state(SensorOverrideState).ground
    return _reading(view.now_ns, light, counts, (left.reflectance, right.reflectance), override)


def _reading(
    now_ns: int, light: int, counts: Sequence[int], grays: Sequence[float], override: Sequence[int]
) -> GroundReading:
    left, right = overridden(counts, override)
    if override:
        grays = [
            gray if count < 0 else units.ground_reflectance(count) for gray, count in zip(grays, override, strict=True)
        ]
    return GroundReading(now_ns, _words(light, left, right), (grays[0], grays[1]))


def _count(sample: GroundSample, view: SensorView) -> int:
    if sample.floor == 0.0:
        return 0
    value = response(sample) + view.noise.gauss(GROUND_NOISE)
    return round(max(0.0, min(float(units.GROUND_FULL), value)))


def _words(light: int, left: int, right: int) -> tuple[int, ...]:
    """Ambient, reflected and delta for what each sensor counts of its own light; ten bits hold no more than 1023."""
    if light == 0:
        return (0, 0, left, right, left, right)
    lit_left, lit_right = min(units.GROUND_FULL, left + light), min(units.GROUND_FULL, right + light)
    return (light, light, lit_left, lit_right, lit_left - light, lit_right - light)


def _measure_all(batch: BatchSensorView) -> LazyReadings:
    now_ns = batch.now_ns
    reflectances, floors = batch.ground_at(_PLACES)
    values = (floors * units.ground_responses(reflectances)).ravel()
    over_floor = floors.ravel().nonzero()[0]
    values[over_floor] += batch.noise.draw(over_floor // 2, GROUND_NOISE)
    np.minimum(values, units.GROUND_FULL, out=values)
    np.maximum(values, 0.0, out=values)
    counts = np.rint(values, out=values).astype(np.int32).reshape(-1, 2)
    lights = [environment.ambient_light for environment in batch.states(EnvironmentState)]
    overrides = [state.ground for state in batch.states(SensorOverrideState)]

    def make(robot: int) -> GroundReading:
        return _reading(now_ns, lights[robot], counts[robot].tolist(), reflectances[robot].tolist(), overrides[robot])

    return LazyReadings(len(batch), make)


SENSOR = Sensor(
    name="ground",
    period_ns=100_000_000,
    measure=_measure,
    measure_all=_measure_all,
    aseba=AsebaFace(variables=(("prox.ground.ambiant", 2), ("prox.ground.reflected", 2), ("prox.ground.delta", 2))),
    values=(),
)
