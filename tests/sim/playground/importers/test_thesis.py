"""The JSON of the thesis: key beside shape, and its three playgrounds beside ours.

Source: docs/spec/playground-formats.md section 2.
"""

from __future__ import annotations

import json
import math
from typing import Any

import pytest

from tests.sim.builders import shipped
from thymio_sim_ros.sim.model.fields import FieldError
from thymio_sim_ros.sim.playground import reader
from thymio_sim_ros.sim.playground.importers import Conversion, thesis
from thymio_sim_ros.sim.playground.reader import Playground

GRAY, BLUE, RED = "#bdbbbb", "#9fa3bd", "#fc031c"
THYMIO = {"name": "thymio", "positionX": 0, "positionZ": 0}


def at(x: float, z: float) -> dict[str, float]:
    return {"positionX": x, "positionZ": z}


def octagon(*, walls: bool) -> dict[str, Any]:
    return {"name": "ground", "props": {"segmentLength": 50, "color": GRAY}, "hasWalls": walls}


def pillar(name: str, x: float, z: float) -> dict[str, Any]:
    size = {"topRadius": 2, "botRadius": 2, "height": 6, "color": BLUE}
    return {"name": name, "props": {**size, **at(x, z)}}


BASE = {
    "playground": "Base",
    "planes": [{"name": "ground", "props": {"width": 50, "height": 50, "color": GRAY}, "hasWalls": True}],
    "thymios": THYMIO,
}
BORDERLESS = {
    "playground": "Borderless",
    "octagons": [octagon(walls=False)],
    "tracks": [{"name": "track", "props": {"color": RED, "points": [at(0, 0), at(20, 0), at(52, 32)]}}],
    "thymios": THYMIO,
}
TRACK = [
    (0, 0), (25, 0), (35, 10), (35, 35), (25, 45), (-20, 40), (-34, 28), (-34, 23), (-18, 6), (-18, -6), (-40, -25),
    (-40, -35), (-30, -45), (25, -45), (35, -35), (35, -10), (25, 0),
]  # fmt: skip
PILLARS = (
    [pillar(f"TLC{i + 1}", -14 - 3 * i, -14 - 3 * i) for i in range(7)]
    + [pillar(f"MLC{i + 1}", -58 + 4 * i, 0) for i in range(9)]
    + [pillar(f"BLC{i + 1}", -d, d) for i, d in enumerate((14, 17, 20, 23, 26, 35, 38, 41))]
)
OBSTACLE = {
    "playground": "Obstacle",
    "octagons": [octagon(walls=True)],
    "tracks": [{"name": "track", "props": {"color": RED, "points": [at(x, z) for x, z in TRACK]}}],
    "uShapes": [{"name": "U", "props": {"height": 6, "size": 3, "color": BLUE, **at(0, 0)}}],
    "cylinders": PILLARS,
    "thymios": THYMIO,
}


def loaded(data: Any) -> Playground:
    return reader.loads(json.dumps(data), "mine.json")


def converted(**members: Any) -> Conversion:
    return thesis.convert({"playground": "Mine", "thymios": THYMIO, **members}, "mine")


def refused(**members: Any) -> FieldError:
    with pytest.raises(FieldError) as caught:
        converted(**members)
    return caught.value


def parts(found: Playground) -> tuple[Any, ...]:
    """What it is made of, by place; the names of the pillars are the file's."""
    solids = sorted(
        (round(solid.pose.x_m, 6), round(solid.pose.y_m, 6), repr(solid.outline), solid.height_m, solid.color)
        for solid in found.solids
    )
    return solids, [floor.vertices for floor in found.floors], [mark.vertices for mark in found.paints]


@pytest.mark.parametrize(("data", "name"), [(BASE, "base"), (BORDERLESS, "borderless"), (OBSTACLE, "obstacle")])
def test_the_three_playgrounds_are_those_we_ship(data: Any, name: str) -> None:
    ours, theirs = shipped(name), loaded(data)
    assert parts(theirs) == parts(ours)
    assert [robot.pose for robot in theirs.robots] == [robot.pose for robot in ours.robots]
    assert theirs.notes == ()


def test_the_title_is_theirs() -> None:
    assert loaded(BASE).title == "Base"


def test_a_box_stands_where_it_stood_and_turns_the_same_way() -> None:
    size = {"width": 5, "height": 6, "depth": 10}
    (box,) = converted(boxes=[{"name": "Box 1", "props": {**size, "color": RED, "rotateY": 0.5, **at(10, 20)}}]).shapes
    assert box == {
        "kind": "box", "name": "box_1", "x_m": 0.2, "y_m": -0.4, "size_x_m": 0.1, "size_y_m": 0.2, "height_m": 0.12,
        "yaw_rad": 0.5, "color": RED,
    }  # fmt: skip


def test_the_height_of_a_plane_is_its_extent_in_z() -> None:
    (plane,) = converted(planes=[{"name": "p", "props": {"width": 10, "height": 20, "color": "#fff"}}]).shapes
    assert (plane["size_x_m"], plane["size_y_m"], plane["color"], "walls" in plane) == (0.2, 0.4, "#ffffff", False)


def test_walls_may_be_asked_for_inside_the_properties() -> None:
    (plane,) = converted(planes=[{"props": {"width": 9, "height": 9, "color": RED, "hasWalls": True}}]).shapes
    assert plane["walls"] == {"height_m": 0.12, "thickness_m": 0.02}


def test_a_cone_becomes_a_cylinder_of_its_larger_radius() -> None:
    cone = {"topRadius": 1, "botRadius": 2, "height": 6, "color": RED, **at(0, 30)}
    found = converted(cylinders=[{"name": "c", "props": cone}])
    assert found.shapes[0]["radius_m"] == 0.04
    assert found.notes == ["cylinders[0]: cone replaced by a cylinder of its larger radius"]


def test_a_u_without_a_position_is_at_the_origin() -> None:
    (figure,) = converted(uShapes=[{"name": "u", "props": {"height": 6, "size": 3, "color": RED}}]).shapes
    assert (figure["x_m"], figure["y_m"], figure["unit_m"]) == (0.0, 0.0, 0.06)


def test_both_coordinates_of_a_position_count_even_if_one_is_zero() -> None:
    (figure,) = converted(uShapes=[{"props": {"height": 6, "size": 3, "color": RED, **at(0, 5)}}]).shapes
    assert (figure["x_m"], figure["y_m"]) == (0.0, -0.1)


def test_robots_may_be_several_and_may_be_turned() -> None:
    robots = [{"name": "A", **at(10, 20)}, {"name": "A", **at(-10, 0), "rotateY": math.pi}]
    assert converted(thymios=robots).robots == [
        {"name": "a", "x_m": 0.2, "y_m": -0.4, "yaw_rad": 0.0},
        {"name": "a_2", "x_m": -0.2, "y_m": 0.0, "yaw_rad": round(math.pi / 2, 9)},
    ]


def test_without_a_robot_one_starts_at_the_origin() -> None:
    found = loaded({key: value for key, value in BASE.items() if key != "thymios"})
    assert [(robot.name, robot.pose.x_m) for robot in found.robots] == [("thymio", 0.0)]
    assert found.notes == ("thymios: none found, one robot starts at the origin",)


def test_the_empty_playground_has_a_robot_and_no_floor() -> None:
    found = loaded({"playground": "Empty", "thymios": THYMIO})
    assert (len(found.robots), found.floors) == (1, ())
    assert found.notes == ()


@pytest.mark.parametrize(
    ("color", "shade"),
    [
        ("red", "#ff0000"),
        ("rgb(10, 20, 30)", "#0a141e"),
        ("rgba(10, 20, 30, 0.5)", "#0a141e"),
        ("rgb(10 20 30 / 50%)", "#0a141e"),
        ("rgb(300, 0, 0)", "#ff0000"),
        ("hsla(120deg, 100%, 50%, 1)", "#00ff00"),
        ("#ABCDEF", "#ABCDEF"),
        (0xBDBBBB, "#bdbbbb"),
    ],
)
def test_any_css_color_is_read(color: Any, shade: str) -> None:
    (plane,) = converted(planes=[{"props": {"width": 9, "height": 9, "color": color}}]).shapes
    assert plane["color"] == shade


def test_unknown_keys_are_told_and_passed_over() -> None:
    found = converted(planes=[{"props": {"width": 9, "height": 9, "color": RED, "shine": 1}}], weather="rain")
    assert found.notes == [
        "planes[0].shine skipped: unknown key",
        "weather skipped: unknown key",
    ]


@pytest.mark.parametrize(
    ("members", "key"),
    [
        ({"planes": {}}, "planes"),
        ({"planes": [3]}, "planes[0]"),
        ({"planes": [{"props": 3}]}, "planes[0].props"),
        ({"planes": [{"props": {"width": "9", "height": 9, "color": RED}}]}, "planes[0].width"),
        ({"planes": [{"props": {"width": True, "height": 9, "color": RED}}]}, "planes[0].width"),
        ({"planes": [{"props": {"height": 9, "color": RED}}]}, "planes[0].width"),
        ({"planes": [{"props": {"width": 9, "height": 9, "color": "reddish"}}]}, "planes[0].color"),
        ({"planes": [{"props": {"width": 9, "height": 9, "color": -1}}]}, "planes[0].color"),
        ({"planes": [{"props": {"width": 9, "height": 9, "color": RED}, "hasWalls": 1}]}, "planes[0].hasWalls"),
        ({"tracks": [{"props": {"color": RED}}]}, "tracks[0].points"),
        ({"tracks": [{"props": {"color": RED, "points": [{"positionX": 1}]}}]}, "tracks[0].points[0].positionZ"),
        ({"cylinders": [pillar("a", 1e10, 0)]}, "cylinders[0].positionX"),
        ({"thymios": [{"positionX": "a"}]}, "thymios[0].positionX"),
        ({"playground": 3}, "playground"),
    ],
)
def test_what_is_wrong_is_refused_at_its_key(members: Any, key: str) -> None:
    assert refused(**members).key == key


def test_what_our_format_refuses_is_located_in_the_original() -> None:
    with pytest.raises(reader.PlaygroundError) as caught:
        loaded({**BASE, "cylinders": [pillar("c", 0, 0)]})
    assert caught.value.key == "thymios (robots[0])"
