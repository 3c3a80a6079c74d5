"""Rasters without a ground."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thymio_sim_ros.sim.ground.raster import Picture, grid_of
from thymio_sim_ros.sim.model.primitives import Floor, Mark


def picture_of(floors: Sequence[Floor], paints: Sequence[Mark]) -> Picture:
    """The raster of floors and paint."""
    return Picture(floors, paints, np.zeros(grid_of(floors)[2], dtype=np.uint16), np.zeros(Picture.COLORS))
