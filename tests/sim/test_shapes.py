"""Every kind of shape, as the primitives it becomes."""

from __future__ import annotations

import math
from typing import Any

import pytest

from tests.sim.builders import GRAY, make
from tests.sim.images import BLACK, WHITE, png_uri
from thymio_sim_ros.sim.model.geometry import Point, Pose, is_convex
from thymio_sim_ros.sim.model.primitives import Box, Disc, Load, Print, Slide, Solid
from thymio_sim_ros.sim.playground.reader import Playground
from thymio_sim_ros.sim.shapes import all_shapes

WALLS = {"height_m": 0.12, "thickness_m": 0.02}
DOOR = {"closed_x_m": 0, "closed_y_m": 0, "opened_x_m": 0.3, "opened_y_m": 0, "move_s": 2, "color": GRAY}
BLOCK = {"size_x_m": 0.2, "size_y_m": 0.02}
KINDS: dict[str, dict[str, Any]] = {
    "activation": {"x_m": 1, "y_m": 2, "door": "gate", "area_m": [[0, 0], [0.2, 0], [0, 0.2]], "yaw_rad": 0.5} | BLOCK,
    "box": {"x_m": 1, "y_m": 2, "size_x_m": 0.3, "size_y_m": 0.2, "height_m": 0.1, "color": GRAY, "yaw_rad": 0.5},
    "cylinder": {"x_m": 1, "y_m": 2, "radius_m": 0.1, "height_m": 0.1, "color": GRAY},
    "door": {**DOOR, **BLOCK, "height_m": 0.1, "yaw_rad": 0.5},
    "octagon": {"side_m": 1.0, "color": GRAY, "walls": WALLS},
    "picture": {"image": png_uri([[WHITE, BLACK], [BLACK, WHITE]]), "size_x_m": 0.4, "x_m": 1.0, "yaw_rad": 0.5},
    "rectangle": {"size_x_m": 1.0, "size_y_m": 0.5, "color": GRAY, "walls": WALLS},
    "track": {"points_m": [[0, 0], [1, 0], [1, 1]], "width_m": 0.04, "color": GRAY, "corner_radius_m": 0.2},
    "u_figure": {"unit_m": 0.06, "height_m": 0.12, "color": GRAY},
    "wall": {"start_x_m": 0, "start_y_m": 0, "end_x_m": 1, "end_y_m": 1, "color": GRAY},
}


def built(kind: str, **changes: Any) -> Playground:
    gate = {"kind": "door", "name": "gate", **KINDS["door"]}
    return make([{"kind": kind, **KINDS[kind], **changes}, *([gate] if kind == "activation" else [])], [])


def extent(solids: tuple[Solid, ...], axis: int) -> tuple[float, float]:
    values = [vertex[axis] for solid in solids for vertex in solid.vertices]
    return (min(values), max(values))


def flat(vertices: tuple[Point, ...]) -> list[float]:
    return [value for vertex in vertices for value in vertex]


def test_every_kind_has_an_example_here() -> None:
    assert [kind.name for kind in all_shapes()] == list(KINDS)


@pytest.mark.parametrize("kind", KINDS)
def test_all_parts_are_convex_and_counter_clockwise(kind: str) -> None:
    playground = built(kind)
    parts: list[tuple[Point, ...]] = [floor.vertices for floor in playground.floors]
    parts.extend(paint.vertices for paint in playground.paints)
    parts.extend(solid.vertices for solid in playground.solids if not isinstance(solid.outline, Disc))
    assert all(is_convex(part) for part in parts)


def test_a_box_is_one_solid_at_its_pose() -> None:
    (solid,) = built("box").solids
    assert (solid.pose, solid.outline, solid.height_m) == (Pose(1.0, 2.0, 0.5), Box(0.3, 0.2), 0.1)


def test_an_image_keeps_its_proportions_unless_told() -> None:
    wide = png_uri([[WHITE, BLACK, WHITE]])
    prints = [built("picture", image=wide).paints[0], built("picture", image=wide, size_y_m=0.1).paints[0]]
    assert [(one.size_x_m, round(one.size_y_m, 6)) for one in prints if isinstance(one, Print)] == [
        (0.4, 0.133333),
        (0.4, 0.1),
    ]


def test_a_cylinder_is_one_disc() -> None:
    (solid,) = built("cylinder").solids
    assert (solid.pose, solid.outline) == (Pose(1.0, 2.0, 0.0), Disc(0.1))


def test_the_walls_of_a_rectangle_stand_half_inside_its_border() -> None:
    walls = built("rectangle").solids
    assert extent(walls, 0) == pytest.approx((-0.51, 0.51))
    assert extent(walls, 1) == pytest.approx((-0.26, 0.26))
    assert {wall.outline for wall in walls} == {Box(0.02, 0.52), Box(1.02, 0.02)}


def test_a_turned_rectangle_turns_its_walls() -> None:
    walls = built("rectangle", yaw_rad=math.pi / 2).solids
    assert extent(walls, 0) == pytest.approx((-0.26, 0.26))


def test_walls_have_the_color_of_their_ground_unless_they_have_their_own() -> None:
    assert built("rectangle").solids[0].color == pytest.approx((128 / 255,) * 3)
    assert built("rectangle", walls={"color": "#ff0000"}).solids[0].color == (1.0, 0.0, 0.0)


def test_an_octagon_is_as_wide_as_its_side_demands() -> None:
    (floor,) = built("octagon").floors
    assert max(x for x, _ in floor.vertices) == pytest.approx((1 + math.sqrt(2)) / 2)
    assert math.dist(floor.vertices[0], floor.vertices[1]) == pytest.approx(1.0)


def test_the_walls_of_an_octagon_leave_its_inside_free() -> None:
    walls = built("octagon").solids
    inner = min(wall.pose.x_m for wall in walls if wall.pose.x_m > 1.0) - 0.01
    assert inner == pytest.approx(2.394 / 2, abs=5e-4)
    assert len(walls) == 8


def test_a_ground_without_walls_is_only_floor() -> None:
    playground = built("octagon", walls=None)
    assert (len(playground.floors), playground.solids) == (1, ())


def test_the_u_has_the_three_boxes_of_the_thesis() -> None:
    boxes = [(solid.pose.x_m, solid.pose.y_m, solid.outline) for solid in built("u_figure").solids]
    expected = [(0.0, -0.24, Box(0.48, 0.06)), (-0.18, 0.0, Box(0.12, 0.42)), (0.12, 0.24, Box(0.72, 0.12))]
    for (x, y, outline), (expected_x, expected_y, size) in zip(boxes, expected, strict=True):
        assert (x, y) == pytest.approx((expected_x, expected_y))
        assert isinstance(outline, Box)
        assert (outline.size_x_m, outline.size_y_m) == pytest.approx((size.size_x_m, size.size_y_m))


def test_a_wall_reaches_half_a_thickness_beyond_both_ends() -> None:
    (solid,) = built("wall", end_y_m=0).solids
    assert extent((solid,), 0) == pytest.approx((-0.01, 1.01))
    assert extent((solid,), 1) == pytest.approx((-0.01, 0.01))


def test_a_track_without_radius_is_one_rectangle_per_piece() -> None:
    first, second = built("track", corner_radius_m=0).paints
    assert flat(first.vertices) == pytest.approx([0.0, -0.02, 1.0, -0.02, 1.0, 0.02, 0.0, 0.02])
    assert flat(second.vertices) == pytest.approx([1.02, 0.0, 1.02, 1.0, 0.98, 1.0, 0.98, 0.0])


def test_a_closed_track_returns_to_its_first_point() -> None:
    paints = built("track", corner_radius_m=0, closed=True).paints
    assert len(paints) == 3


def test_closing_a_track_that_repeats_its_first_point_adds_no_piece() -> None:
    points = [[0, 0], [1, 0], [1, 1], [0, 0]]
    assert len(built("track", points_m=points, corner_radius_m=0, closed=True).paints) == 3


def test_rounded_corners_keep_their_radius() -> None:
    corners = [vertex for paint in built("track").paints[1:-1] for vertex in paint.vertices]
    distances = [math.dist(vertex, (0.8, 0.2)) for vertex in corners]
    assert min(distances) == pytest.approx(0.18)
    assert max(distances) == pytest.approx(0.22)


def test_pieces_of_a_rounded_track_share_their_edges() -> None:
    paints = built("track", closed=True, points_m=[[0, 0], [1, 0], [1, 1], [0, 1]]).paints
    for paint, following in zip(paints, (*paints[1:], paints[0]), strict=True):
        assert paint.vertices[1] == pytest.approx(following.vertices[0])
        assert paint.vertices[2] == pytest.approx(following.vertices[3])


def test_a_box_or_cylinder_with_a_mass_is_movable_and_rubs_on_the_floor() -> None:
    (solid,) = built("box", mass_kg=0.2, size_x_m=0.1, size_y_m=0.1).solids
    assert solid.load == Load(0.2, 0.25, pytest.approx(0.03826, abs=1e-5), 0.1)
    (solid,) = built("cylinder", mass_kg=0.2, friction=0.5, restitution=0.0).solids
    assert solid.load == Load(0.2, 0.5, pytest.approx(0.1 * 2 / 3), 0.0)


@pytest.mark.parametrize("kind", ["box", "cylinder", "wall", "u_figure"])
def test_what_has_no_mass_is_fixed(kind: str) -> None:
    assert all(solid.load is None for solid in built(kind).solids)


def test_a_door_is_a_solid_that_slides() -> None:
    (solid,) = built("door").solids
    assert (solid.pose, solid.slide) == (Pose(0.0, 0.0, 0.5), Slide(Pose(0.3, 0.0, 0.5), 2.0))


def test_an_activation_is_a_low_red_block_and_an_area_around_it() -> None:
    playground = built("activation", yaw_rad=math.pi / 2)
    block, (trigger,) = playground.solids[0], playground.triggers
    assert (block.height_m, block.color) == (0.06, (1.0, 0.0, 0.0))
    assert flat(trigger.vertices) == pytest.approx([1, 2, 1, 2.2, 0.8, 2])
    assert trigger.door == "gate"
    assert trigger.holds(0.95, 2.05)
    assert not trigger.holds(1.05, 2.05)


SIDES = ("east", "north-east", "north", "north-west", "west", "south-west", "south", "south-east")


def compass(solid: Solid) -> str:
    """Where a wall is, seen from the origin."""
    return SIDES[round(math.atan2(solid.pose.y_m, solid.pose.x_m) / (math.pi / 4)) % 8]


@pytest.mark.parametrize("yaw", [0.0, 0.3, 0.75 * math.pi, -math.pi / 2, 6.0])
@pytest.mark.parametrize(("kind", "count"), [("rectangle", 4), ("octagon", 8)])
def test_the_walls_of_a_ground_are_called_by_where_they_are(kind: str, count: int, yaw: float) -> None:
    walls = built(kind, name="ground", yaw_rad=yaw).solids
    assert len({wall.name for wall in walls}) == len(walls) == count
    assert [wall.name for wall in walls] == [f"{compass(wall)} wall" for wall in walls]
    named = built(kind, name="yard", yaw_rad=yaw).solids
    assert [wall.name for wall in named] == [f"yard {wall.name}" for wall in walls]
