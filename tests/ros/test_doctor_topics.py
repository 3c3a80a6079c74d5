"""Which topics the doctor lists: those of nodes outside the suite."""

from __future__ import annotations

import pytest

pytest.importorskip("rclpy")

from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import String

from thymio_sim_ros.ros.doctor import _Doctor
from thymio_sim_ros.ros.rclpy_ext.peers import PUBLISHING_PEER, SUBSCRIBING_PEER


@pytest.fixture
def nodes(ros):
    """A node of each name, which subscribes to what the simulator publishes, and the other way round."""
    made = {
        name: Node(name, context=ros.context, enable_rosout=False, start_parameter_services=False)
        for name in ("simulator", SUBSCRIBING_PEER, PUBLISHING_PEER, "student", "_thymio_doctor")
    }
    made["simulator"].create_publisher(String, "/odom", 10)
    made["simulator"].create_subscription(String, "/cmd_vel", print, 10)
    made[SUBSCRIBING_PEER].create_subscription(String, "/odom", print, 10)
    made[PUBLISHING_PEER].create_publisher(String, "/cmd_vel", 10)
    yield made
    for node in made.values():
        node.destroy_node()


def test_what_the_bridge_uses_for_its_clients_is_not_listed(ros, nodes):
    doctor = _Doctor(nodes["_thymio_doctor"], SingleThreadedExecutor(context=ros.context), "", "")
    assert list(doctor._uses()) == []
    nodes["student"].create_subscription(String, "/odom", print, 10)
    (use,) = doctor._uses()
    assert (use.name, use.publishers, use.subscribers) == (
        "/odom",
        ("/simulator",),
        (f"/{SUBSCRIBING_PEER}", "/student"),
    )
