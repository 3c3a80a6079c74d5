"""Goals of a profile's actions on both ROS graphs, with an action that the wheels have: a motion in simulated time."""

from __future__ import annotations

import pytest
from action_msgs.msg import GoalStatus
from rcl_interfaces.msg import Log
from rclpy.action import ActionClient
from test_msgs.action import Fibonacci

from thymio_sim_ros.ros.profiles import ActionRow, Ended, Profile
from thymio_sim_ros.ros.simulator.node import Simulator, SimulatorParams
from thymio_sim_ros.sim.commands import BodyTwist, Lift, MoveRobot
from thymio_sim_ros.testing.ros import Simulation


class _Drive:
    """Drives so many centimeters; a wall of numbers ends it at 9."""

    def __init__(self, goal, robot):
        if goal.order <= 0:
            raise ValueError(f"order is {goal.order}, expected a distance above 0 cm")
        self.robot, self.order, self.start = robot, goal.order, robot.pose.x_m

    def way_cm(self):
        return 100 * (self.robot.pose.x_m - self.start)

    def step(self):
        if self.way_cm() >= self.order:
            return Ended()
        if self.way_cm() >= 9.0:
            return Ended("9 cm are enough")
        self.robot.post(BodyTwist(0.1, 0.0))
        return None

    def feedback(self, kind):
        return kind(sequence=[int(self.way_cm())])

    def result(self, kind):
        return kind(sequence=[round(self.way_cm())])

    def stop(self):
        self.robot.post(BodyTwist(0.0, 0.0))


PROFILE = Profile("driver", "drives", actions=(ActionRow("drive_cm", "test_msgs/action/Fibonacci", _Drive),))


@pytest.fixture
def sim(ros):
    simulator = ros.live(Simulator(ros.context, SimulatorParams(start_paused=True), profile=PROFILE))
    return Simulation(ros, simulator)


@pytest.fixture
def send(ros, sim):
    client = ActionClient(ros.node, Fibonacci, "/drive_cm")
    feedback = []

    def send(order):
        ros.until(client.server_is_ready)
        sent = client.send_goal_async(
            Fibonacci.Goal(order=order), lambda got: feedback.append(got.feedback.sequence[0])
        )
        return ros.until(lambda: sent.done() and sent).result(), feedback

    yield send
    client.destroy()


def ended(sim, handle, seconds=10.0):
    result = handle.get_result_async()
    sim.until(result.done, seconds)
    return result.result()


def test_a_goal_that_is_reached_has_feedback_and_a_result(sim, send):
    handle, feedback = send(5)
    done = ended(sim, handle)
    assert (done.status, list(done.result.sequence)) == (GoalStatus.STATUS_SUCCEEDED, [5])
    assert feedback == sorted(feedback)
    assert {0, 2, 4} <= set(feedback)


def test_one_that_is_not_reached_says_why(ros, sim, send):
    logged = ros.collect(Log, "/rosout")
    handle, _ = send(30)
    done = ended(sim, handle)
    assert (done.status, list(done.result.sequence)) == (GoalStatus.STATUS_ABORTED, [9])
    ros.until(lambda: any("/drive_cm: the goal was not reached: 9 cm are enough" in line.msg for line in logged))


def test_a_new_one_replaces_it_and_one_can_be_canceled_also_while_paused(ros, sim, send):
    first, _ = send(8)
    sim.step(0.3)
    second, _ = send(8)
    assert ended(sim, first).status == GoalStatus.STATUS_ABORTED
    canceled, result = second.cancel_goal_async(), second.get_result_async()
    ros.until(lambda: canceled.done() and result.done())
    assert result.result().status == GoalStatus.STATUS_CANCELED


def test_a_wrong_goal_is_rejected_with_the_reason(sim, send):
    handle, _ = send(-3)
    assert not handle.accepted
    assert any(
        "/drive_cm rejected: order is -3, expected a distance above 0" in fault
        for fault in sim.simulator.runner.state().faults
    )


def test_a_robot_that_is_lifted_gets_no_goal(sim, send):
    (name,) = sim.world.robots
    sim.engine.post(name, Lift(True))
    sim.step(0.1)
    assert not send(5)[0].accepted
    assert any(
        "rejected: the robot is lifted, expected it on the ground" in fault
        for fault in sim.simulator.runner.state().faults
    )


def test_one_whose_robot_falls_off_a_table_ends_and_the_next_is_rejected(ros, sim, send):
    logged = ros.collect(Log, "/rosout")
    handle, _ = send(8)
    (name,) = sim.world.robots
    sim.engine.post(name, MoveRobot(40.0, 40.0, 0.0))
    done = ended(sim, handle)
    assert done.status == GoalStatus.STATUS_ABORTED
    ros.until(lambda: any("not reached: the robot has fallen off its ground" in line.msg for line in logged))
    assert not send(5)[0].accepted
    assert any(
        "rejected: the robot has fallen off its ground; put it back" in fault
        for fault in sim.simulator.runner.state().faults
    )


def test_a_goal_ends_with_a_reset(sim, send):
    handle, _ = send(8)
    sim.step(0.2)
    sim.reset()
    assert ended(sim, handle).status == GoalStatus.STATUS_ABORTED
