"""The laser scanner that a simulated robot can carry; a real Thymio II has none."""

from __future__ import annotations

import math
from dataclasses import dataclass

__all__ = ["LIDAR", "LIDAR_HEIGHT_M", "LIDAR_MIN_M", "LIDAR_PLACE", "MOST_BEAMS", "Lidar"]

LIDAR = "lidar"
"""Name of the sensor."""
LIDAR_PLACE = (0.02, 0.0)
"""Origin of the beams in the robot's frame, m: over the middle of the hull. Own choice."""
LIDAR_HEIGHT_M = 0.05
"""Height of the beams, m: lower things are not seen. Own choice: just below the top of a hull, so that robots see each
other."""
LIDAR_MIN_M = 0.05
"""Shortest range, m: nothing outside of the hull is nearer."""
MOST_BEAMS = 1440
_NS = 1_000_000_000
_LIMITS = {
    "beams": (1, MOST_BEAMS),
    "range_m": (0.1, 10.0),
    "rate_hz": (0.1, 100.0),
    "noise_m": (0.0, 1.0),
}


@dataclass(frozen=True, slots=True)
class Lidar:
    """A scanner over the full circle. Raises ValueError for a value out of range.

    Args:
        beams: number of beams, 1 to 1440, counter-clockwise at equal angles; the first looks forward.
        range_m: longest range in m, 0.1 to 10.
        rate_hz: scans per simulated second, 0.1 to 100; a scan is taken at once.
        noise_m: standard deviation of a range in m, 0 to 1.
    """

    beams: int = 360
    range_m: float = 3.5
    rate_hz: float = 10.0
    noise_m: float = 0.01

    def __post_init__(self) -> None:
        for name, (low, high) in _LIMITS.items():
            value = getattr(self, name)
            if not low <= value <= high:  # NaN is rejected, too
                raise ValueError(f"lidar: {name}: found {value:g}, expected a number from {low:g} to {high:g}")

    @property
    def step_rad(self) -> float:
        """Angle between two beams in rad."""
        return math.tau / self.beams

    @property
    def period_ns(self) -> int:
        """Time between two scans in ns."""
        return round(_NS / self.rate_hz)
