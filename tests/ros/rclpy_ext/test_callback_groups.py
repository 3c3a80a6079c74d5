"""Nodes of a suite do not keep references to endpoints that were destroyed, which rclpy does."""

from __future__ import annotations

import gc

import pytest
from rclpy.node import Node
from std_msgs.msg import Bool

from thymio_sim_ros.ros.rclpy_ext.parameter_node import ParameterNode
from thymio_sim_ros.ros.rclpy_ext.peers import PeerContext


@pytest.fixture(params=["node", "peer"])
def node(request, ros):
    """A node of each kind that a suite has."""
    if request.param == "node":
        created = ParameterNode("forgetful", context=ros.context)
        yield created
        created.destroy_node()
        return
    peers = PeerContext([])
    yield peers.node("_forgetful")
    peers.close()


def test_a_group_forgets_subscriptions_that_are_destroyed(node: Node) -> None:
    group = node.default_callback_group
    before = len(group.entities)
    for _ in range(20):
        node.destroy_subscription(node.create_subscription(Bool, "/passing", lambda message: None, 10))
    gc.collect()
    assert len(group.entities) == before


def test_a_group_knows_those_that_are_there(node: Node) -> None:
    subscription = node.create_subscription(Bool, "/staying", lambda message: None, 10)
    assert node.default_callback_group.has_entity(subscription)
