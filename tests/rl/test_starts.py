"""Start poses: free places only, on a line where the task says so."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest

pytest.importorskip("gymnasium", reason="needs gymnasium (pip install gymnasium)")

from thymio_sim_ros.files.loading import load_playground
from thymio_sim_ros.rl import TaskError
from thymio_sim_ros.rl.starts import RADIUS_M, Starts
from thymio_sim_ros.sim.playground.placement import Footprint, Occupied, footprint_of

COUNT = 20
NO_FLOOR = '{"format": 1, "title": "t", "description": "d", "shapes": [], "robots": []}'


def test_random_starts_are_far_from_solids_edges_and_each_other() -> None:
    _, playground = load_playground("obstacle")
    poses = Starts(playground, "anywhere").draw(np.random.default_rng(1), 5)
    solids = Occupied(footprint_of(solid) for solid in playground.solids)
    for number, pose in enumerate(poses):
        assert solids.blocker(Footprint("robot", (pose.x_m, pose.y_m), RADIUS_M)) is None
        assert any(floor.holds((pose.x_m, pose.y_m)) for floor in playground.floors)
        for other in poses[:number]:
            assert math.dist((pose.x_m, pose.y_m), (other.x_m, other.y_m)) >= 2 * RADIUS_M
    assert len({pose.yaw_rad for pose in poses}) == 5


def test_starts_on_a_line_are_on_it_in_both_directions() -> None:
    points = [[-0.5, 0.0], [0.5, 0.0]]
    starts = Starts(_load({"points_m": points}), "line")
    random = np.random.default_rng(1)
    poses = [starts.draw(random, 1)[0] for _ in range(COUNT)]
    assert [pose.y_m for pose in poses] == [0.0] * COUNT
    assert all(-0.5 <= pose.x_m <= 0.5 for pose in poses)
    assert {round(abs(pose.yaw_rad), 6) for pose in poses} == {0.0, round(math.pi, 6)}


def test_a_playground_without_room_is_rejected() -> None:
    starts = Starts(_load({"points_m": [[0, 0], [0.1, 0]]}, size_m=0.2), "anywhere")
    with pytest.raises(TaskError, match="found no free place for robot 0"):
        starts.draw(np.random.default_rng(1), 1)


def test_a_playground_without_what_the_start_needs_is_rejected() -> None:
    with pytest.raises(TaskError, match="found no floor"):
        Starts(load_playground(NO_FLOOR)[1], "anywhere")
    with pytest.raises(TaskError, match="found 0 tracks"):
        Starts(load_playground("base")[1], "line")
    with pytest.raises(TaskError, match="found 1 robots, expected at least 2"):
        Starts(load_playground("base")[1], "playground").draw(np.random.default_rng(1), 2)


def _load(track: dict[str, object], size_m: float = 2.0):
    floor = {"kind": "rectangle", "name": "floor", "size_x_m": size_m, "size_y_m": size_m, "color": "#ffffff"}
    line = {"kind": "track", "name": "line", "width_m": 0.04, "color": "#000000", **track}
    robots = [{"name": "thymio", "x_m": 0.0, "y_m": 0.0}]
    content = {"format": 1, "title": "t", "description": "d", "shapes": [floor, line], "robots": robots}
    return load_playground(json.dumps(content))[1]
