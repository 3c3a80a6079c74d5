"""Two ground sensors (thymio-robot.md section 7.2).

Over floor the count is 60 + 884 / (1 + exp(-9 (g - 0.44))), g being the grey of the footprint, plus noise; it fades
to 0 as the footprint leaves the floor. The robot's light is the only one: ambient is 0, delta is reflected.
"""

from __future__ import annotations

import numpy as np

from thymio_sim_ros.sim import units
from thymio_sim_ros.sim.aseba_face import AsebaFace
from thymio_sim_ros.sim.columns import Later
from thymio_sim_ros.sim.ground import GroundSample
from thymio_sim_ros.sim.readings import GroundReading
from thymio_sim_ros.sim.sensors import Sensor
from thymio_sim_ros.sim.thymio2 import GROUND_NOISE, GROUND_SENSORS
from thymio_sim_ros.sim.view import GroupView, SensorView

__all__ = ["SENSOR", "response"]

_PLACES = np.array(GROUND_SENSORS)


def response(sample: GroundSample) -> float:
    """Count without noise over what a footprint sees."""
    return sample.floor * units.ground_response(sample.reflectance)


def _measure(view: SensorView) -> GroundReading:
    left, right = (view.ground_at(x, y) for x, y in GROUND_SENSORS)
    counts = (_count(left, view), _count(right, view))
    return GroundReading(view.now_ns, (0, 0, *counts, *counts), (left.reflectance, right.reflectance))


def _count(sample: GroundSample, view: SensorView) -> int:
    if sample.floor == 0.0:
        return 0
    value = response(sample) + view.noise.gauss(GROUND_NOISE)
    return round(max(0.0, min(float(units.GROUND_FULL), value)))


def _measure_all(group: GroupView) -> Later:
    now_ns = group.now_ns
    reflectances, floors = group.ground_at(_PLACES)
    values = (floors * units.ground_responses(reflectances)).ravel()
    over_floor = np.flatnonzero(floors)
    values[over_floor] += group.noise.draw(over_floor // 2, GROUND_NOISE)
    counts = np.rint(np.clip(values, 0.0, units.GROUND_FULL)).astype(int).reshape(-1, 2)

    def make(robot: int) -> GroundReading:
        left, right = counts[robot].tolist()
        grey_left, grey_right = reflectances[robot].tolist()
        return GroundReading(now_ns, (0, 0, left, right, left, right), (grey_left, grey_right))

    return Later(len(group), make)


SENSOR = Sensor(
    name="ground",
    period_ns=100_000_000,
    measure=_measure,
    measure_all=_measure_all,
    aseba=AsebaFace(variables=(("prox.ground.ambiant", 2), ("prox.ground.reflected", 2), ("prox.ground.delta", 2))),
)
