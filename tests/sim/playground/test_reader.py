"""Loading: what is accepted, and how precisely the rest is refused."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from tests.sim.builders import FLOOR, ROBOT, box, make
from tests.sim.images import BLACK, WHITE, png, png_uri
from thymio_sim_ros.sim.formats import image_io
from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.playground import reader
from thymio_sim_ros.sim.playground.reader import MAX_BYTES, PlaygroundError

GOOD: dict[str, Any] = {"format": 1, "title": "A title", "description": "Words", "shapes": [FLOOR], "robots": [ROBOT]}


def refused(text: str) -> PlaygroundError:
    with pytest.raises(PlaygroundError) as caught:
        reader.loads(text, "try.json")
    return caught.value


def refused_with(**changes: Any) -> PlaygroundError:
    return refused(json.dumps({**GOOD, **changes}))


def test_a_good_file_gives_a_frozen_playground() -> None:
    loaded = reader.loads(json.dumps(GOOD), "good")
    assert (loaded.name, loaded.title, loaded.description) == ("good", "A title", "Words")
    assert loaded.robots[0].pose == Pose(0.0, 0.0, 0.0)
    assert [named.kind for named in loaded.shapes] == ["rectangle"]


def test_a_file_is_named_after_its_stem(tmp_path: Path) -> None:
    path = tmp_path / "mine.json"
    path.write_text(json.dumps(GOOD))
    assert reader.load(path).name == "mine"


def test_a_missing_file_is_refused_with_its_path(tmp_path: Path) -> None:
    with pytest.raises(PlaygroundError, match=r"nowhere\.json: found No such file") as caught:
        reader.load(tmp_path / "nowhere.json")
    assert caught.value.path == str(tmp_path / "nowhere.json")


def test_a_file_that_is_not_utf_8_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "bytes.json"
    path.write_bytes(b'{"title": "\xff"}')
    with pytest.raises(PlaygroundError, match="UTF-8"):
        reader.load(path)


def test_an_error_names_file_key_found_and_expected() -> None:
    error = refused_with(shapes=[{**FLOOR, "size_x_m": "wide"}])
    assert (error.path, error.key, error.found) == ("try.json", "shapes[0].size_x_m", "'wide'")
    assert error.expected == "a number of m from 0.001 to 100"
    assert str(error) == "try.json: shapes[0].size_x_m: found 'wide', expected a number of m from 0.001 to 100"


def test_broken_json_is_located() -> None:
    assert refused('{"format": 1,\n "title": }').key == "line 2, column 11"


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"color": "#fff"}, "color"),
        ({"format": 2}, "format"),
        ({"format": True}, "format"),
        ({"title": None}, "title"),
        ({"title": "two\nlines"}, "title"),
        ({"title": "half a pair \ud800"}, "title"),
        ({"$schema": 3}, "$schema"),
        ({"translations": []}, "translations"),
        ({"translations": {"German": {"title": "x"}}}, "translations.German"),
        ({"translations": {"de": {"description": "x"}}}, "translations.de.title"),
        ({"shapes": {}}, "shapes"),
        ({"shapes": [1]}, "shapes[0]"),
        ({"shapes": [{"kind": "pyramid"}]}, "shapes[0].kind"),
        ({"shapes": [{"name": "no_kind"}]}, "shapes[0].kind"),
        ({"shapes": [{**FLOOR, "size_z_m": 1}]}, "shapes[0].size_z_m"),
        ({"shapes": [{**FLOOR, "color": "white"}]}, "shapes[0].color"),
        ({"shapes": [{**FLOOR, "x_m": True}]}, "shapes[0].x_m"),
        ({"shapes": [{**FLOOR, "x_m": 1e9}]}, "shapes[0].x_m"),
        ({"shapes": [{**FLOOR, "size_x_m": 0}]}, "shapes[0].size_x_m"),
        ({"shapes": [{**FLOOR, "walls": {"height": 1}}]}, "shapes[0].walls.height"),
        ({"shapes": [{**FLOOR, "walls": 3}]}, "shapes[0].walls"),
        ({"shapes": [{"kind": "box", "x_m": 0}]}, "shapes[0].y_m"),
        ({"shapes": [FLOOR, FLOOR]}, "shapes[1].name"),
        ({"shapes": [{**FLOOR, "name": "thymio"}]}, "robots[0].name"),
        ({"shapes": [{**FLOOR, "name": "9lives"}]}, "shapes[0].name"),
        ({"robots": [ROBOT, ROBOT]}, "robots[1].name"),
        ({"robots": [{**ROBOT, "name": "my robot"}]}, "robots[0].name"),
        ({"robots": [{**ROBOT, "name": "double__score"}]}, "robots[0].name"),
        ({"robots": [{**ROBOT, "yaw_rad": 7}]}, "robots[0].yaw_rad"),
        ({"robots": [{"name": "lost"}]}, "robots[0].x_m"),
        ({"robots": [{**ROBOT, "name": f"robot{i}"} for i in range(1001)]}, "robots"),
        ({"shapes": [FLOOR] * 1001}, "shapes"),
    ],
)
def test_what_is_wrong_is_refused_at_its_key(changes: dict[str, Any], key: str) -> None:
    assert refused_with(**changes).key == key


@pytest.mark.parametrize(
    ("points", "key"),
    [
        ([[0, 0]], "points_m"),
        ("line", "points_m"),
        ([[0, 0], [1]], "points_m[1]"),
        ([[0, 0], [1, "y"]], "points_m[1][1]"),
        ([[0, 0]] * 1001, "points_m"),
    ],
)
def test_points_are_checked_one_by_one(points: Any, key: str) -> None:
    track = {"kind": "track", "points_m": points, "width_m": 0.04, "color": "#000000"}
    assert refused_with(shapes=[track]).key == f"shapes[0].{key}"


@pytest.mark.parametrize(
    ("points", "radius", "found"),
    [
        ([[0, 0], [0, 0]], 0, "a single place"),
        ([[0, 0], [1, 0], [1, 1]], 0.01, "0.01"),
    ],
)
def test_a_track_that_cannot_be_painted_is_refused(points: Any, radius: float, found: str) -> None:
    track = {"kind": "track", "points_m": points, "width_m": 0.04, "color": "#000000", "closed": True}
    error = refused_with(shapes=[{**track, "corner_radius_m": radius}])
    assert found in error.found


def test_a_playground_of_too_many_parts_is_refused() -> None:
    points = [[index % 2, index / 10] for index in range(500)]
    track = {"kind": "track", "points_m": points, "width_m": 0.04, "color": "#000000", "corner_radius_m": 0.02}
    assert refused_with(shapes=[track]).found == "more than 10000 parts"


def test_corners_that_do_not_fit_their_pieces_are_refused() -> None:
    track = {"kind": "track", "points_m": [[0, 0], [0.1, 0], [0.1, 0.1]], "width_m": 0.04, "color": "#000000"}
    error = refused_with(shapes=[{**track, "corner_radius_m": 0.2}])
    assert (error.key, error.found) == ("shapes[0].corner_radius_m", "0.2")


@pytest.mark.parametrize(
    "text",
    [
        "[]",
        "3",
        "",
        '{"format": NaN}',
        '{"format": 1, "format": 1, "title": "twice"}',
        '{"format": 1, "title": "x", "shapes": ' + "[" * 100_000 + "]" * 100_000 + "}",
        '{"format": 1, "title": "x", "shapes": [{"kind": "cylinder", "x_m": 1e999}]}',
        '{"format": ' + "9" * 5000 + "}",
        " " * (MAX_BYTES + 1),
    ],
)
def test_hostile_text_is_refused_and_nothing_else_happens(text: str) -> None:
    assert refused(text).path == "try.json"


@pytest.mark.parametrize(
    "thing",
    [
        box(0.07, 0.0, 0.05, 0.05),
        box(0.0, 0.0, 0.01, 0.01),
        {"kind": "cylinder", "x_m": 0.1, "y_m": 0, "radius_m": 0.03, "height_m": 0.1, "color": "#808080"},
    ],
)
def test_a_robot_that_starts_inside_something_is_refused(thing: dict[str, Any]) -> None:
    error = refused_with(shapes=[FLOOR, {**thing, "name": "thing"}])
    assert (error.key, error.found) == ("robots[0]", "'thymio' inside 'thing'")


def test_robots_that_start_inside_each_other_are_refused() -> None:
    assert refused_with(robots=[ROBOT, {**ROBOT, "name": "second", "x_m": 0.1}]).key == "robots[1]"


def test_robots_side_by_side_are_accepted() -> None:
    assert len(make([FLOOR], [ROBOT, {**ROBOT, "name": "second", "y_m": 0.12}]).robots) == 2


def test_shapes_without_a_name_are_named_by_kind_and_place() -> None:
    unnamed = {key: value for key, value in FLOOR.items() if key != "name"}
    assert [named.name for named in make([unnamed, {**unnamed, "x_m": 5}]).shapes] == ["rectangle_0", "rectangle_1"]


def test_the_nearest_key_and_kind_are_suggested() -> None:
    assert refused_with(shapes=[{**FLOOR, "sise_x_m": 1.0}]).expected.startswith("'size_x_m' (one of ")
    assert refused_with(shapes=[{"kind": "rectangel"}]).expected.startswith("'rectangle' (one of ")
    assert refused_with(titel="x").expected.startswith("'title' (one of ")


def with_picture(image: str) -> str:
    return json.dumps({**GOOD, "shapes": [FLOOR, {"kind": "picture", "image": image, "size_x_m": 0.2}]})


def test_an_image_beside_the_file_becomes_part_of_the_playground(tmp_path: Path) -> None:
    (tmp_path / "pictures").mkdir()
    (tmp_path / "pictures" / "track.png").write_bytes(png([[WHITE, BLACK]]))
    path = tmp_path / "mine.json"
    path.write_text(with_picture("pictures/track.png"))
    beside, inside = reader.load(path), reader.loads(with_picture(png_uri([[WHITE, BLACK]])), "mine")
    assert beside == inside


@pytest.mark.parametrize(
    ("image", "expected"),
    [
        ("track.gif", "a file that ends in"),
        ("nowhere.png", "a file in the playground's folder"),
        ("../secret.png", "a file in the playground's folder"),
        ("/etc/secret.png", "a file in the playground's folder"),
        ("..\\secret.png", "a file in the playground's folder"),
        ("link.png", "a file in the playground's folder"),
        ("a\0b.png", "a file in the playground's folder"),
        ("", "a file that ends in"),
    ],
)
def test_an_image_elsewhere_is_refused(tmp_path: Path, image: str, expected: str) -> None:
    (tmp_path / "secret.png").write_bytes(png([[WHITE]]))
    folder = tmp_path / "playgrounds"
    folder.mkdir()
    (folder / "link.png").symlink_to(tmp_path / "secret.png")
    path = folder / "mine.json"
    path.write_text(with_picture(image))
    with pytest.raises(PlaygroundError) as caught:
        reader.load(path)
    assert (caught.value.key, expected in caught.value.expected) == ("shapes[1].image", True)


def test_a_text_has_no_file_beside_it() -> None:
    error = refused(with_picture("track.png"))
    assert (error.key, error.found) == ("shapes[1].image", "the file 'track.png'")


def test_an_image_that_cannot_be_read_is_refused_at_its_key() -> None:
    assert refused(with_picture("data:image/png;base64,AAAA")).key == "shapes[1].image"


def test_a_file_may_tell_editors_its_schema() -> None:
    assert reader.loads(json.dumps({**GOOD, "$schema": "playground.schema.json"}), "mine").title == "A title"


def test_titles_may_be_translated() -> None:
    text = json.dumps({**GOOD, "translations": {"de": {"title": "Ein Titel"}}})
    ((language, translation),) = reader.loads(text, "mine").translations
    assert (language, translation.title, translation.description) == ("de", "Ein Titel", "")


def test_a_robot_that_starts_beside_the_ground_is_accepted_with_a_remark() -> None:
    loaded = make([FLOOR], [{**ROBOT, "x_m": 9.0}])
    assert loaded.notes == ("robots[0]: 'thymio' starts where there is no floor",)


def test_without_any_ground_there_is_nothing_to_remark() -> None:
    assert make([], [ROBOT]).notes == ()


def test_a_ground_that_is_painted_over_and_over_is_refused() -> None:
    ground = {**FLOOR, "size_x_m": 5.0, "size_y_m": 5.0}
    sheet = {"kind": "picture", "size_x_m": 5.0, "image": png_uri([[WHITE]])}
    reader.loads(json.dumps({**GOOD, "shapes": [ground, sheet, sheet]}), "good")
    error = refused_with(shapes=[ground, *[sheet] * 10])
    assert (error.key, error.found) == ("shapes", "a ground that takes 4.28 times the allowed time to paint")
    floors = [ground | {"name": f"floor_{number}"} for number in range(50)]
    assert refused_with(shapes=floors).key == "shapes"


def test_the_pixels_of_all_images_together_are_limited() -> None:
    sheet = {"kind": "picture", "size_x_m": 1.0, "image": png_uri([[WHITE] * 4000] * 900)}
    error = refused_with(shapes=[FLOOR, *[sheet] * 9])
    left = image_io.MAX_PIXELS_IN_ALL - 8 * 4000 * 900
    assert (error.key, error.found) == (
        "shapes[9].image",
        f"4000 x 900 pixels, with {left} of 32000000 left for images of this playground",
    )
