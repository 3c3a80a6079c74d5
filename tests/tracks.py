"""The track of a shipped playground, for tests that watch a robot follow it."""

from __future__ import annotations

import math

from thymio_sim_ros.loading import load_playground
from thymio_sim_ros.runner import Runner
from thymio_sim_ros.sim.geometry import Point
from thymio_sim_ros.sim.shapes.track import Track


def track_points(playground: str) -> list[Point]:
    """The middle line of the playground's only track, in metres."""
    _, loaded = load_playground(playground)
    (track,) = (named.shape for named in loaded.shapes if isinstance(named.shape, Track))
    return [(x, y) for x, y, _ in track.stations()]


def distance_to(points: list[Point], point: Point) -> float:
    """Distance in metres from a closed line through these points."""
    return min(_to_segment(point, a, b) for a, b in zip(points, [*points[1:], points[0]], strict=True))


def farthest_in_laps(runner: Runner, laps: float) -> float:
    """Largest distance in m of the ground sensors' middle from the line's middle during so many laps of the line."""
    robot = runner.world.robots["thymio"]
    points = track_points("line")
    middle = (sum(x for x, _ in points) / len(points), sum(y for _, y in points) / len(points))
    turned, farthest, last = 0.0, 0.0, math.nan
    while turned < laps * math.tau:
        assert runner.now_ns < laps * 60e9
        runner.run(0.1)
        angle = math.atan2(robot.pose.y_m - middle[1], robot.pose.x_m - middle[0])
        turned += 0.0 if math.isnan(last) else math.remainder(angle - last, math.tau)
        last = angle
        farthest = max(farthest, distance_to(points, robot.pose.place((0.072, 0.0))))
    return farthest


def _to_segment(point: Point, a: Point, b: Point) -> float:
    dx, dy = b[0] - a[0], b[1] - a[1]
    length = dx * dx + dy * dy
    along = 0.0 if length == 0.0 else ((point[0] - a[0]) * dx + (point[1] - a[1]) * dy) / length
    along = min(1.0, max(0.0, along))
    return math.hypot(point[0] - a[0] - along * dx, point[1] - a[1] - along * dy)
