"""Prints in the ground's raster: the right way round, to scale, with what is under them where they are clear."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
import pytest

from tests.sim.ground.pictures import picture_of
from tests.sim.images import BLACK, CLEAR, RED, WHITE, Rows, printed
from thymio_sim_ros.sim.ground import decals
from thymio_sim_ros.sim.ground.decals import bands, few_colors
from thymio_sim_ros.sim.ground.raster import Picture
from thymio_sim_ros.sim.model.geometry import Point, Pose
from thymio_sim_ros.sim.model.primitives import Color, Floor, Paint, Print

GRAY = (128 / 255,) * 3


def area(side: float) -> tuple[Point, ...]:
    return ((-side, -side), (side, -side), (side, side), (-side, side))


def ground(*marks: Print | Paint, side: float = 0.5) -> Picture:
    """A gray square of a meter about the origin with marks on it."""
    return picture_of([Floor("floor", area(side), GRAY)], marks)


def seen(picture: Picture, *places: Point) -> list[Color | None]:
    return [picture.color_at(x, y) for x, y in places]


def test_the_first_row_is_the_far_side_and_the_first_column_the_left_one() -> None:
    colors: Rows = [[WHITE, BLACK], [RED, (0, 0, 255, 255)]]
    found = seen(ground(printed(colors, 0.4, 0.4)), (-0.1, 0.1), (0.1, 0.1), (-0.1, -0.1), (0.1, -0.1))
    assert found == [(1.0, 1.0, 1.0), (0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)]


def test_it_turns_with_its_pose() -> None:
    turned = printed([[WHITE, BLACK]], 0.4, 0.2, Pose(0.2, 0.0, math.pi / 2))
    assert seen(ground(turned), (0.2, -0.1), (0.2, 0.1)) == [(1.0, 1.0, 1.0), (0.0, 0.0, 0.0)]


def test_it_ends_where_its_size_says() -> None:
    picture = ground(printed([[BLACK]], 0.4, 0.2))
    row = [picture.color_at(x / 1000 + 0.0005, 0.0) == (0.0, 0.0, 0.0) for x in range(-400, 400)]
    column = [picture.color_at(0.0, y / 1000 + 0.0005) == (0.0, 0.0, 0.0) for y in range(-400, 400)]
    assert (row.count(True), column.count(True)) == (400, 200)


def test_the_ground_shows_through_what_is_clear_and_partly_through_what_is_half_clear() -> None:
    picture = ground(printed([[CLEAR, (255, 255, 255, 128)]], 0.4, 0.2))
    clear, half = seen(picture, (-0.1, 0.0), (0.1, 0.0))
    assert clear == GRAY
    assert half == pytest.approx((192 / 255,) * 3, abs=0.003)


def test_it_makes_no_floor() -> None:
    assert seen(ground(printed([[BLACK]], 4.0, 4.0)), (0.6, 0.0)) == [None]


def test_later_marks_cover_earlier_ones() -> None:
    over = Paint("over", area(0.1), (0.0, 1.0, 0.0))
    sheet = printed([[BLACK]], 0.6, 0.6)
    assert seen(ground(sheet, over), (0.0, 0.0), (0.2, 0.0)) == [(0.0, 1.0, 0.0), (0.0, 0.0, 0.0)]
    assert seen(ground(over, sheet), (0.0, 0.0)) == [(0.0, 0.0, 0.0)]


def rastered(mark: Print) -> npt.NDArray[np.uint8]:
    """Red, green, blue, opacity of two rows of a hundred pixels of a millimeter about the origin."""
    return np.concatenate([words for _, words in bands(mark, 0.001, (-50, -1), (2, 100))])[..., None].view(np.uint8)


def test_an_image_finer_than_the_ground_is_averaged() -> None:
    stripes: Rows = [[WHITE, BLACK] * 100] * 4
    colors = rastered(printed(stripes, 0.1, 0.002))
    assert {tuple(color) for color in colors[:, :, :3].reshape(-1, 3).tolist()} == {(128, 128, 128)}


def test_averaging_does_not_mix_in_what_is_clear() -> None:
    colors = rastered(printed([[WHITE, CLEAR] * 100] * 4, 0.1, 0.002))
    assert colors[0, 50].tolist() == [255, 255, 255, 128]


def test_beside_the_ground_nothing_is_printed() -> None:
    assert seen(ground(printed([[BLACK]], 0.1, 0.1, Pose(9.0, 9.0, 0.0))), (0.0, 0.0)) == [GRAY]


def codes(colors: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint32]:
    return colors.astype(np.uint32) @ np.array([1 << 16, 1 << 8, 1], dtype=np.uint32)


def test_few_colors_stay_as_they_are() -> None:
    colors = np.array([[1, 2, 3], [4, 5, 6], [1, 2, 3]], dtype=np.uint8)
    palette, table = few_colors([codes(colors[:1]), codes(colors[1:])], 2)
    assert (palette[table[codes(colors)]] == colors).all()


def test_many_colors_become_near_ones_with_the_same_mean_grey() -> None:
    colors = np.random.default_rng(1).integers(0, 256, (5000, 3)).astype(np.uint8)
    palette, table = few_colors([codes(colors[:2000]), codes(colors[2000:])], 500)
    found = palette[table[codes(colors)]]
    assert len(palette) <= 500
    assert abs(found.astype(int) - colors).max() <= 64
    assert found.mean() == pytest.approx(colors.mean(), abs=0.3)


@pytest.mark.parametrize("yaw_rad", [0.0, 0.4])
@pytest.mark.parametrize("size_m", [0.2, 0.9])
def test_bands_give_the_same_ground_as_the_whole_print(
    yaw_rad: float, size_m: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    noise = np.random.default_rng(2).integers(0, 256, (500, 400, 4)).astype(np.uint8)
    photo = Print("photo", Pose(0.1, 0.2, yaw_rad), size_m, 0.3, 400, 500, noise.tobytes())
    at_once = ground(photo)
    monkeypatch.setattr(decals, "_BAND_PIXELS", 5000)
    banded = ground(photo)
    assert (banded.pixels == at_once.pixels).all()
    assert (banded.grays == at_once.grays).all()


def test_a_photograph_leaves_colors_for_pens() -> None:
    noise = np.random.default_rng(1).integers(0, 256, (400, 400, 4)).astype(np.uint8)
    noise[..., 3] = 255
    picture = ground(Print("photo", Pose(0.0, 0.0, 0.0), 0.4, 0.4, 400, 400, noise.tobytes()))
    picture.draw_segment(-0.4, 0.0, 0.4, 0.0, 0.01, (0.9, 0.1, 0.35))
    assert picture.color_at(0.0, 0.0) == (0.9, 0.1, 0.35)
