"""The Aseba runtime with a robot in its process, or with one behind an Aseba network."""

from __future__ import annotations

import pytest

from tests.network.served_robot import ServedRobot

HERE, BEHIND_A_NETWORK = "here", "behind a network"
PLACES = (HERE, BEHIND_A_NETWORK)


@pytest.fixture
def served_robot():
    """A robot of ours behind the Aseba server."""
    robot = ServedRobot()
    yield robot
    robot.close()


@pytest.fixture
def remote_runtime(ros, served_robot):
    """Make a runtime whose robot is `served_robot`, and wait until its program runs there."""
    from thymio_sim_ros.ros.aseba.node import AsebaRuntime, RuntimeParams

    def make(source="", **parameters):
        address = f"tcp:127.0.0.1:{served_robot.port}"
        defaults = RuntimeParams(source=source, robot=address, **parameters)
        node = ros.live(AsebaRuntime(ros.context, defaults, use_sim_time=False))
        ros.settle()
        wait_until_it_runs(ros, node)
        return node

    return make


def wait_until_it_runs(ros, node):
    """Wait until a real robot runs its program and its variables have been read since."""
    (robot,) = node.robots
    session = node.robots._real.robot._session

    def is_read():
        known = session.node
        return all(known.value(name) is not None for name in robot.device.variables.addresses())

    ros.until(lambda: session.node is not None and session.node.state is not None, what="the robot is connected")
    ros.until(is_read, what="its variables have been read")
    session.node.set_program(session.program.program)  # the first values may be those before the initialization
    ros.until(is_read, what="its variables have been read again")
