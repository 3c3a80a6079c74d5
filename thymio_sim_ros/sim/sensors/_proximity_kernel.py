"""Kernel: counts of many proximity sensors, computed as in `sensors/proximity.py`, operation by operation."""

from __future__ import annotations

import math

from aseba_vm.kernel.types import Floats, Ints, kernel
from thymio_sim_ros.sim.model import robot_constants, units
from thymio_sim_ros.sim.model.units import proximity_response

__all__ = ["COS_CONE", "COUNTS", "proximity", "proximity_response"]

COUNTS = ("sensors", "rays", "model", "seen")
_SENSORS, _RAYS, _MODEL, _SEEN = range(len(COUNTS))
"""Meaning of each element of `counts`: `model` is an index in `PROXIMITY_MODELS`, `seen` the number of sensors that
detect something."""
_DEFAULT, _CONE = map(robot_constants.PROXIMITY_MODELS.index, ("default", "cone"))

_FULL = float(units.PROXIMITY_FULL)
_RANGE_M = robot_constants.PROXIMITY_RANGE_M
COS_CONE = math.cos(robot_constants.PROXIMITY_HALF_CONE_RAD)


@kernel
def proximity(counts: Ints, cosines: Floats, numbers: Ints, distances: Floats, noise: Floats, found: Ints) -> None:
    """Write the counts of all sensors to `found`.

    Sensors that detect something have their numbers in `numbers`, shape (seen,), the distances of their rays in
    `distances`, shape (seen, rays), and noise in `noise`, shape (seen,). `cosines` are those of the angles between rays
    and axis.
    """
    for sensor in range(counts[_SENSORS]):
        found[sensor] = 0
    rays = counts[_RAYS]
    for row in range(counts[_SEEN]):
        if counts[_MODEL] == _CONE:
            value = 0.0
            for ray in range(rays):
                distance = distances[row * rays + ray]
                if distance <= _RANGE_M:
                    value += proximity_response(distance * cosines[ray])
            value = value / rays
        else:
            right = distances[3 * row]
            center = distances[3 * row + 1]
            left = distances[3 * row + 2]
            if counts[_MODEL] == _DEFAULT:
                value = proximity_response(min(min(right * COS_CONE, center), left * COS_CONE))
            else:
                value = proximity_response(right) + proximity_response(center) + proximity_response(left)
                value = value - 2.0 * proximity_response(center / COS_CONE)
        found[numbers[row]] = round(min(max(value + noise[row], 0.0), _FULL))
