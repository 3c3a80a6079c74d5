"""The tree of frames: known results, also of the tests and tutorials of tf2."""

from __future__ import annotations

import math
import random

import pytest

from thymio_sim_ros.tf.buffer_core import IDENTITY, BufferCore, OldDataError, RigidTransform, StampedTransform, slerp
from thymio_sim_ros.tf.errors import (
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TransformException,
)

S = 1_000_000_000


def turn(yaw, x=0.0, y=0.0, z=0.0):
    return RigidTransform((x, y, z), (0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2)))


def yaw_of(motion):
    x, y, z, w = motion.rotation
    return math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))


def filled(*placed, static=()):
    core = BufferCore()
    for frame, child, seconds, motion in placed:
        core.set_transform(StampedTransform(round(seconds * S), frame, child, motion))
    for frame, child, motion in static:
        core.set_transform(StampedTransform(0, frame, child, motion), is_static=True)
    return core


def place(core, target, source, seconds=0.0):
    return core.lookup(target, source, round(seconds * S)).motion.translation


def test_a_transform_and_its_inverse():
    core = filled(("map", "base", 1.0, turn(math.pi / 2, 1.0, 2.0)))
    assert core.lookup("map", "base").motion.apply((1.0, 0.0, 0.0)) == pytest.approx((1.0, 3.0, 0.0))
    assert core.lookup("base", "map").motion.apply((1.0, 3.0, 0.0)) == pytest.approx((1.0, 0.0, 0.0))
    assert core.lookup("base", "map").stamp_ns == S


def test_a_frame_in_itself_is_identity_at_the_time_asked_for():
    core = filled(("map", "base", 2.0, turn(1.0, 5.0)))
    assert core.lookup("base", "base", 7 * S) == StampedTransform(7 * S, "base", "base", IDENTITY)
    assert core.lookup("base", "base").stamp_ns == 2 * S


@pytest.mark.parametrize("part", [0.0, 0.1, 0.25, 0.5, 0.9, 1.0])
@pytest.mark.parametrize(("start", "end"), [(0.0, 1.0), (-3.0, 3.0), (3.0, -3.0), (0.3, 0.3), (0.0, 3.1)])
def test_translations_are_interpolated_linearly_and_rotations_along_the_shortest_arc(part, start, end):
    core = filled(("map", "base", 1.0, turn(start, 0.0, -2.0)), ("map", "base", 2.0, turn(end, 4.0, 2.0)))
    found = core.lookup("map", "base", round((1.0 + part) * S)).motion
    assert found.translation == pytest.approx((4.0 * part, -2.0 + 4.0 * part, 0.0))
    way = math.remainder(end - start, 2 * math.pi)
    assert math.remainder(yaw_of(found) - start - part * way, 2 * math.pi) == pytest.approx(0.0, abs=1e-9)
    assert math.hypot(*found.rotation) == pytest.approx(1.0)


def test_a_quaternion_and_its_negative_are_one_rotation():
    one, other = turn(0.4).rotation, tuple(-part for part in turn(0.8).rotation)
    assert slerp(one, other, 0.5) == pytest.approx(turn(0.6).rotation)


def test_a_chain_is_the_product_of_its_links():
    links = [("a", "b", turn(0.5, 1.0)), ("b", "c", turn(-1.0, 0.0, 2.0)), ("c", "d", turn(2.0, 1.0, 1.0, 3.0))]
    core = filled(*((frame, child, 1.0, motion) for frame, child, motion in links))
    point = (0.2, -0.3, 0.4)
    wanted = point
    for _, _, motion in reversed(links):
        wanted = motion.apply(wanted)
    assert core.lookup("a", "d").motion.apply(point) == pytest.approx(wanted)
    assert core.lookup("d", "a").motion.apply(wanted) == pytest.approx(point)


def test_two_branches_meet_at_their_common_ancestor():
    core = filled(
        ("root", "left", 1.0, turn(0.0, -1.0)),
        ("left", "left_tip", 1.0, turn(0.0, -1.0)),
        ("root", "right", 1.0, turn(0.0, 1.0)),
        ("right", "right_tip", 1.0, turn(math.pi / 2, 1.0)),
    )
    assert place(core, "left_tip", "right_tip") == pytest.approx((4.0, 0.0, 0.0))
    assert place(core, "right_tip", "left_tip") == pytest.approx((0.0, 4.0, 0.0))


def test_transforms_above_the_common_ancestor_do_not_matter():
    core = filled(
        ("map", "odom", 1.0, turn(0.0, 9.0)),
        ("odom", "base", 5.0, turn(0.0, 1.0)),
        static=[("base", "camera", turn(0.0, 0.1)), ("base", "laser", turn(0.0, -0.1))],
    )
    assert place(core, "camera", "laser", 5.0) == pytest.approx((-0.2, 0.0, 0.0))
    with pytest.raises(ExtrapolationException):
        core.lookup("map", "camera", 5 * S)


def test_a_static_transform_is_valid_at_every_time():
    core = filled(static=[("base", "prox", turn(0.3, 0.08))])
    for seconds in (0.0, 3.0, 1e6):
        assert place(core, "base", "prox", seconds) == pytest.approx((0.08, 0.0, 0.0))
    assert core.lookup("base", "prox").stamp_ns == 0


def test_time_0_is_the_latest_common_time():
    core = filled(
        ("map", "odom", 1.0, turn(0.0, 1.0)),
        ("map", "odom", 3.0, turn(0.0, 3.0)),
        ("odom", "base", 1.0, turn(0.0)),
        ("odom", "base", 2.0, turn(0.0)),
        static=[("base", "prox", turn(0.0, 0.5))],
    )
    found = core.lookup("map", "prox")
    assert found.stamp_ns == 2 * S
    assert found.motion.translation == pytest.approx((2.5, 0.0, 0.0))


@pytest.mark.parametrize(
    ("seconds", "text"),
    [
        (3.5, "into the future. Requested time 3.500000 but the latest data is at time 3.000000"),
        (0.5, "into the past. Requested time 0.500000 but the earliest data is at time 1.000000"),
    ],
)
def test_there_is_no_extrapolation_before_the_first_and_after_the_last(seconds, text):
    core = filled(("map", "base", 1.0, turn(0.0)), ("map", "base", 3.0, turn(0.0)))
    with pytest.raises(ExtrapolationException, match="Lookup would require extrapolation") as caught:
        core.lookup("map", "base", round(seconds * S))
    assert text in str(caught.value)
    assert str(caught.value).endswith("when looking up transform from frame [base] to frame [map]")


def test_of_one_transform_only_its_own_time_is_known():
    core = filled(("map", "base", 2.0, turn(0.0)))
    assert core.lookup("map", "base", 2 * S).stamp_ns == 2 * S
    with pytest.raises(ExtrapolationException, match=r"at time 2.500000, but only time 2.000000 is in the buffer"):
        core.lookup("map", "base", 2 * S + S // 2)


def test_unconnected_frames():
    core = filled(("map", "base", 1.0, turn(0.0)), ("world", "drone", 1.0, turn(0.0)))
    for time_ns in (0, S):
        with pytest.raises(ConnectivityException, match="'map' and 'drone' because they are not part of the same tree"):
            core.lookup("map", "drone", time_ns)


def test_unknown_frames_are_a_lookup_error():
    core = filled(("map", "base", 1.0, turn(0.0)))
    with pytest.raises(
        LookupException,
        match='"odom" passed to lookupTransform argument source_frame does not exist; known frames: base',
    ):
        core.lookup("map", "odom")
    with pytest.raises(LookupException, match='"odom" passed to lookupTransform argument target_frame does not exist'):
        core.lookup("odom", "map")


@pytest.mark.parametrize("name", ["", "/map"])
def test_invalid_frame_names(name):
    core = filled(("map", "base", 1.0, turn(0.0)))
    for target, source in ((name, "base"), ("base", name)):
        with pytest.raises(InvalidArgumentException, match=r"cannot (be empty|start with a '/')"):
            core.lookup(target, source)


def test_a_leading_slash_of_received_frame_names_is_removed():
    core = filled(("/map", "/base", 1.0, turn(0.0, 1.0)))
    assert place(core, "map", "base") == (1.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("placed", "text"),
    [
        (StampedTransform(S, "a", "a", IDENTITY), "the transform of 'a' has the same frame as frame_id"),
        (StampedTransform(S, "", "a", IDENTITY), "has an empty frame_id"),
        (StampedTransform(S, "a", "", IDENTITY), "has an empty child_frame_id"),
        (StampedTransform(S, "a", "b", RigidTransform((math.nan, 0.0, 0.0))), "NaN or infinite"),
        (
            StampedTransform(S, "a", "b", RigidTransform(rotation=(0.0, 0.0, 0.0, 0.0))),
            "a quaternion of norm 0, expected 1",
        ),
        (
            StampedTransform(S, "a", "b", RigidTransform(rotation=(0.0, 0.0, 1.0, 1.0))),
            "a quaternion of norm 1.41, expected 1",
        ),
    ],
)
def test_an_invalid_transform_is_rejected(placed, text):
    core = BufferCore()
    with pytest.raises(InvalidArgumentException, match=text):
        core.set_transform(placed)
    assert core.frames() == ()


def test_ten_seconds_are_kept():
    core = filled(*(("map", "base", float(second), turn(0.0, float(second))) for second in range(1, 16)))
    assert place(core, "map", "base", 5.0) == (5.0, 0.0, 0.0)
    with pytest.raises(ExtrapolationException, match=r"earliest data is at time 5.000000"):
        core.lookup("map", "base", 4 * S)
    with pytest.raises(OldDataError, match="only 10 s are kept"):
        core.set_transform(StampedTransform(4 * S, "map", "base", IDENTITY))


def test_the_order_in_which_transforms_arrive_does_not_matter():
    placed = [("map", "base", 1.0 + index / 10, turn(index / 7, float(index))) for index in range(30)]
    shuffled = random.Random(1).sample(placed, len(placed))
    one, other = filled(*placed), filled(*shuffled)
    for seconds in (1.0, 1.05, 2.22, 3.9):
        assert one.lookup("map", "base", round(seconds * S)) == other.lookup("map", "base", round(seconds * S))


def test_a_second_transform_for_one_time_is_rejected():
    core = filled(("map", "base", 1.0, turn(0.0, 1.0)))
    with pytest.raises(OldDataError, match=r"a transform of base at time 1\.000000 exists already"):
        core.set_transform(StampedTransform(S, "map", "base", turn(0.0, 2.0)))
    assert place(core, "map", "base") == (1.0, 0.0, 0.0)


def test_a_frame_may_change_its_parent():
    core = filled(
        ("map", "cup", 1.0, turn(0.0, 1.0)), ("hand", "cup", 2.0, turn(0.0, 0.1)), ("map", "hand", 1.0, turn(0.0, 5.0)),
        ("map", "hand", 3.0, turn(0.0, 5.0)),
    )  # fmt: skip
    assert place(core, "map", "cup", 1.0) == (1.0, 0.0, 0.0)
    assert place(core, "map", "cup", 1.5) == (1.0, 0.0, 0.0)
    assert place(core, "map", "cup", 2.0) == pytest.approx((5.1, 0.0, 0.0))
    assert core.parent_of("cup") == "hand"


def test_a_loop_is_an_error():
    core = filled(
        ("a", "b", 1.0, turn(0.0)), ("b", "c", 1.0, turn(0.0)), ("c", "a", 1.0, turn(0.0)), ("x", "y", 1.0, IDENTITY)
    )
    with pytest.raises(TransformException, match="loop"):
        core.lookup("a", "y")


def test_lookup_between_two_times_by_a_fixed_frame():
    """The second turtle of tf2's tutorials goes where the first one was five seconds ago."""
    core = filled(
        *(("world", "turtle1", float(second), turn(0.0, float(second))) for second in range(1, 10)),
        *(("world", "turtle2", float(second), turn(math.pi / 2, 0.0, -float(second))) for second in range(1, 10)),
    )
    found = core.lookup_full("turtle2", 9 * S, "turtle1", 4 * S, "world")
    assert found.motion.translation == pytest.approx((9.0, -4.0, 0.0))
    assert (found.frame, found.child, found.stamp_ns) == ("turtle2", "turtle1", 9 * S)


def test_clear_drops_all_but_static_transforms():
    core = filled(("map", "odom", 50.0, turn(0.0)), static=[("odom", "base", turn(0.0, 1.0))])
    core.clear()
    assert place(core, "odom", "base") == (1.0, 0.0, 0.0)
    with pytest.raises(TransformException):
        core.lookup("map", "base")
    core.set_transform(StampedTransform(S, "map", "odom", turn(0.0, 3.0)))
    assert place(core, "map", "base") == (4.0, 0.0, 0.0)


def test_all_frames_are_listed_in_the_format_of_tf2():
    core = filled(("map", "odom", 1.0, turn(0.0)), ("map", "odom", 2.0, turn(0.0)), static=[("odom", "base", IDENTITY)])
    assert core.as_text() == "Frame odom exists with parent map.\nFrame base exists with parent odom.\n"
    assert core.as_yaml() == (
        "odom: \n  parent: 'map'\n  broadcaster: 'unknown'\n  rate: 2.000\n  most_recent_transform: 2.000000\n"
        "  oldest_transform: 1.000000\n  buffer_length: 1.000\n"
        "base: \n  parent: 'odom'\n  broadcaster: 'unknown'\n  rate: 10000.000\n  most_recent_transform: 0.000000\n"
        "  oldest_transform: 0.000000\n  buffer_length: 0.000\n"
    )
    assert (BufferCore().as_text(), BufferCore().as_yaml()) == ("", "[]")


def test_random_trees_agree_with_the_product_of_their_links():
    chance = random.Random(7)
    core, absolute = BufferCore(), {"f0": IDENTITY}
    for number in range(1, 40):
        parent = f"f{chance.randrange(number)}"
        raw = [chance.gauss(0, 1) for _ in range(4)]
        length = math.hypot(*raw)
        motion = RigidTransform(
            (chance.uniform(-1, 1), chance.uniform(-1, 1), chance.uniform(-1, 1)), tuple(part / length for part in raw)
        )
        absolute[f"f{number}"] = absolute[parent] * motion
        core.set_transform(StampedTransform(S, parent, f"f{number}", motion), is_static=number % 3 == 0)
    for _ in range(200):
        target, source = chance.choice(list(absolute)), chance.choice(list(absolute))
        wanted = absolute[target].inverse() * absolute[source]
        found = core.lookup(target, source, S).motion
        assert found.apply((0.3, -0.2, 0.9)) == pytest.approx(wanted.apply((0.3, -0.2, 0.9)), abs=1e-9)
