"""Following a line: distances, laps, crossings."""

from __future__ import annotations

import math

import pytest

from thymio_sim_ros.files.loading import load_playground
from thymio_sim_ros.sim.playground.track_line import TrackLine
from thymio_sim_ros.testing import Classroom, followed_line

SQUARE = TrackLine([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)], closed=True)
EIGHT = TrackLine([(-1.0, -1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, 1.0)], closed=True)


def test_a_point_is_located_beside_the_line() -> None:
    assert SQUARE.length_m == 4.0
    assert SQUARE.locate((0.5, -0.1)) == pytest.approx((0.1, 0.5))
    assert SQUARE.locate((-0.2, 0.5)) == pytest.approx((0.2, 3.5))
    assert SQUARE.distance((0.5, 0.5)) == 0.5


def test_ways_on_a_closed_line_are_the_shorter_ones() -> None:
    assert SQUARE.offset(3.9, 0.1) == pytest.approx(0.2)
    assert SQUARE.offset(0.1, 3.9) == pytest.approx(-0.2)
    assert TrackLine([(0.0, 0.0), (4.0, 0.0)], closed=False).offset(3.9, 0.1) == pytest.approx(-3.8)


def test_in_a_corner_the_distance_is_the_smallest_one() -> None:
    assert SQUARE.locate((1.02, 0.015), 0.99) == pytest.approx((0.02, 1.015))


def test_at_a_crossing_the_way_goes_straight_on() -> None:
    before, crossing = math.sqrt(2) - 0.1, math.sqrt(2)
    assert EIGHT.locate((0.0, 0.001), before)[1] == pytest.approx(crossing, abs=0.01)
    other = 2 * math.sqrt(2) + 2 + math.sqrt(2)
    assert EIGHT.locate((0.0, 0.001), other - 0.1)[1] == pytest.approx(other, abs=0.01)


@pytest.mark.parametrize("playground", ["desk", "line", "line_eight"])
def test_the_line_follower_follows_the_line(playground: str) -> None:
    (thymio,) = Classroom(playground, "line_follower")
    thymio.until(followed_line(thymio), 120.0)
    assert followed_line(thymio)
    assert not followed_line(thymio, within=0.001)
    assert not followed_line(thymio, laps=1.5)


def test_either_direction_counts_and_what_came_before_does_not() -> None:
    room = Classroom("line", "line_follower")
    (thymio,) = room
    here = thymio.pose
    thymio.place(0.0, 0.0)
    room.run(0.5)
    thymio.place(here.x_m, here.y_m, here.yaw_rad + math.pi)
    room.run(0.5)
    check = followed_line(thymio, laps=0.1, since=room.now)
    room.until(check, 60.0)
    assert not followed_line(thymio, laps=0.1)
    assert followed_line(thymio, laps=0.0, since=room.now)


def test_a_robot_that_leaves_the_line_or_stands_has_not_followed_it() -> None:
    room = Classroom("line", "motor.left.target = 200\nmotor.right.target = 200")
    (thymio,) = room
    check = followed_line(thymio, laps=0.1)
    assert not check
    room.run(20.0)
    assert not check
    assert " laps, at most " in repr(check)


def test_a_reset_starts_the_laps_again() -> None:
    room = Classroom("line", "line_follower")
    (thymio,) = room
    check = followed_line(thymio, laps=0.1)
    room.until(check, 60.0)
    room.reset()
    assert not check
    room.until(check, 60.0)


def test_laps_before_a_reset_do_not_count() -> None:
    room = Classroom("line", "line_follower")
    (thymio,) = room
    check = followed_line(thymio)
    room.until(check, 120.0)
    seconds = room.now
    room.reset()
    thymio.load("")
    room.run(2 * seconds)
    assert not check


def test_a_playground_without_a_track_is_refused() -> None:
    (thymio,) = Classroom("base")
    with pytest.raises(ValueError, match="playground base: 0 tracks, name one of them; found none"):
        followed_line(thymio)
    with pytest.raises(ValueError, match="playground line: no track 'x'; found "):
        TrackLine.of(load_playground("line")[1], "x")
