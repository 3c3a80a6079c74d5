"""What the page's creator gets of the shapes that it draws."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from tests.sim.images import BLACK, WHITE, png_uri
from thymio_sim_ros.sim import shapes as kinds
from thymio_sim_ros.sim.model.fields import FieldError
from thymio_sim_ros.sim.playground.drawings import drawings
from thymio_sim_ros.sim.playground.reader import MAX_SHAPES

TEXTS = json.loads((Path(kinds.__file__).parents[3] / "aseba_vm" / "languages" / "en" / "creator.json").read_text())
BOX = {"kind": "box", "x_m": 1, "y_m": 2, "size_x_m": 0.2, "size_y_m": 0.1, "height_m": 0.3, "color": "#112233"}
POST = {"kind": "cylinder", "x_m": 1, "y_m": 2, "radius_m": 0.1, "height_m": 0.3, "color": "#112233"}
TRACK = {"kind": "track", "points_m": [[0, 0], [1, 0], [1, 1]], "width_m": 0.1, "color": "#000000"}
PICTURE = {"kind": "picture", "size_x_m": 0.4, "image": "data:"}


def drawn(*shapes: object) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = json.loads(drawings(json.dumps(shapes)))
    return found


def test_each_shape_has_its_primitives_in_order() -> None:
    (box,), (post,) = (one["primitives"] for one in drawn(BOX, POST))
    solid = {"type": "solid", "pose": {"x": 1.0, "y": 2.0, "yaw": 0.0}, "height": 0.3, "color": "#112233"}
    assert box == solid | {"size": [0.2, 0.1]}
    assert post == solid | {"radius": 0.1}


@pytest.mark.parametrize("image", ["data:", png_uri([[WHITE, BLACK, WHITE]])])
def test_images_are_not_read_and_give_a_print_its_proportions(image: str) -> None:
    (free,), (fixed,) = (one["primitives"] for one in drawn(PICTURE | {"image": image}, PICTURE | {"size_y_m": 0.4}))
    assert (free["sizeX"], free["sizeY"], free["image"]) == (0.4, None, "image")
    assert fixed["sizeY"] == 0.4


@pytest.mark.parametrize(
    ("shape", "key", "word"),
    [
        (TRACK | {"corner_radius_m": 0.01}, "corner_radius_m", "radius"),
        (TRACK | {"corner_radius_m": 2.0}, "corner_radius_m", "corners"),
        (TRACK | {"points_m": [[0, 0], [0, 0]]}, "points_m", "places"),
        ({"kind": "boxx"}, "kind", "kind"),
        (BOX | {"x_m": "far"}, "x_m", ""),
        (BOX | {"name": "crate"}, "name", ""),
        (3, "", ""),
    ],
)
def test_a_fault_has_its_key_and_the_rule_that_the_page_has_a_text_for(shape: object, key: str, word: str) -> None:
    faulty, good = drawn(shape, BOX)
    assert (faulty["fault"]["key"], faulty["fault"]["word"]) == (key, word)
    assert faulty["fault"]["expected"]
    assert not word or f"fault.{word}" in TEXTS
    assert "primitives" in good


def test_nothing_is_computed_after_too_many_primitives() -> None:
    points = [[index % 2, index / 10] for index in range(500)]
    bolt = TRACK | {"points_m": points, "width_m": 0.04, "corner_radius_m": 0.02}
    assert [one["fault"]["word"] for one in drawn(bolt, {"kind": "no_kind"})] == ["tooMuch", "tooMuch"]
    assert "fault.tooMuch" in TEXTS


@pytest.mark.parametrize(
    "text", ["[", "{}", "3", "<a/>", "PK\x03\x04", json.dumps([BOX] * (MAX_SHAPES + 1)), "[" * 100_000]
)
def test_anything_but_a_list_of_shapes_is_refused(text: str) -> None:
    with pytest.raises(FieldError):
        drawings(text)


@pytest.mark.parametrize("found", [KeyError("size"), ValueError("too wide"), RecursionError("deep"), float("nan")])
def test_a_shape_of_another_package_that_cannot_be_built_is_a_fault(
    monkeypatch: pytest.MonkeyPatch, found: Exception | float
) -> None:
    def broken(shade: str) -> tuple[float, float, float]:
        if isinstance(found, Exception):
            raise found
        return (found,) * 3

    monkeypatch.setattr("thymio_sim_ros.sim.shapes.box.as_color", broken)
    faulty, good = drawn(BOX, POST)
    assert str(getattr(found, "args", ("NaN",))[0]) in faulty["fault"]["found"]
    assert "primitives" in good
