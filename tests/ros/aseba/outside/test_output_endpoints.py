"""Commands of programs to robots that are subscribed, that subscribe later, and that are restarted."""

from __future__ import annotations

import time
import types

import pytest
from geometry_msgs.msg import Twist
from std_msgs.msg import Float32MultiArray, Int16MultiArray

from thymio_sim_ros.ros.aseba.outside import output_endpoints
from thymio_sim_ros.ros.aseba.outside.output_endpoints import FRESH_S, OutputEndpoints
from thymio_sim_ros.ros.interface.names import RobotNames
from thymio_sim_ros.sim.commands import MotorTargets, PlayTone, SetLed
from thymio_sim_ros.sim.model.units import units_to_speed

KINDS = {"cmd_vel": Twist, "_led/single": Int16MultiArray, "sound/tone": Float32MultiArray}


def values(message):
    """The numbers of a command; of a velocity, that of both wheels together in units of the motors."""
    if isinstance(message, Twist):
        return [round(2.0 * message.linear.x / units_to_speed(1))]
    return list(message.data)


class Robot:
    """A subscriber of commands of a program, until `leave` is called."""

    def __init__(self, ros, topics=tuple(KINDS)):
        self.heard: list[list[float]] = []
        self._ros, self._node = ros, ros.make_node("robot")
        for topic in topics:
            self._node.create_subscription(KINDS[topic], topic, lambda message: self.heard.append(values(message)), 10)
        ros.settle()

    def leave(self):
        self._ros.stop(self._node)


@pytest.fixture
def outputs(ros):
    """The outputs of a robot without a name."""
    outputs = OutputEndpoints(ros.node, RobotNames(""))
    outputs.start_program()
    yield outputs
    outputs.close()


def resend(ros, outputs):
    """Resend twice: the first poll finds new subscribers, the second one that discovery is quiet."""
    for _ in range(2):
        outputs.resend()
    ros.settle()
    ros.deliver()


def test_a_late_subscriber_gets_unreceived_commands_once(ros, outputs):
    for command in (MotorTargets(1, 2), PlayTone(440.0, None), MotorTargets(3, 4)):
        outputs.send(command)
    robot = Robot(ros)
    resend(ros, outputs)
    resend(ros, outputs)
    assert sorted(robot.heard) == [[7], [440.0, 0.0]]


def test_lights_that_were_set_one_by_one_are_sent_again_in_order(ros, outputs):
    for command in (SetLed(1, 10), SetLed(2, 20), SetLed(1, 30)):
        outputs.send(command)
    robot = Robot(ros, ["_led/single"])
    resend(ros, outputs)
    assert robot.heard == [[2, 20], [1, 30]]


def test_a_subscriber_that_got_everything_gets_nothing_twice(ros, outputs):
    robot = Robot(ros)
    resend(ros, outputs)
    for command in (MotorTargets(1, 2), PlayTone(440.0, None)):
        outputs.send(command)
    resend(ros, outputs)
    assert sorted(robot.heard) == [[3], [440.0, 0.0]]


def test_a_restarted_robot_gets_the_retained_commands(ros, outputs):
    first = Robot(ros)
    resend(ros, outputs)
    for command in (MotorTargets(1, 2), PlayTone(440.0, None)):
        outputs.send(command)
    first.leave()
    ros.settle()
    resend(ros, outputs)
    again = Robot(ros)
    resend(ros, outputs)
    assert again.heard == [[3]]


@pytest.mark.parametrize(("later_s", "heard"), [(0.0, [[3]]), (FRESH_S, [])])
def test_with_another_subscriber_only_fresh_commands_are_sent_again(ros, outputs, monkeypatch, later_s, heard):
    """Discovery reports a killed robot as a subscriber for a while; a late viewer must not start a movement."""
    Robot(ros)
    resend(ros, outputs)
    outputs.send(MotorTargets(1, 2))
    now_s = time.monotonic() + later_s
    monkeypatch.setattr(output_endpoints, "time", types.SimpleNamespace(monotonic=lambda: now_s))
    other = Robot(ros)
    resend(ros, outputs)
    assert other.heard == heard
