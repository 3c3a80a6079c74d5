"""The operator's hand."""

from __future__ import annotations

from tests.sim.builders import FLOOR, make, send
from tests.sim.fake_view import FakeBody, FakeView
from thymio_sim_ros.sim.commands import MoveRobot, ResetOdometry, Tilt
from thymio_sim_ros.sim.mechanics.wheels import Wheels
from thymio_sim_ros.sim.model import geometry
from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.stimuli.handling import STIMULUS, HandlingState
from thymio_sim_ros.sim.world import World


def test_the_hand_puts_the_robot_down_once() -> None:
    assert STIMULUS.update is not None
    state, view = HandlingState(), FakeView()
    STIMULUS.apply(state, MoveRobot(1.0, 2.0, 3.0), 0)
    STIMULUS.update(state, view, 0.01)
    assert view.pose == Pose(1.0, 2.0, 3.0)
    view.pose = Pose(0.0, 0.0, 0.0)
    STIMULUS.update(state, view, 0.01)
    assert view.pose == Pose(0.0, 0.0, 0.0)


def test_what_the_hand_does_within_a_tick_it_does_once_and_in_order() -> None:
    assert STIMULUS.update is not None
    state, view = HandlingState(), FakeView()
    for command in (MoveRobot(1.0, 2.0, 3.0), ResetOdometry(), MoveRobot(4.0, 5.0, 6.0)):
        STIMULUS.apply(state, command, 0)
    STIMULUS.update(state, view, 0.01)
    assert view.pose == Pose(4.0, 5.0, 6.0)
    view.pose = Pose(0.0, 0.0, 0.0)
    STIMULUS.update(state, view, 0.01)
    assert view.pose == Pose(0.0, 0.0, 0.0)


def test_the_hand_zeroes_the_odometry() -> None:
    assert STIMULUS.update is not None
    body = FakeBody()
    state, view = HandlingState(), FakeView(wheels=Wheels(body))
    body.state.odometry_x[0], body.state.odometry_yaw[0] = 0.1, 0.2
    STIMULUS.apply(state, ResetOdometry(), 0)
    STIMULUS.update(state, view, 0.01)
    assert view.wheels.odometry == Pose(0.0, 0.0, 0.0)


def test_a_robot_in_the_hand_leans_for_all_to_see() -> None:
    world = World(make([FLOOR]))
    send(world, Tilt(0.25, -0.5))
    world.step()
    assert world.snapshot().robots[0].tilt == geometry.Tilt(0.25, -0.5)
    world.reset()
    assert world.snapshot().robots[0].tilt == geometry.LEVEL
