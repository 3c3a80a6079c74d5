"""Names of other simulators as unique ROS names; numbers without noise in the last digits."""

from __future__ import annotations

import math
import re
import unicodedata

__all__ = ["Names", "rounded", "turned"]

_LONGEST = 50


class Names:
    """Makes unique names of letters, digits and single underscores, with a letter first."""

    def __init__(self) -> None:
        self._taken: set[str] = set()

    def take(self, wanted: str, otherwise: str) -> str:
        """An unused name like `wanted`, or like `otherwise` if nothing of it can be kept."""
        plain = unicodedata.normalize("NFKD", wanted).encode("ascii", "ignore").decode()
        words = re.findall(r"[A-Za-z0-9]+", re.sub(r"(?<=[a-z])(?=[A-Z])", " ", plain))
        name = "_".join(words).lower()[:_LONGEST].strip("_")
        if not name[:1].isalpha():
            name = f"{otherwise}_{name}" if name else otherwise
        found, number = name, 2
        while found in self._taken:
            found, number = f"{name}_{number}", number + 1
        self._taken.add(found)
        return found


def rounded(value: float) -> float:
    """Meters or radians rounded to 1e-9: 5 cm become 0.05, not 0.05000000000000001."""
    return round(value, 9) + 0.0


def turned(angle_rad: float) -> float:
    """The same direction in [-π, π]."""
    return rounded(math.remainder(angle_rad, math.tau))
