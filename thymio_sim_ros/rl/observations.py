"""Observations of an agent: readings of sensors as numbers 0…1 or -1…1.

The numbers are the integers of the robot divided by their largest value, so that a policy can be used unchanged in an
Aseba program, a ROS node or on a real robot, which have the same integers.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from gymnasium import spaces

from thymio_sim_ros.sim.model.robot_constants import FULL_TARGET
from thymio_sim_ros.sim.model.units import GROUND_FULL, PROXIMITY_FULL

__all__ = ["SENSORS", "Observations", "observation_space", "observe"]

Observations = npt.NDArray[np.float32]
"""Shape (robots, numbers)."""


@dataclass(frozen=True, slots=True)
class _Observed:
    """The words of a reading that are observed, their number, their divisor, and the lower limit of the result."""

    words: slice
    size: int
    full: int
    low: float = 0.0


SENSORS = {
    "proximity": _Observed(slice(0, 7), 7, PROXIMITY_FULL),
    "ground": _Observed(slice(4, 6), 2, GROUND_FULL),
    "motor": _Observed(slice(0, 2), 2, FULL_TARGET, -1.0),
}
"""Observations by the name of the sensor: prox.horizontal, prox.ground.delta, motor.left.speed and right."""


def observation_space(sensors: Sequence[str]) -> spaces.Box:
    """The space of the observations of one robot: the numbers of these sensors, one after the other."""
    chosen = [SENSORS[name] for name in sensors]
    low = np.concatenate([np.full(sensor.size, sensor.low, np.float32) for sensor in chosen])
    return spaces.Box(low, np.ones_like(low), dtype=np.float32)


def observe(sensors: Sequence[str], words: Sequence[Sequence[Sequence[int]]]) -> Observations:
    """The observations of all robots, shape (robots, numbers).

    Args:
        sensors: names of the sensors.
        words: `words` of the reading of each of these sensors, of each robot.
    """
    columns = [
        np.clip(np.array([reading[SENSORS[name].words] for reading in readings]) / SENSORS[name].full, -1.0, 1.0)
        for name, readings in zip(sensors, words, strict=True)
    ]
    return np.concatenate(columns, axis=1, dtype=np.float32)
