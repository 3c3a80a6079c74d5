"""Start and end of the bridge."""

from __future__ import annotations

import socket
import threading

import pytest
from std_msgs.msg import String

from tests.bridge.studio import Studio
from thymio_sim_ros.ros.foxglove.node import FoxgloveBridge
from thymio_sim_ros.ros.rclpy_ext.node_runner import StartError, make_executor


def test_a_port_in_use_is_reported_in_one_line(ros):
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        with pytest.raises(StartError, match=rf"cannot listen on 127\.0\.0\.1:{port}: address already in use"):
            FoxgloveBridge(context=ros.context, port=port)
    assert "foxglove_bridge" not in ros.node.get_node_names()


def test_closing_leaves_no_thread_no_port_and_no_node(ros):
    before = set(threading.enumerate())
    ros.node.create_publisher(String, "/chat", 10)
    life = FoxgloveBridge(context=ros.context, port=0)
    executor = make_executor(ros.context)
    executor.add_node(life.node)

    def until(condition, what):
        ros.until(lambda: life.run_once(executor) or condition(), what=what)

    with Studio(life.port, until) as studio:
        studio.subscribe(1, "/chat")
        until(lambda: ros.node.count_subscribers("/chat"), "a subscription")
        executor.remove_node(life.node)
        executor.shutdown()
        life.close()
    ros.until(lambda: set(threading.enumerate()) == before)
    ros.until(lambda: "foxglove_bridge" not in ros.node.get_node_names())
    with socket.create_server(("127.0.0.1", life.port)):
        pass


def test_the_startup_message_has_the_address_to_connect_to(bridge):
    life = bridge()
    assert f"ws://localhost:{life.port}" in life.startup_message
    assert f"ds.url=ws%3A%2F%2Flocalhost%3A{life.port}" in life.startup_message


@pytest.mark.parametrize(
    ("address", "host"), [("127.0.0.1", "localhost"), ("127.0.0.2", "127.0.0.2"), ("::1", "localhost")]
)
def test_the_startup_message_has_the_given_address(ros, address, host):
    try:
        life = FoxgloveBridge(context=ros.context, port=0, address=address)
    except StartError:
        pytest.skip(f"no {address} here")
    assert f"ws://{host}:{life.port}" in life.startup_message
    life.close()
