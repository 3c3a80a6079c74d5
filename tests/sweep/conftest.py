"""A program, a playground, and small sweeps over them."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.sim.builders import FLOOR, ROBOT, box
from thymio_sim_ros.sweep.description import Description

PROGRAM = """<!DOCTYPE aesl-source>
<network><constant value="100" name="SPEED"/><event size="0" name="beat"/><event size="0" name="other"/>
<node nodeId="1" name="thymio-II">var n = 0
var offset = 0
var history[3]
timer.period[0] = 500
motor.left.target = SPEED
motor.right.target = SPEED
onevent timer0
n += 1
history[1] = n
motor.left.target = SPEED + offset
emit beat
</node></network>
"""
TRACK = {"kind": "track", "name": "track", "points_m": [[0, 0], [1, 0]], "width_m": 0.03, "color": "#000000"}


@pytest.fixture(scope="session")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with `pulse.aesl` and `hall.json`: a robot drives along a track, and a box stands on it."""
    path = tmp_path_factory.mktemp("sweep")
    shapes = [FLOOR, TRACK, {**box(0.7, 0.0, 0.1, 0.4), "name": "box"}]
    hall = {"format": 1, "title": "Hall", "shapes": shapes, "robots": [ROBOT]}
    (path / "pulse.aesl").write_text(PROGRAM)
    (path / "hall.json").write_text(json.dumps(hall))
    return path


@pytest.fixture(scope="session")
def describe(folder: Path) -> Callable[..., Description]:
    """Makes a description over the files of the folder, two simulated seconds by default."""

    def make(**changes: Any) -> Description:
        files = {"programs": ("pulse.aesl",), "playgrounds": ("hall.json",), "seconds": 2.0, "folder": folder}
        return Description(**{**files, **changes})

    return make
