"""Every playground that is shipped: it loads, it fits the schema, and it is what its name promises."""

from __future__ import annotations

import dataclasses
import itertools
import json
import math
import re
from pathlib import Path
from typing import Any, cast

import jsonschema
import pytest

from aseba_vm.languages import LANGUAGES
from thymio_sim_ros.device.programs.program import load_program
from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.sim.commands import MotorTargets, MoveRobot
from thymio_sim_ros.sim.ground.sampling import Ground
from thymio_sim_ros.sim.model import robot_constants
from thymio_sim_ros.sim.model.geometry import Point, Pose, convex_hulls_overlap
from thymio_sim_ros.sim.model.primitives import Box, Disc, Print
from thymio_sim_ros.sim.playground import reader
from thymio_sim_ros.sim.playground.reader import Playground
from thymio_sim_ros.sim.shapes import all_shapes
from thymio_sim_ros.sim.shapes.track import Track
from thymio_sim_ros.sim.world import World
from thymio_sim_ros.testing import Classroom, no_contact

FOLDER = Path(__file__).parents[1] / "playgrounds"
SCHEMA = FOLDER / "playground.schema.json"
SHIPPED = sorted(path for path in FOLDER.glob("*.json") if path != SCHEMA)


COMPLETE = ("de", "fr", "it")
"""Languages of every title; a title may have more."""


def loaded(name: str) -> Playground:
    return reader.load(FOLDER / f"{name}.json")


def steps(world: World, seconds: float) -> None:
    for _ in range(round(seconds * 100)):
        world.step()


def test_their_names_stay_as_they_are() -> None:
    assert [path.stem for path in SHIPPED] == [
        "arena", "base", "borderless", "calibration", "classroom", "desk", "gate", "line", "line_eight", "line_gaps",
        "line_gradient", "maze", "obstacle", "table", "turtlebot3", "turtlesim", "two_robots",
    ]  # fmt: skip


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_a_shipped_playground_loads_and_runs(path: Path) -> None:
    world = World(reader.load(path))
    world.step()
    assert world.robots


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_a_shipped_playground_has_a_title_and_a_description(path: Path) -> None:
    shown = reader.headline(path)
    assert shown.title
    assert shown.description.endswith(".")
    spoken = [language for language, _ in shown.translations]
    assert [language for language in spoken if language in COMPLETE] == list(COMPLETE)
    assert set(spoken) <= set(LANGUAGES)
    assert all(text.title and text.description.endswith(".") for _, text in shown.translations)


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_a_shipped_playground_leaves_nothing_to_remark(path: Path) -> None:
    assert reader.load(path).notes == ()


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_a_shipped_playground_fits_the_published_schema(path: Path) -> None:
    jsonschema.validate(json.loads(path.read_text()), json.loads(SCHEMA.read_text()))


def test_the_schema_is_a_valid_one() -> None:
    jsonschema.Draft202012Validator.check_schema(json.loads(SCHEMA.read_text()))


def test_the_published_schema_is_the_one_of_the_shapes() -> None:
    assert json.loads(SCHEMA.read_text()) == reader.schema()


def test_the_schema_refuses_what_the_loader_refuses() -> None:
    wrong = {"format": 1, "title": "x", "shapes": [{"kind": "cylinder", "radius": 1}]}
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(wrong, json.loads(SCHEMA.read_text()))


def test_base_is_a_metre_square_that_is_free_inside_0_98() -> None:
    world = loaded("base")
    inner = [min(abs(x) for x, _ in wall.vertices) for wall in world.solids if abs(wall.pose.x_m) > 0.1]
    assert inner == pytest.approx([0.49, 0.49])
    assert {wall.height_m for wall in world.solids} == {0.12}


def test_borderless_has_a_track_of_1_31_m_that_ends_before_the_edge_and_no_walls() -> None:
    world = loaded("borderless")
    (points,) = (named.shape.points_m for named in world.shapes if isinstance(named.shape, Track))
    length = sum(math.dist(a, b) for a, b in itertools.pairwise(points))
    apothem = (1 + math.sqrt(2)) / 2
    to_edge = apothem - (points[-1][0] - points[-1][1]) / math.sqrt(2)
    assert length == pytest.approx(1.31, abs=0.01)
    assert to_edge == pytest.approx(0.019, abs=0.001)
    assert world.solids == ()


def test_obstacle_has_24_cylinders_and_a_track_of_6_88_m() -> None:
    world = loaded("obstacle")
    (points,) = (named.shape.points_m for named in world.shapes if isinstance(named.shape, Track))
    discs = [solid for solid in world.solids if isinstance(solid.outline, Disc)]
    assert sum(math.dist(a, b) for a, b in itertools.pairwise(points)) == pytest.approx(6.88, abs=0.01)
    assert len(discs) == 24
    assert len(world.solids) == 24 + 8 + 3


def test_line_is_black_40_mm_wide_and_never_tighter_than_20_cm() -> None:
    world = loaded("line")
    (track,) = (named.shape for named in world.shapes if isinstance(named.shape, Track))
    assert (track.closed, track.color, track.width_m) == (True, "#000000", 0.04)
    assert track.corner_radius_m >= 0.2


def test_on_the_desk_the_explorer_drives_about_and_takes_no_tape_for_an_edge() -> None:
    engine = Engine(loaded("desk"), behaviour="explorer")
    robot = engine.world.robots["thymio"]
    fields = set()
    for _ in range(600):
        engine.run(0.1)
        fields.add((round(robot.pose.x_m, 1), round(robot.pose.y_m, 1)))
    assert len(fields) >= 12


@pytest.mark.parametrize("name", ["desk", "line", "line_eight", "line_gaps", "line_gradient", "classroom"])
def test_robots_start_with_both_ground_sensors_on_the_line(name: str) -> None:
    world = loaded(name)
    ground = Ground(world.floors, world.paints)
    seen = [
        ground.sample(*robot.pose.place(place)).reflectance
        for robot in world.robots
        for place in robot_constants.GROUND_SENSORS
    ]
    assert max(seen) < 0.3


def test_the_soft_line_gets_steadily_brighter_to_both_sides() -> None:
    world = loaded("line_gradient")
    assert [type(mark) for mark in world.paints] == [Print]
    ground = Ground(world.floors, world.paints)
    for side in (1, -1):
        grays = [ground.sample(0.0, -0.38 + side * step * 0.005).reflectance for step in range(2, 13)]
        assert grays == sorted(grays)
        assert (grays[0] < 0.2, grays[-1] > 0.95) == (True, True)


def test_calibration_has_eleven_greys_in_equal_steps() -> None:
    world = loaded("calibration")
    ground = Ground(world.floors, world.paints)
    grays = [ground.sample(-0.5 + 0.1 * step, 0.25).reflectance for step in range(11)]
    assert grays == pytest.approx([step / 10 for step in range(11)], abs=0.002)


def test_calibration_has_six_colors_and_stripes_of_known_width() -> None:
    world = loaded("calibration")
    ground = Ground(world.floors, world.paints)
    colors = [ground.color_at(-0.5 + 0.1 * step, -0.05) for step in range(6)]
    assert colors == [(1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 1, 1), (0, 0, 1), (1, 0, 1)]
    dark = [ground.color_at(0.1 + step * 0.0001, -0.05) == (0.0, 0.0, 0.0) for step in range(4500)]
    runs = [len(list(group)) / 10 for is_dark, group in itertools.groupby(dark) if is_dark]
    assert runs == pytest.approx([2, 5, 10, 20, 40], abs=1)


def test_the_goal_of_the_maze_can_be_reached_from_the_start() -> None:
    world = loaded("maze")
    cells = {(x, y) for x in range(6) for y in range(6)}

    def middle(cell: tuple[int, int]) -> Point:
        return (-0.5 + 0.2 * cell[0], -0.5 + 0.2 * cell[1])

    def is_open(one: Point, other: Point) -> bool:
        between = Pose((one[0] + other[0]) / 2, (one[1] + other[1]) / 2, 0.0)
        passage = between.place_all(Box(0.12, 0.12).vertices)
        return not any(convex_hulls_overlap(passage, wall.vertices) for wall in world.solids)

    reached, waiting = {(0, 0)}, [(0, 0)]
    while waiting:
        x, y = waiting.pop()
        for cell in ((x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1)):
            if cell in cells - reached and is_open(middle((x, y)), middle(cell)):
                reached.add(cell)
                waiting.append(cell)
    assert reached == cells
    assert world.robots[0].pose.place((0.0, 0.0)) == pytest.approx(middle((0, 0)))


def test_the_arena_has_light_and_heavy_things_to_push_and_posts_that_stay() -> None:
    inside = [solid for solid in loaded("arena").solids if not solid.name.endswith(" wall")]
    masses = [solid.load.mass_kg for solid in inside if solid.load is not None]
    assert (len(masses), min(masses), max(masses)) == (10, 0.02, 0.35)
    assert len(inside) - len(masses) == 4


def test_two_robots_face_each_other_with_nothing_between() -> None:
    world = World(loaded("two_robots"))
    one, other = world.robots.values()
    assert one.pose.place((0.5, 0.0)) == pytest.approx((other.pose.x_m, other.pose.y_m), abs=1e-4)
    assert other.pose.place((0.5, 0.0)) == pytest.approx((one.pose.x_m, one.pose.y_m), abs=1e-4)


def test_the_classroom_has_twenty_robots() -> None:
    assert len(loaded("classroom").robots) == 20


def test_the_table_has_no_border() -> None:
    assert all(solid.load is not None for solid in loaded("table").solids)


def test_on_the_table_a_robot_falls_over_the_edge() -> None:
    world = World(loaded("table"))
    world.post("thymio", MotorTargets(400, 400))
    steps(world, 15.0)
    assert world.robots["thymio"].is_fallen


def test_in_the_arena_a_robot_pushes_what_is_light_and_stops_at_a_post() -> None:
    start = {"can_1": Pose(-0.3, 0.05, 0.0), "post_1": Pose(-0.4, -0.6, 0.0)}
    found = {}
    for name, pose in start.items():
        world = World(loaded("arena"))
        world.post("thymio", MoveRobot(pose.x_m, pose.y_m, pose.yaw_rad))
        world.post("thymio", MotorTargets(200, 200))
        steps(world, 4.0)
        found[name] = world.robots["thymio"].pose.x_m - pose.x_m
    assert found["can_1"] > 0.2
    assert found["post_1"] < 0.05


def test_the_two_robots_hear_each_other() -> None:
    text = "var heard\ncall prox.comm.enable(1)\nprox.comm.tx = {}\nonevent prox.comm\nheard = prox.comm.rx"
    programs = {name: load_program(text.format(number), name) for name, number in (("red", 5), ("blue", 7))}
    engine = Engine(loaded("two_robots"), programs)
    engine.run(2.0)
    assert {name: device.variables.get("heard") for name, device in engine.devices.items()} == {
        "red": (7,),
        "blue": (5,),
    }


def test_the_gate_opens_before_its_plates_only() -> None:
    opened = {}
    for x_m in (-0.5, -0.3, 0.3):
        world = World(loaded("gate"))
        world.post("thymio", MoveRobot(x_m, -0.25, math.pi / 2))
        steps(world, 3.0)
        (door,) = world.snapshot().objects
        opened[x_m] = door.pose.y_m > 0.2
    assert opened == {-0.5: False, -0.3: True, 0.3: True}


def test_the_gate_has_a_door_and_a_plate_on_either_side() -> None:
    world = loaded("gate")
    assert [solid.name for solid in world.solids if solid.slide is not None] == ["door"]
    assert [trigger.door for trigger in world.triggers] == ["door", "door"]
    assert [trigger.holds(x, -0.25) for trigger, x in zip(world.triggers, (-0.3, 0.3), strict=True)] == [True, True]


def test_the_example_of_the_readme_loads() -> None:
    text = (FOLDER / "README.md").read_text()
    example = text.split("```json")[1].split("```")[0]
    assert reader.loads(example, "README.md").title == "My square"


def test_the_readme_lists_every_playground() -> None:
    text = (FOLDER / "README.md").read_text()
    assert all(f"`{path.name}`" in text for path in SHIPPED)


def test_the_readme_explains_every_field_of_every_kind() -> None:
    rows = dict(re.findall(r"^\| `(\w+)` \| (.*) \|$", (FOLDER / "README.md").read_text(), re.MULTILINE))
    for kind in all_shapes():
        fields = {field.name for field in dataclasses.fields(cast("Any", kind.form))}
        assert set(re.findall(r"`(\w+)`", rows[kind.name])) == fields


def test_the_readme_states_the_defaults() -> None:
    rows = dict(re.findall(r"^\| `(\w+)` \| (.*) \|$", (FOLDER / "README.md").read_text(), re.MULTILINE))
    for kind in all_shapes():
        for field in dataclasses.fields(cast("Any", kind.form)):
            if isinstance(field.default, float) and field.name != "yaw_rad":
                assert f"`{field.name}` ({field.default:g}" in rows[kind.name]


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_what_a_robot_can_touch_has_a_name_of_its_own(path: Path) -> None:
    solids = loaded(path.stem).solids
    assert not {solid.name for solid in solids} & {floor.name for floor in loaded(path.stem).floors}
    names = [solid.name for solid in solids if solid.name != "u_figure"]
    assert len(set(names)) == len(names)


def test_a_robot_that_drives_against_the_border_touches_a_wall_and_not_the_ground() -> None:
    room = Classroom("base", "motor.left.target = 200\nmotor.right.target = 200", noise=False)
    (thymio,) = room
    room.until(lambda: thymio.touching, 60.0)
    assert repr(no_contact(thymio)).startswith("thymio touched east wall at ")
