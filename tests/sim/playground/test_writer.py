"""Playgrounds written and read again."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from tests.sim.builders import PLAYGROUNDS, make
from tests.sim.images import BLACK, WHITE, png_uri
from thymio_sim_ros.sim.playground import reader
from thymio_sim_ros.sim.playground.writer import dumps

SHIPPED = sorted(path for path in PLAYGROUNDS.glob("*.json") if not path.name.endswith(".schema.json"))


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_a_playground_comes_back_the_same(path: Path) -> None:
    loaded = reader.load(path)
    assert reader.loads(dumps(loaded), path.stem) == loaded


def test_images_stay_inside() -> None:
    loaded = make([{"kind": "picture", "image": png_uri([[WHITE, BLACK]]), "size_x_m": 1}], [])
    assert replace(reader.loads(dumps(loaded), "test"), title="test") == loaded


def test_defaults_are_left_out() -> None:
    ground = {"kind": "rectangle", "name": "ground", "size_x_m": 1.0, "size_y_m": 1.0, "color": "#ffffff"}
    loaded = make([{**ground, "yaw_rad": 0.0, "walls": {"height_m": 0.12, "thickness_m": 0.02}}], [])
    assert json.loads(dumps(loaded))["shapes"] == [{**ground, "walls": {}}]
