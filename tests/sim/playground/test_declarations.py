"""What the page knows of playgrounds is what the shapes declare; rules that it repeats give the same verdicts."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from thymio_sim_ros.sim.model.field_declarations import field_declarations, sample_values
from thymio_sim_ros.sim.model.fields import Angle, Area, Coordinate, Extent, Image, Mass, Shade
from thymio_sim_ros.sim.model.primitives import Primitive
from thymio_sim_ros.sim.playground import declarations, reader
from thymio_sim_ros.sim.shapes import ShapeKind, declaration, own_shapes

ROOT = Path(__file__).parents[3]
GENERATED = ROOT / "web_ui" / "playground" / "declarations.json"
CASES = json.loads((ROOT / "tests" / "data" / "web" / "playground_cases.json").read_text())


@dataclass(frozen=True)
class Ring:
    """A shape of a plug-in."""

    x_m: Coordinate
    radius_m: Extent
    area_m: Area
    image: Image
    color: Shade
    yaw_rad: Angle = 0.5
    mass_kg: Mass | None = None

    def primitives(self, name: str) -> tuple[Primitive, ...]:
        """Nothing that can be built without an image that can be read."""
        raise ValueError(name)


def test_the_generated_file_of_the_page_holds_the_declarations() -> None:
    command = "python -m thymio_sim_ros.sim.playground.declarations > web_ui/playground/declarations.json"
    assert GENERATED.read_text() == declarations.as_json(own_shapes(), indent=2) + "\n", f"run: {command}"


def test_a_field_is_declared_with_its_type_its_limits_and_its_default() -> None:
    fields = field_declarations(Ring)
    assert list(fields) == ["x_m", "radius_m", "area_m", "image", "color", "yaw_rad", "mass_kg"]
    assert fields["radius_m"] == {"type": "number", "unit": "m", "low": 0.001, "high": 100.0, "required": True}
    assert fields["yaw_rad"]["default"] == 0.5
    assert fields["color"]["format"] == "color"
    assert fields["mass_kg"]["nullable"]
    assert fields["mass_kg"]["default"] is None


def test_a_new_item_has_the_values_of_the_sample_and_others_within_their_limits() -> None:
    sample = sample_values(Ring, {"radius_m": 0.3})
    assert sample["radius_m"] == 0.3
    assert sample["x_m"] == 0.0
    assert sample["color"].startswith("#")
    assert len(sample["area_m"]) == 3
    assert "image" not in sample
    with pytest.raises(TypeError, match="found 'radius', expected one of x_m"):
        sample_values(Ring, {"radius": 0.3})


@pytest.mark.parametrize("kind", own_shapes(), ids=lambda kind: kind.name)
def test_every_shape_of_ours_has_a_sample_that_the_simulator_builds(kind: ShapeKind) -> None:
    assert kind.sample
    declared = declaration(kind)
    assert declared["group"] == {
        "rectangle": "ground", "octagon": "ground", "picture": "paint", "track": "paint",
    }.get(kind.name, "object")  # fmt: skip
    assert set(declared["sample"]) <= set(declared["fields"])
    assert declared["primitives"]


def test_a_shape_that_cannot_be_built_from_its_fields_alone_counts_as_an_object() -> None:
    declared = declaration(ShapeKind("ring", Ring, sample={"radius_m": 0.1}))
    assert declared["group"] == "object"
    assert declared["primitives"] == []


@pytest.mark.parametrize("case", CASES, ids=lambda case: case["name"])
def test_the_simulator_gives_the_verdict_of_the_table(case: dict[str, Any]) -> None:
    """The page's verdicts are tested by tests/web_ui/playground.test.js."""
    text = json.dumps({"format": 1, **case["playground"]})
    if case["key"] is None:
        reader.loads(text, "case")
        return
    with pytest.raises(reader.PlaygroundError) as refused:
        reader.loads(text, "case")
    assert refused.value.key == case["key"]
