"""Aseba's XML playgrounds (docs/spec/playground-formats.md section 1): element beside shape."""

from __future__ import annotations

import gzip
import math
from pathlib import Path
from typing import Any

import pytest

from tests.sim.builders import make
from tests.sim.images import BLACK, WHITE, png
from thymio_sim_ros.sim.commands import MotorTargets
from thymio_sim_ros.sim.formats import xml_tree
from thymio_sim_ros.sim.ground.sampling import Ground
from thymio_sim_ros.sim.model.fields import FieldError
from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.model.primitives import Disc
from thymio_sim_ros.sim.playground import format_detection, reader
from thymio_sim_ros.sim.playground.importers import Conversion, aseba
from thymio_sim_ros.sim.playground.reader import PlaygroundError
from thymio_sim_ros.sim.world import World

COLORS = '<color name="white" r="1" g="1" b="1"/><color name="orange" r="1.0" g="0.5" b="0"/>'
WORLD = '<world w="100" h="60" color="white"/>'
ROBOT = '<robot x="50" y="30"/>'


def text(body: str) -> str:
    return f"<!DOCTYPE aseba-playground>\n<aseba-playground>{COLORS}\n{body}\n</aseba-playground>"


def converted(body: str, world: str = WORLD) -> Conversion:
    return aseba.convert(xml_tree.parse(text(world + body)), "mine")


def shape(body: str) -> dict[str, Any]:
    return converted(body).shapes[1]


def _proximity(world: World) -> list[tuple[int, ...]]:
    """What the sensors that see around count in the next tick."""
    return [reading.words for _, sensor, reading in world.step().readings if sensor == "proximity"]


def refused(body: str, world: str = WORLD) -> FieldError:
    with pytest.raises(FieldError) as caught:
        converted(body, world)
    return caught.value


def test_the_world_is_a_rectangle_whose_walls_stand_outside_its_border() -> None:
    loaded = reader.loads(text(WORLD), "mine.playground")
    inner_x = sorted(wall.pose.x_m for wall in loaded.solids if wall.pose.y_m == pytest.approx(0.3))
    inner_y = sorted(wall.pose.y_m for wall in loaded.solids if wall.pose.x_m == pytest.approx(0.5))
    assert inner_x == pytest.approx([-0.01, 1.01])
    assert inner_y == pytest.approx([-0.01, 0.61])
    assert loaded.floors[0].color == (1.0, 1.0, 1.0)


def test_a_wall_is_a_box_of_centimetres() -> None:
    found = shape('<wall x="20" y="30" l1="10" l2="2" h="5" angle="0.5" color="orange"/>')
    assert found == {
        "kind": "box", "name": "wall", "x_m": 0.2, "y_m": 0.3, "size_x_m": 0.1, "size_y_m": 0.02, "height_m": 0.05,
        "yaw_rad": 0.5, "color": "#ff8000",
    }  # fmt: skip


def test_a_mass_makes_it_movable_in_proportion_to_the_robot() -> None:
    assert shape('<wall x="20" y="30" l1="10" l2="2" h="5" mass="200" color="orange"/>')["mass_kg"] == 0.27
    assert shape('<cylinder x="20" y="30" r="2" h="5" mass="0" color="orange"/>')["mass_kg"] == 0.001
    assert shape('<cylinder x="20" y="30" r="2" h="5" mass="1e9" color="orange"/>')["mass_kg"] == 1000.0
    assert "mass_kg" not in shape('<cylinder x="20" y="30" r="2" h="5" mass="-1" color="orange"/>')


@pytest.mark.parametrize("height", ["", 'h="0"', 'h="0.01"'])
def test_an_object_without_a_height_stands_in_the_way_unseen(height: str) -> None:
    things = f'<wall x="70" y="30" l1="2" l2="20" {height} color="white"/>'
    things += f'<cylinder x="20" y="30" r="2" {height} color="white"/>'
    things += f'<door closedX="70" closedY="5" openedX="70" openedY="5" l1="2" l2="2" {height} color="white"/>'
    world = World(reader.loads(text(WORLD + things + ROBOT), "mine"))
    world.post("thymio_0", MotorTargets(500, 500))
    seen = [words for _ in range(200) for words in _proximity(world)]
    assert max(map(max, seen)) == 0
    assert world.robots["thymio_0"].pose.x_m == pytest.approx(0.69 - 0.08, abs=0.003)


def test_a_cylinder_is_a_cylinder() -> None:
    loaded = reader.loads(text(WORLD + '<cylinder x="20" y="30" r="2" h="5" color="orange"/>'), "mine")
    (disc,) = (solid for solid in loaded.solids if isinstance(solid.outline, Disc))
    assert (disc.pose, disc.outline, disc.height_m) == (Pose(0.2, 0.3, 0.0), Disc(0.02), 0.05)


def test_an_activation_may_name_a_door_and_an_area_that_come_later() -> None:
    found = converted(
        '<activation x="20" y="30" l1="5" l2="4" area="a" door="d"/>'
        '<door name="d" closedX="60" closedY="30" openedX="70" openedY="30" l1="10" l2="1" h="10" moveDuration="2" '
        'color="orange"/><area name="a"><point x="-5" y="-5"/><point x="5" y="-5"/><point x="0" y="5"/></area>'
    )
    assert found.shapes[1:] == [
        {
            "kind": "door", "name": "d", "closed_x_m": 0.6, "closed_y_m": 0.3, "opened_x_m": 0.7, "opened_y_m": 0.3,
            "size_x_m": 0.1, "size_y_m": 0.01, "height_m": 0.1, "move_s": 2.0, "color": "#ff8000",
        },
        {
            "kind": "activation", "name": "activation", "x_m": 0.2, "y_m": 0.3, "size_x_m": 0.05, "size_y_m": 0.04,
            "area_m": [[-0.05, -0.05], [0.05, -0.05], [0.0, 0.05]], "door": "d",
        },
    ]  # fmt: skip


def test_robots_start_where_they_stand_with_ros_names() -> None:
    found = converted('<robot x="50" y="30" angle="7" name="Thymio II"/><robot x="20" y="30"/>').robots
    assert found == [
        {"name": "thymio_ii", "x_m": 0.5, "y_m": 0.3, "yaw_rad": round(7 - 2 * math.pi, 9)},
        {"name": "thymio_1", "x_m": 0.2, "y_m": 0.3, "yaw_rad": 0.0},
    ]


def test_the_texture_covers_the_world_with_its_first_row_on_the_far_side() -> None:
    picture = png([[WHITE] * 10] * 4 + [[BLACK] * 10] * 2 + [[WHITE] * 10] * 14)
    found = format_detection.read_source(
        text('<world w="100" h="100" color="white" groundTexture="ground.png"/>').encode(), "mine", lambda name: picture
    )
    assert found.beside("ground.png") == picture
    members = found.data
    assert isinstance(members, dict)
    assert members["shapes"][1] == {
        "kind": "picture", "name": "ground_picture", "image": "ground.png",
        "x_m": 0.5, "y_m": 0.5, "size_x_m": 1.0, "size_y_m": 1.0,
    }  # fmt: skip


def test_the_description_is_the_english_one() -> None:
    body = '<description lang="fr">Un labyrinthe</description><description lang="en">A\n maze.</description>'
    found = converted(body)
    assert found.description == "A maze."
    assert found.translations == {"fr": {"title": "mine", "description": "Un labyrinthe"}}


def test_of_two_descriptions_in_one_language_the_first_counts() -> None:
    body = "".join(f'<description lang="en">{text}</description>' for text in ("First.", "Second."))
    assert converted(body).description == "First."


def test_a_color_beyond_the_brightest_is_the_brightest() -> None:
    found = converted('<color name="odd" r="2" g="-1" b="0.5"/><cylinder x="20" y="30" r="2" h="5" color="odd"/>')
    assert found.shapes[-1]["color"] == "#ff0080"


@pytest.mark.parametrize("duration", ["", 'moveDuration="0"', 'moveDuration="-3"'])
def test_a_door_without_a_time_opens_at_once(duration: str) -> None:
    found = shape(
        f'<door name="d" closedX="60" closedY="30" openedX="70" openedY="30" l1="10" l2="1" h="10" {duration}'
        ' color="orange"/>'
    )
    assert found["move_s"] == 0.01


def test_languages_are_read_as_people_write_them_and_others_are_told() -> None:
    body = "".join(f'<description lang="{lang}">{lang or "none"}</description>' for lang in ("", "de_CH", "C", "en_US"))
    found = converted(body)
    assert found.description == "none"
    assert {language: text["description"] for language, text in found.translations.items()} == {
        "de-ch": "de_CH",
        "en-us": "en_US",
    }
    assert found.notes == ["line 3: <description> skipped: 'c' is not a language code"]
    assert dict(reader.loads(text(WORLD + body + ROBOT), "mine").translations)["de-ch"].description == "de_CH"


@pytest.mark.parametrize("name", ["a\tb.playground", "caf\udce9.playground", "\t"])
def test_a_file_of_a_strange_name_has_a_title(name: str) -> None:
    found = reader.loads(text(WORLD + ROBOT), name)
    assert found.title.isprintable()
    assert found.title


@pytest.mark.parametrize(("size", "found"), [('w="-1.5" h="60"', "'-1.5'"), ('w="100"', "''")])
def test_a_world_without_an_area_is_refused(size: str, found: str) -> None:
    error = refused("", f'<world {size} color="white"/>')
    assert (error.found, error.expected) == (found, "a number above 0")


@pytest.mark.parametrize(
    ("body", "note"),
    [
        ('<robot type="e-puck" x="50" y="30"/>', "<robot> skipped: robot type 'e-puck'"),
        ('<e-puck x="50" y="30"/>', "<e-puck> skipped: robot type 'e-puck'"),
        ('<robot x="50" y="30" port="33333"/>', "<robot>: port skipped"),
        ('<thymio2 x="50" y="30" port="33333"/>', "<thymio2>: port skipped"),
        ('<robot x="50" y="30" nodeId="2"/>', "<robot>: nodeId skipped"),
        ('<feeder x="5" y="5"/>', "<feeder> skipped"),
        ('<process command=":asebahttp"/>', "<process> skipped"),
        ('<camera x="5"/>', "<camera> skipped"),
        ("<teapot/>", "<teapot> skipped: unknown element"),
        ('<cylinder x="20" y="30" r="2" h="5" color="mauve"/>', "color 'mauve' is not declared"),
    ],
)
def test_what_cannot_be_expressed_is_told_with_its_line(body: str, note: str) -> None:
    (found,) = converted(body).notes
    assert found.startswith("line 3: ")
    assert note in found


def test_robots_of_aseba_1_5_are_elements_of_their_type() -> None:
    old = converted('<thymio2 x="50" y="40" angle="1.57"/><robot x="10" y="10"/><thymio2 x="70" y="20" name="Second"/>')
    new = converted(
        '<robot type="thymio2" x="50" y="40" angle="1.57"/><robot x="10" y="10"/><robot x="70" y="20" name="Second"/>'
    )
    assert old.robots == new.robots
    assert [robot["name"] for robot in old.robots] == ["thymio_0", "thymio_1", "second"]


def test_remarks_come_in_the_order_of_the_lines() -> None:
    notes = converted('\n<camera/>\n<feeder/>\n<robot x="50" y="30" port="1"/>\n<teapot/>').notes
    assert [note.partition(":")[0] for note in notes] == ["line 4", "line 5", "line 6", "line 7"]


def test_metadata_is_passed_over_without_a_word() -> None:
    assert converted('<author name="A"/><thanks name="B"/><externalLink name="C"/>').notes == []


@pytest.mark.parametrize(
    ("body", "key", "found"),
    [
        ('<wall x="a" y="0"/>', "line 3: <wall> x", "'a'"),
        ('<wall x="1_0" y="0"/>', "line 3: <wall> x", "'1_0'"),
        ('<wall x="nan" y="0"/>', "line 3: <wall> x", "'nan'"),
        ('<robot x="1e999" y="0"/>', "line 3: <robot> x", "'1e999'"),
        ('<activation area="b" door="d"/>', "line 3: <activation>", "the area 'b'"),
        ('<area name="a"/><activation area="a" door="d"/>', "line 3: <activation>", "the door 'd'"),
        (WORLD, "line 2", "2 <world> elements"),
    ],
)
def test_what_is_wrong_is_refused_with_its_line(body: str, key: str, found: str) -> None:
    error = refused(body)
    assert (error.key, error.found) == (key, found)


def test_a_playground_without_a_world_is_refused() -> None:
    assert refused("", world="").found == "0 <world> elements"


def test_what_our_format_refuses_is_located_in_the_original() -> None:
    with pytest.raises(PlaygroundError) as caught:
        reader.loads(text(WORLD + "\n<cylinder x='20' y='30' r='0' h='5' color='white'/>"), "mine.playground")
    assert str(caught.value) == (
        "mine.playground: line 4: <cylinder> (shapes[1].radius_m): found 0.0, expected a number of m from 0.001 to 100"
    )


def test_a_robot_that_starts_inside_something_is_set_free_with_a_notice() -> None:
    body = WORLD + "\n<wall x='50' y='30' l1='10' l2='10' h='5' color='white' name='block'/>" + ROBOT
    loaded = reader.loads(text(body), "mine.playground")
    (robot,) = loaded.robots
    assert loaded.notes == (
        f"robots[0]: 'thymio_0' starts inside 'block', moved to {robot.x_m:.3f}, {robot.y_m:.3f} m",
    )
    assert 0.07 < math.dist((robot.x_m, robot.y_m), (0.5, 0.3)) < 0.14
    assert robot.yaw_rad == 0.0
    assert reader.loads(text(body), "mine.playground") == loaded
    world = World(loaded)
    world.step()


def test_a_robot_in_the_border_is_set_free_inside_it() -> None:
    loaded = reader.loads(text(WORLD + "\n<robot x='0' y='0'/><robot x='100' y='60' angle='3'/>"), "mine")
    assert len(loaded.notes) == 2
    assert all(0.0 < robot.x_m < 1.0 and 0.0 < robot.y_m < 0.6 for robot in loaded.robots)


def test_of_two_robots_in_one_place_the_second_is_moved() -> None:
    loaded = reader.loads(text(WORLD + ROBOT + ROBOT), "mine")
    first, second = loaded.robots
    assert (first.x_m, first.y_m) == (0.5, 0.3)
    assert "'thymio_1' starts inside 'thymio_0'" in loaded.notes[0]
    assert math.dist((first.x_m, first.y_m), (second.x_m, second.y_m)) > 0.1


def test_a_robot_that_cannot_be_set_free_is_located_in_the_original() -> None:
    full = "\n<wall x='50' y='30' l1='98' l2='58' h='5' color='white'/>"
    with pytest.raises(PlaygroundError, match=r"line 4: <robot> \(robots\[0\]\): found 'thymio_0' inside 'wall'"):
        reader.loads(text(WORLD + full + ROBOT), "mine.playground")


def test_named_characters_of_html_are_read() -> None:
    body = "<description lang='de'>&uuml;</description><description>a &ndash; b&nbsp;&Eacute;&amp;&lt;</description>"
    loaded = reader.loads(text(WORLD + body), "mine.playground")
    assert loaded.description == "a – b É&<"
    assert loaded.translations[0][1].description == "ü"


@pytest.mark.parametrize(
    "declared",
    [
        '<!ENTITY ndash "x">',
        '<!ENTITY a "aaaa"><!ENTITY b "&a;&a;">',
        '<!ENTITY a SYSTEM "file:///etc/passwd">',
        '<!ENTITY % a SYSTEM "http://127.0.0.1/">%a;',
    ],
)
def test_declared_entities_are_refused_as_before(declared: str) -> None:
    content = text(WORLD + "<description>&ndash;&a;</description>").replace(
        "<!DOCTYPE aseba-playground>", f"<!DOCTYPE aseba-playground [{declared}]>"
    )
    with pytest.raises(PlaygroundError, match=r"no entity declarations|XML|self-contained"):
        reader.loads(content, "mine.playground")


def test_an_unknown_entity_is_refused_and_comments_are_left_alone() -> None:
    with pytest.raises(PlaygroundError, match="undefined entity"):
        reader.loads(text(WORLD + "<description>&nothing;</description>"), "mine")
    assert reader.loads(text(WORLD + "<!-- &nothing; &ndash; --><description>a</description>"), "mine").description


SVG = b'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 10 6"><rect width="5" height="6" fill="black"/></svg>'


def test_a_packed_svg_is_the_ground(tmp_path: Path) -> None:
    body = WORLD.replace("/>", ' groundTexture="map.{}"/>')
    (tmp_path / "map.svg").write_bytes(SVG)
    (tmp_path / "map.svgz").write_bytes(gzip.compress(SVG))
    for ending in ("svg", "svgz"):
        (tmp_path / "maze.playground").write_text(text(body.format(ending)))
        loaded = reader.load(tmp_path / "maze.playground")
        ground = Ground(loaded.floors, loaded.paints)
        assert ground.sample(0.2, 0.3) != ground.sample(0.8, 0.3)
        samples = ground.sample(0.2, 0.3), ground.sample(0.8, 0.3)
        assert [round(sample.reflectance) for sample in samples] == [0, 1]


@pytest.mark.parametrize(
    ("data", "found"),
    [
        (b"no gzip", "cannot be decompressed"),
        (gzip.compress(SVG)[:-12], "truncated"),
        (gzip.compress(b" " * 300_000_000), "an image of at most"),
    ],
)
def test_a_broken_or_endless_packed_svg_is_refused(data: bytes, found: str, tmp_path: Path) -> None:
    (tmp_path / "map.svgz").write_bytes(data)
    (tmp_path / "maze.playground").write_text(text(WORLD.replace("/>", ' groundTexture="map.svgz"/>')))
    with pytest.raises(PlaygroundError, match=found):
        reader.load(tmp_path / "maze.playground")


def test_another_xml_is_refused() -> None:
    with pytest.raises(PlaygroundError, match="found <html>, expected <aseba-playground>"):
        reader.loads("<html/>", "mine")


def test_a_converted_world_is_an_ordinary_one() -> None:
    loaded = reader.loads(text(WORLD + ROBOT), "mine")
    again = make(
        [{"kind": "rectangle", "name": "ground", "x_m": 0.5, "y_m": 0.3, "size_x_m": 1.02, "size_y_m": 0.62,
          "color": "#ffffff", "walls": {"height_m": 0.1, "thickness_m": 0.02}}],
        [{"name": "thymio_0", "x_m": 0.5, "y_m": 0.3}],
    )  # fmt: skip
    assert (loaded.solids, loaded.floors, loaded.robots) == (again.solids, again.floors, again.robots)


def test_movable_objects_and_doors_come_to_life() -> None:
    body = (
        '<wall x="20" y="20" l1="6" l2="6" h="5" mass="20" color="orange"/>'
        '<cylinder x="40" y="20" r="3" h="5" mass="20" color="orange"/>'
        '<area name="a"><point x="-5" y="-5"/><point x="5" y="-5"/><point x="5" y="15"/><point x="-5" y="15"/></area>'
        '<door name="d" closedX="60" closedY="30" openedX="70" openedY="30" l1="1" l2="10" h="10" moveDuration="2" '
        'color="orange"/><activation x="20" y="50" l1="5" l2="2" area="a" door="d"/><robot x="80" y="50"/>'
    )
    loaded = reader.loads(text(WORLD + body), "mine.playground")
    loads = {solid.name: solid.load.mass_kg for solid in loaded.solids if solid.load is not None}
    assert loads == pytest.approx({"wall": 0.027, "cylinder": 0.027})
    (door,) = (solid for solid in loaded.solids if solid.slide is not None)
    assert door.slide is not None
    assert (door.pose, door.slide.opened, door.slide.duration_s) == (Pose(0.6, 0.3, 0.0), Pose(0.7, 0.3, 0.0), 2.0)
    (trigger,) = loaded.triggers
    assert (trigger.door, trigger.holds(0.2, 0.6), trigger.holds(0.2, 0.4)) == ("d", True, False)
    World(loaded).step()


def test_a_band_of_the_texture_lies_where_the_reference_has_it(tmp_path: Path) -> None:
    """docs/spec/playground-formats.md section 1.2: rows 40 to 59 of 200 from the top are y = 70 to 80 cm of a world of
    a meter."""
    (tmp_path / "band.png").write_bytes(png([[BLACK if 40 <= row < 60 else WHITE] * 4 for row in range(200)]))
    path = tmp_path / "band.playground"
    path.write_text(text('<world w="100" h="100" color="orange" groundTexture="band.png"/>'))
    loaded = reader.load(path)
    ground = Ground(loaded.floors, loaded.paints)
    dark = [step for step in range(100) if ground.color_at(0.5, step / 100 + 0.005) == (0.0, 0.0, 0.0)]
    assert dark == list(range(70, 80))
