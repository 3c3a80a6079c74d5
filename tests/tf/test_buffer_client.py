"""The client of a server of transforms, where the types of its action are installed: on the embedded graph, always."""

from __future__ import annotations

import inspect
import threading

import pytest
import rclpy
from geometry_msgs.msg import TransformStamped
from rclpy.action import ActionServer
from rclpy.context import Context
from rclpy.duration import Duration
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.time import Time

from tests.patience import PATIENCE_S
from thymio_sim_ros import course_packages
from thymio_sim_ros.tf.buffer import Buffer
from thymio_sim_ros.tf.errors import (
    ConnectivityException,
    ExtrapolationException,
    LookupException,
    TimeoutException,
    TransformException,
)

pytestmark = pytest.mark.skipif(not course_packages.is_installed("tf2_msgs"), reason="this ROS has no tf2_msgs")
PATIENCE = Duration(seconds=PATIENCE_S)


def stamped(frame, child, seconds, x):
    message = TransformStamped(child_frame_id=child)
    message.header.frame_id, message.header.stamp = frame, Time(seconds=seconds).to_msg()
    message.transform.translation.x, message.transform.rotation.w = x, 1.0
    return message


class Server:
    """A server of transforms on a buffer of its own."""

    def __init__(self, node, name):
        from tf2_msgs.action import LookupTransform

        self.kind, self.buffer, self.asked = LookupTransform, Buffer(node=node), []
        self.error = None
        self.released = threading.Event()
        self.released.set()
        self.action_server = ActionServer(node, LookupTransform, name, self.execute)

    def execute(self, goal):
        asked = goal.request
        self.asked.append(asked)
        self.released.wait(PATIENCE_S)
        result = self.kind.Result()
        try:
            if asked.advanced:
                times = asked.target_time, asked.source_frame, asked.source_time, asked.fixed_frame
                result.transform = self.buffer.lookup_transform_full(asked.target_frame, *times)
            else:
                names = asked.target_frame, asked.source_frame
                result.transform = self.buffer.lookup_transform(*names, asked.source_time)
        except TransformException as error:
            codes = {LookupException: 1, ConnectivityException: 2, ExtrapolationException: 3}
            result.error.error, result.error.error_string = codes[type(error)], str(error)
        if self.error is not None:
            result.error.error = self.error
        goal.succeed()
        return result


@pytest.fixture
def graph():
    """A node that another thread spins."""
    context = Context()
    rclpy.init(context=context)
    node = rclpy.create_node("asks", context=context)
    executor = MultiThreadedExecutor(context=context)
    executor.add_node(node)

    def spin():
        try:
            executor.spin()
        except ExternalShutdownException:
            return

    thread = threading.Thread(target=spin)
    thread.start()
    yield node
    rclpy.shutdown(context=context)
    thread.join(PATIENCE_S)
    executor.shutdown()
    node.destroy_node()


@pytest.fixture
def client(graph):
    from thymio_sim_ros.tf.buffer_client import BufferClient

    made = BufferClient(graph, "lookup", timeout_padding=PATIENCE)
    yield made
    made.destroy()


def test_a_client_gets_what_the_server_knows(graph, client):
    server = Server(graph, "lookup")
    assert client.action_client.wait_for_server(PATIENCE_S)
    for message in (stamped("map", "odom", 1.0, 2.0), stamped("map", "odom", 3.0, 4.0)):
        server.buffer.set_transform(message, "test")
    at = Time(seconds=2.0)
    assert client.lookup_transform("map", "odom", at).transform.translation.x == 3.0
    assert client.lookup_transform("map", "odom", at.to_msg(), Duration(seconds=0.5)).header.stamp.sec == 2
    assert server.asked[-1].timeout.nanosec == 500_000_000
    moved = client.lookup_transform_full("odom", Time(seconds=3.0), "odom", Time(seconds=1.0), "map")
    assert moved.transform.translation.x == -2.0
    assert server.asked[-1].advanced
    assert client.can_transform("map", "odom", Time())
    assert client.can_transform_full("odom", Time(), "odom", Time(), "map")


def test_errors_of_the_server_are_exceptions(graph, client):
    server = Server(graph, "lookup")
    assert client.action_client.wait_for_server(PATIENCE_S)
    server.buffer.set_transform(stamped("map", "odom", 1.0, 2.0), "test")
    server.buffer.set_transform(stamped("other", "base", 1.0, 2.0), "test")
    with pytest.raises(
        LookupException, match='"nothing" passed to lookupTransform argument target_frame does not exist'
    ):
        client.lookup_transform("nothing", "odom", Time())
    with pytest.raises(ConnectivityException):
        client.lookup_transform("map", "base", Time())
    with pytest.raises(ExtrapolationException):
        client.lookup_transform("map", "odom", Time(seconds=9.0))
    assert not client.can_transform("map", "base", Time())
    assert not client.can_transform_full("map", Time(), "base", Time(), "map")
    server.error = 6  # an error without a class of its own
    with pytest.raises(TransformException):
        client.lookup_transform("map", "odom", Time())


def test_a_client_says_who_does_not_reply(graph):
    from thymio_sim_ros.tf.buffer_client import BufferClient

    client = BufferClient(graph, "lookup", timeout_padding=Duration(seconds=0.05))
    with pytest.raises(TimeoutException, match="no server has the action /lookup"):
        client.lookup_transform("map", "odom", Time())
    server = Server(graph, "lookup")
    server.released.clear()
    assert client.action_client.wait_for_server(PATIENCE_S)
    with pytest.raises(TimeoutException, match="the server of /lookup did not reply in time"):
        client.lookup_transform("map", "odom", Time())
    server.released.set()
    client.destroy()


def test_a_buffer_with_a_node_has_the_service_of_its_frames(graph):
    from tf2_msgs.srv import FrameGraph

    buffer = Buffer(node=graph)
    buffer.set_transform(stamped("map", "odom", 1.0, 2.0), "test")
    asks = graph.create_client(FrameGraph, "tf2_frames")
    assert asks.wait_for_service(PATIENCE_S)
    assert "parent: 'map'" in asks.call(FrameGraph.Request(), PATIENCE_S).frame_yaml


def test_the_client_has_the_arguments_of_the_original():
    from thymio_sim_ros.tf.buffer_client import BufferClient

    assert list(inspect.signature(BufferClient).parameters) == ["node", "ns", "check_frequency", "timeout_padding"]
