"""Every playground that is shipped: it loads, it fits the schema, and it is what its name promises."""

from __future__ import annotations

import itertools
import json
import math
from pathlib import Path

import jsonschema
import pytest

from thymio_sim_ros.sim import playground
from thymio_sim_ros.sim.primitives import Disc
from thymio_sim_ros.sim.shapes.track import Track
from thymio_sim_ros.sim.world import World

FOLDER = Path(__file__).parents[1] / "playgrounds"
SCHEMA = FOLDER / "playground.schema.json"
SHIPPED = sorted(path for path in FOLDER.glob("*.json") if path != SCHEMA)


def test_the_three_of_the_thesis_and_the_line_are_there() -> None:
    assert {"base", "borderless", "obstacle", "line"} <= {path.stem for path in SHIPPED}


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_a_shipped_playground_loads_and_runs(path: Path) -> None:
    world = World(playground.load(path))
    world.step()
    assert len(world.robots) == 1


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_a_shipped_playground_has_a_title_and_a_description(path: Path) -> None:
    loaded = playground.load(path)
    assert loaded.title
    assert loaded.description.endswith(".")


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_a_shipped_playground_fits_the_published_schema(path: Path) -> None:
    jsonschema.validate(json.loads(path.read_text()), json.loads(SCHEMA.read_text()))


def test_the_published_schema_is_the_one_of_the_shapes() -> None:
    assert json.loads(SCHEMA.read_text()) == playground.schema()


def test_the_schema_refuses_what_the_loader_refuses() -> None:
    wrong = {"format": 1, "title": "x", "shapes": [{"kind": "cylinder", "radius": 1}]}
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(wrong, json.loads(SCHEMA.read_text()))


def test_base_is_a_metre_square_that_is_free_inside_0_98() -> None:
    loaded = playground.load(FOLDER / "base.json")
    inner = [min(abs(x) for x, _ in wall.vertices) for wall in loaded.solids if abs(wall.pose.x_m) > 0.1]
    assert inner == pytest.approx([0.49, 0.49])
    assert {wall.height_m for wall in loaded.solids} == {0.12}


def test_borderless_has_a_track_of_1_31_m_that_ends_before_the_edge_and_no_walls() -> None:
    loaded = playground.load(FOLDER / "borderless.json")
    (points,) = (named.shape.points_m for named in loaded.shapes if isinstance(named.shape, Track))
    length = sum(math.dist(a, b) for a, b in itertools.pairwise(points))
    apothem = (1 + math.sqrt(2)) / 2
    to_edge = apothem - (points[-1][0] - points[-1][1]) / math.sqrt(2)
    assert length == pytest.approx(1.31, abs=0.01)
    assert to_edge == pytest.approx(0.019, abs=0.001)
    assert loaded.solids == ()


def test_obstacle_has_24_cylinders_and_a_track_of_6_88_m() -> None:
    loaded = playground.load(FOLDER / "obstacle.json")
    (points,) = (named.shape.points_m for named in loaded.shapes if isinstance(named.shape, Track))
    discs = [solid for solid in loaded.solids if isinstance(solid.outline, Disc)]
    assert sum(math.dist(a, b) for a, b in itertools.pairwise(points)) == pytest.approx(6.88, abs=0.01)
    assert len(discs) == 24
    assert len(loaded.solids) == 24 + 8 + 3


def test_line_is_black_40_mm_wide_and_never_tighter_than_20_cm() -> None:
    loaded = playground.load(FOLDER / "line.json")
    (track,) = (named.shape for named in loaded.shapes if isinstance(named.shape, Track))
    assert (track.closed, track.color, track.width_m) == (True, "#000000", 0.04)
    assert track.corner_radius_m >= 0.2


def test_the_example_of_the_readme_loads() -> None:
    text = (FOLDER / "README.md").read_text()
    example = text.split("```json")[1].split("```")[0]
    assert playground.loads(example, "README.md").title == "My square"


def test_the_readme_lists_every_playground() -> None:
    text = (FOLDER / "README.md").read_text()
    assert all(f"`{path.name}`" in text for path in SHIPPED)
