"""Laws of motion on a world: where the robot ends, how fast it goes, and what happens when something holds it."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest

from tests.sim.builders import FLOOR, box, make
from thymio_sim_ros.engine.motions import MAX_TURN_RAD_S, Arc, Distance, Law, StallDetector, ToPose, Turn, Velocity
from thymio_sim_ros.sim.commands import BodyTwist
from thymio_sim_ros.sim.model.geometry import Pose, wrap_angle
from thymio_sim_ros.sim.model.robot_constants import MAX_SPEED_M_S
from thymio_sim_ros.sim.world import World

MODELS = pytest.mark.parametrize("motors", ["ideal", "firmware"])
MOST_TICKS = 6000


class Run:
    """A robot that follows a law until it ends or the robot is held; then it has stopped."""

    def __init__(self, world: World, law: Law) -> None:
        self.robot = world.robots["thymio"]
        stall = StallDetector(self.robot.wheels.odometry)
        self.velocities: list[Velocity] = []
        self.is_held = False
        while (wanted := law.velocity(self.robot.wheels.odometry)) is not None and not self.is_held:
            assert len(self.velocities) < MOST_TICKS
            self.velocities.append(wanted)
            world.post("thymio", BodyTwist(wanted.linear_m_s, wanted.angular_rad_s))
            world.step(())
            self.is_held = stall.update(self.robot.wheels.odometry, wanted)
        world.post("thymio", BodyTwist(0.0, 0.0))
        for _ in range(100):
            world.step(())

    @property
    def end(self) -> Pose:
        return self.robot.wheels.odometry

    @property
    def seconds(self) -> float:
        return len(self.velocities) / 100


def follow(make_law: Callable[[Pose], Law], *shapes: object, motors: str = "ideal", noise: bool = True) -> Run:
    world = World(make([FLOOR, *shapes]), motor_model=motors, seed=3, noise=noise)  # type: ignore[list-item]
    return Run(world, make_law(world.robots["thymio"].wheels.odometry))


@MODELS
@pytest.mark.parametrize("degrees", [90.0, -90.0, 179.0, 720.0, 2.0, -400.0, 0.0])
def test_a_turn_ends_at_its_angle(degrees: float, motors: str) -> None:
    law: list[Turn] = []
    found = follow(lambda start: law.append(Turn(start, math.radians(degrees))) or law[0], motors=motors)  # type: ignore[func-returns-value]
    assert math.degrees(found.robot.wheels.odometry.yaw_rad) == pytest.approx(degrees, abs=1.5)
    assert not found.is_held
    assert abs(law[0].remaining.angle_rad) < 0.003
    assert math.hypot(found.end.x_m, found.end.y_m) < 1e-6


@MODELS
@pytest.mark.parametrize("distance_m", [0.5, -0.3, 0.01, 0.0])
def test_a_distance_is_driven_straight(distance_m: float, motors: str) -> None:
    found = follow(lambda start: Distance(start, distance_m), motors=motors)
    assert found.end.x_m == pytest.approx(distance_m, abs=0.003)
    assert abs(found.end.y_m) < 0.002
    assert abs(math.degrees(found.end.yaw_rad)) < 1.0
    assert not found.is_held


def test_a_drive_returns_to_its_line() -> None:
    found = follow(lambda start: Distance(Pose(start.x_m, start.y_m + 0.02, 0.1), 0.8), noise=False)
    line = Pose(0.0, 0.02, 0.1)
    end = line.place((0.8, 0.0))
    assert (found.end.x_m, found.end.y_m) == pytest.approx(end, abs=0.002)
    found = follow(lambda start: Distance(Pose(start.x_m, start.y_m + 0.02, 0.1), -0.8), noise=False)
    assert (found.end.x_m, found.end.y_m) == pytest.approx(line.place((-0.8, 0.0)), abs=0.002)


@MODELS
@pytest.mark.parametrize(
    ("angle", "radius", "backward"),
    [(math.pi / 2, 0.3, False), (-math.pi, 0.2, False), (math.pi / 2, 0.3, True), (-1.0, 0.4, True), (1.0, 0.0, False)],
)
def test_an_arc_ends_on_its_circle(angle: float, radius: float, backward: bool, motors: str) -> None:
    found = follow(lambda start: Arc(start, angle, radius, backward=backward, largest_m_s=0.1), motors=motors)
    assert wrap_angle(found.end.yaw_rad - angle) == pytest.approx(0.0, abs=0.03)
    # To the left (angle above 0) the center is on the left when it drives forward, on the right when backward.
    side = math.copysign(1.0, angle) * (-1.0 if backward else 1.0)
    assert (found.end.x_m, found.end.y_m) == pytest.approx(
        (math.sin(angle) * side * radius, side * radius * (1 - math.cos(angle))), abs=0.012
    )
    assert max(abs(one.linear_m_s) for one in found.velocities) <= 0.1 + 1e-9


@MODELS
@pytest.mark.parametrize(
    "goal",
    [Pose(0.5, 0.3, 1.0), Pose(-0.4, 0.1, -3.0), Pose(0.0, 0.0, 2.0), Pose(0.004, 0.0, 0.0), Pose(0.0, -0.5, 0.0)],
)
def test_a_pose_is_reached(goal: Pose, motors: str) -> None:
    found = follow(lambda start: ToPose(start, goal), motors=motors)
    assert (found.end.x_m, found.end.y_m) == pytest.approx((goal.x_m, goal.y_m), abs=0.004)
    assert wrap_angle(found.end.yaw_rad - goal.yaw_rad) == pytest.approx(0.0, abs=0.03)
    assert not found.is_held


def test_without_a_heading_the_robot_stops_as_it_came() -> None:
    found = follow(lambda start: ToPose(start, Pose(0.3, 0.3, -2.0), with_heading=False), noise=False)
    assert (found.end.x_m, found.end.y_m) == pytest.approx((0.3, 0.3), abs=0.002)
    assert found.end.yaw_rad == pytest.approx(math.pi / 4, abs=0.02)


def test_speeds_are_those_that_are_wanted_or_possible() -> None:
    found = follow(lambda start: Distance(start, 0.5, 0.05))
    assert max(one.linear_m_s for one in found.velocities) == 0.05
    assert found.seconds == pytest.approx(0.5 / 0.05, rel=0.2)
    found = follow(lambda start: Distance(start, 0.5, 9.0))
    assert max(one.linear_m_s for one in found.velocities) == MAX_SPEED_M_S
    found = follow(lambda start: Turn(start, 3.0, 99.0))
    assert max(one.angular_rad_s for one in found.velocities) == MAX_TURN_RAD_S
    found = follow(lambda start: ToPose(start, Pose(0.3, 0.3, 0.0), largest_m_s=0.04, largest_rad_s=0.5))
    assert max(one.linear_m_s for one in found.velocities) == 0.04
    assert max(abs(one.angular_rad_s) for one in found.velocities) == 0.5


@MODELS
def test_a_wall_holds_the_robot_and_ends_the_motion(motors: str) -> None:
    wall = box(0.25, 0.0, 0.1, 1.0)
    for law in (lambda start: Distance(start, 1.0), lambda start: ToPose(start, Pose(1.0, 0.0, 0.0))):
        found = follow(law, wall, motors=motors)
        assert found.is_held
        assert found.robot.pose.x_m < 0.13
        assert found.seconds < 4.5


@MODELS
def test_a_slow_motion_is_not_a_stall(motors: str) -> None:
    found = follow(lambda start: Distance(start, 0.03, 0.006), motors=motors)
    assert not found.is_held
    assert found.end.x_m == pytest.approx(0.03, abs=0.003)


def test_the_same_run_gives_the_same_motion() -> None:
    first, second = (follow(lambda start: ToPose(start, Pose(0.4, -0.2, 1.0))) for _ in range(2))
    assert first.velocities == second.velocities
    assert first.end == second.end
