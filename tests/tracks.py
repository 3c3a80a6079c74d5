"""The way of a robot in a shipped playground, for tests that watch it follow a track or avoid things."""

from __future__ import annotations

from thymio_sim_ros.device.programs.program import ThymioProgram
from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.files.loading import load_playground
from thymio_sim_ros.sim.model.geometry import Point
from thymio_sim_ros.sim.playground.track_line import SENSOR_CENTER, TrackLine
from thymio_sim_ros.testing import Classroom, no_contact


def distance_to(points: list[Point], point: Point) -> float:
    """Distance in meters from a closed line through these points."""
    return TrackLine(points, closed=True).distance(point)


def farthest_in_laps(engine: Engine, laps: float, playground: str = "line", track: str = "") -> float:
    """Largest distance in m of the ground sensors' middle from the line's middle during so many laps of the line."""
    robot = engine.world.robots["thymio"]
    line, _ = TrackLine.of(load_playground(playground)[1], track)
    _, last = line.locate(robot.pose.place(SENSOR_CENTER))
    driven, farthest = 0.0, 0.0
    while driven < laps * line.length_m:
        assert engine.now_ns < laps * 60e9
        engine.run(0.1)
        distance, along = line.locate(robot.pose.place(SENSOR_CENTER), last)
        driven += line.offset(last, along)
        farthest, last = max(farthest, distance), along
    return farthest


def assert_avoids(program: ThymioProgram) -> None:
    """Two minutes in the arena: the robot touches nothing, and no corner holds it."""
    (thymio,) = Classroom("arena", program)
    thymio.run(120.0)
    assert no_contact(thymio)
    second_minute = thymio.path[len(thymio.path) // 2 :]
    assert len({(round(at.pose.x_m, 1), round(at.pose.y_m, 1)) for at in second_minute}) > 15
