"""A pen that draws where the robot goes, and what the ground sensors of another robot see of it."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import pytest

from tests.sim.builders import FLOOR, make, measure_one, readings, run, send
from tests.sim.fake_view import FakeView
from thymio_sim_ros.sim.actuators.pen import ACTUATOR, PenState
from thymio_sim_ros.sim.commands import BodyTwist, MotorTargets, MoveRobot, SetPen
from thymio_sim_ros.sim.model.geometry import Point, Pose
from thymio_sim_ros.sim.model.primitives import Color
from thymio_sim_ros.sim.world import World

BLACK, RED = (0.0, 0.0, 0.0), (1.0, 0.0, 0.0)
TWO = [{"name": "painter", "x_m": 0.0, "y_m": 0.0}, {"name": "reader", "x_m": 0.028, "y_m": 0.5}]
BROAD = SetPen(down=True, width_m=0.04)


def draw(points: list[Point], *commands: SetPen, view: FakeView | None = None) -> tuple[PenState, FakeView]:
    """A pen that was led from point to point."""
    state, view = PenState(), view or FakeView()
    for command in commands:
        ACTUATOR.apply(state, command, 0)
    for x_m, y_m in points:
        view.pose = Pose(x_m, y_m, 0.0)
        assert ACTUATOR.update is not None
        ACTUATOR.update(state, view, 0.01)
    return state, view


def way(length_m: float, step_m: float = 0.001) -> list[Point]:
    return [(step_m * step, 0.0) for step in range(round(length_m / step_m) + 1)]


def test_a_pen_that_is_up_draws_nothing() -> None:
    state, view = draw(way(0.1))
    assert (state.strokes, view.drawn) == ((), [])


def test_a_straight_way_is_one_stroke_of_few_points() -> None:
    state, _ = draw(way(0.25), SetPen(down=True, color=RED, width_m=0.01))
    (stroke,) = state.strokes
    assert (stroke.color, stroke.width_m) == (RED, 0.01)
    assert (stroke.points[0], stroke.points[-1]) == ((0.0, 0.0), (0.25, 0.0))
    assert len(stroke.points) <= 7


def test_a_circle_keeps_its_shape() -> None:
    circle = [(0.1 * math.cos(step / 100), 0.1 * math.sin(step / 100)) for step in range(629)]
    state, _ = draw(circle, SetPen(down=True))
    (stroke,) = state.strokes
    assert len(stroke.points) < 100
    middles = [((ax + bx) / 2, (ay + by) / 2) for (ax, ay), (bx, by) in pairwise(stroke.points)]
    assert max(abs(math.hypot(x, y) - 0.1) for x, y in middles) < 0.001


def test_every_part_of_the_way_is_drawn_once() -> None:
    _, view = draw(way(0.05), SetPen(down=True))
    ends = [end for _, end, _, _ in view.drawn]
    assert [start for start, _, _, _ in view.drawn] == [(0.0, 0.0), *ends[:-1]]


def test_a_robot_that_stands_draws_a_dot_once() -> None:
    _, view = draw([(0.0, 0.0)] * 50, SetPen(down=True))
    assert len(view.drawn) == 1


def test_a_robot_that_is_carried_draws_no_line() -> None:
    state, view = draw([*way(0.01), (0.5, 0.5), (0.501, 0.5)], SetPen(down=True))
    assert len(state.strokes) == 2
    assert max(math.dist(start, end) for start, end, _, _ in view.drawn) < 0.002


def test_a_pen_keeps_what_a_command_leaves_out() -> None:
    state, _ = draw([], SetPen(down=True, color=RED), SetPen(width_m=0.02), SetPen(erase=True))
    assert (state.down, state.color, state.width_m, state.erase) == (True, RED, 0.02, True)


@pytest.mark.parametrize("change", [SetPen(width_m=0.02), SetPen(color=RED)])
def test_another_pen_begins_a_stroke_of_its_own(change: SetPen) -> None:
    state, view = draw(way(0.01), SetPen(down=True))
    assert ACTUATOR.update is not None
    ACTUATOR.apply(state, change, 0)
    view.pose = Pose(0.015, 0.0, 0.0)
    ACTUATOR.update(state, view, 0.01)
    first, second = state.strokes
    assert (first.color, first.width_m) == (BLACK, 0.003)
    assert (second.color, second.width_m) == (change.color or BLACK, change.width_m or 0.003)
    assert second.points == ((0.015, 0.0), (0.015, 0.0))


def test_a_pen_that_is_lifted_for_a_little_leaves_a_gap() -> None:
    state, view = draw(way(0.01), SetPen(down=True))
    assert ACTUATOR.update is not None
    for command, x_m in ((SetPen(down=False), 0.015), (SetPen(down=True), 0.02)):
        ACTUATOR.apply(state, command, 0)
        view.pose = Pose(x_m, 0.0, 0.0)
        ACTUATOR.update(state, view, 0.01)
    assert [stroke.points[-1] for stroke in state.strokes] == [(0.01, 0.0), (0.02, 0.0)]
    assert view.drawn[-1][:2] == ((0.02, 0.0), (0.02, 0.0))


class Edge(FakeView):
    """A robot that is led over a gap in the floor, from 0.1 to 0.11 m."""

    def draw(self, start: Point, end: Point, width_m: float, color: Color | None) -> Color | None:
        return None if 0.1 < end[0] < 0.11 else super().draw(start, end, width_m, color)


def test_where_no_floor_is_there_is_no_stroke() -> None:
    state, _ = draw(way(0.2), SetPen(down=True), view=Edge())
    assert [stroke.points[0][0] for stroke in state.strokes] == pytest.approx([0.0, 0.109])
    assert [stroke.points[-1][0] for stroke in state.strokes] == pytest.approx([0.1, 0.2])


class Stripes(FakeView):
    """A robot whose eraser uncovers black up to 0.05 m, then red."""

    def draw(self, start: Point, end: Point, width_m: float, color: Color | None) -> Color | None:
        return RED if end[0] > 0.05 else BLACK


def test_what_an_eraser_uncovers_is_a_stroke_for_each_color() -> None:
    state, _ = draw(way(0.1), SetPen(down=True, erase=True), view=Stripes())
    assert [stroke.color for stroke in state.strokes] == [BLACK, RED]
    assert state.strokes[0].points[-1] == state.strokes[1].points[0] == (0.05, 0.0)


def test_a_pen_that_creeps_draws_every_half_millimetre() -> None:
    _, view = draw(way(0.01, 0.0001), SetPen(down=True))
    assert len(view.drawn) == pytest.approx(20, abs=4)


def test_of_many_points_the_oldest_strokes_are_forgotten_but_never_the_one_that_is_drawn(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("thymio_sim_ros.sim.actuators.pen.MOST_POINTS", 10)
    zigzag = [(0.01 * step, 0.01 * (step % 2)) for step in range(20)]
    state, _ = draw([*zigzag, (1.0, 1.0), *[(1.0 + x, 1.0 + y) for x, y in zigzag]], SetPen(down=True))
    (stroke,) = state.strokes
    assert stroke.points[0] == (1.0, 1.0)
    assert len(stroke.points) == 20


@pytest.mark.parametrize("width_m", [0.0, 0.2])
def test_a_width_out_of_range_is_our_mistake(width_m: float) -> None:
    with pytest.raises(ValueError, match="SetPen"):
        ACTUATOR.apply(PenState(), SetPen(width_m=width_m), 0)


def test_another_robot_s_ground_sensors_see_the_drawing_at_once() -> None:
    world = World(make([FLOOR], TWO), noise=False)
    over_the_way, aside = MoveRobot(0.15, -0.072, math.pi / 2), MoveRobot(0.15, -0.5, math.pi / 2)
    world.post("reader", over_the_way)
    assert measure_one(world, "ground", "reader").words[2:4] == (938, 938)
    for command in (BROAD, BodyTwist(0.1, 0.0)):
        world.post("painter", command)
    world.post("reader", aside)
    run(world, 3.5)
    world.post("painter", BodyTwist(0.0, 0.0))
    world.post("reader", over_the_way)
    assert max(measure_one(world, "ground", "reader").words[2:4]) < 150


def test_the_eraser_takes_drawings_away_but_not_what_was_painted() -> None:
    line = {"kind": "rectangle", "size_x_m": 0.1, "size_y_m": 1.0, "x_m": 0.5, "color": "#0000ff"}
    world = World(make([FLOOR, line]), noise=False)
    before = world.snapshot()
    for down, erase, speed in ((True, False, 0.1), (True, True, -0.1)):
        send(world, replace(BROAD, down=down, erase=erase))
        send(world, BodyTwist(speed, 0.0))
        run(world, 3.0)
    assert before.robots[0].strokes == ()
    drawn, erased = world.snapshot().robots[0].strokes[0], world.snapshot().robots[0].strokes[1:]
    assert drawn.color == BLACK
    assert {stroke.color for stroke in erased} <= {BLACK, (1.0, 1.0, 1.0), (0.0, 0.0, 1.0)}
    send(world, BodyTwist(0.0, 0.0))
    send(world, MoveRobot(0.0, -0.5, 0.0))
    send(world, MoveRobot(0.1 - 0.072, 0.0, 0.0))
    assert measure_one(world, "ground").words[2:4] == (938, 938)


def test_a_reset_world_is_clean_again() -> None:
    world = World(make([FLOOR]), noise=False)
    send(world, BROAD)
    send(world, BodyTwist(0.1, 0.0))
    run(world, 2.0)
    world.reset()
    assert world.snapshot().robots[0].strokes == ()
    send(world, MoveRobot(0.05, 0.0, 0.0))
    assert measure_one(world, "ground").words[2:4] == (938, 938)


def test_the_trail_is_published_only_when_it_has_grown() -> None:
    world = World(make([FLOOR]), noise=False)
    assert readings(run(world, 1.0), "pen") == []
    send(world, SetPen(down=True, color=RED))
    send(world, MotorTargets(300, 300))
    reported = readings(run(world, 1.0), "pen")
    assert len(reported) == 5
    assert (reported[0].down, reported[0].color) == (True, RED)
    ends = [reading.strokes[-1].points[-1][0] for reading in reported]
    assert ends == sorted(ends)
    send(world, MotorTargets(0, 0))
    run(world, 0.3)
    assert readings(run(world, 1.0), "pen") == []


def test_a_playground_may_give_a_robot_a_pen() -> None:
    robot = {"name": "painter", "x_m": 0.0, "y_m": 0.0, "pen": {"color": "#ff0000", "width_m": 0.01}}
    world = World(make([FLOOR], [robot]), noise=False)
    for _ in range(2):
        send(world, MotorTargets(300, 300))
        run(world, 1.0)
        (stroke,) = world.snapshot().robots[0].strokes
        assert (stroke.color, stroke.width_m) == (RED, 0.01)
        world.reset()
