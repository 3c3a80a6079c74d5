"""`thymio-sim` in a process of its own, whose endpoints DDS does not match with each other: all of them are there, and
its nodes reach each other all the same.
"""

from __future__ import annotations

import pytest
from nav_msgs.msg import Odometry
from rclpy.serialization import serialize_message
from std_msgs.msg import String
from std_srvs.srv import Trigger

from tests.bridge.studio import Studio, set_and_answer
from tests.patience import PATIENCE_S
from tests.processes import Process, free_port, wait_for_port
from thymio_sim_ros.bridge.protocol import messages as ms
from thymio_sim_ros.ros import combined
from thymio_sim_ros.ros.compat import dds_profile
from thymio_sim_ros.suite_config import SuiteConfig

pytestmark = pytest.mark.process

ROBOTS = ("blue", "red")
NODES = {"simulator", "aseba_runtime", "foxglove_bridge", "web_ui"}


@pytest.fixture
def start(ros_domain, tmp_path, monkeypatch):
    """Start `thymio-sim` with arguments, without a DDS profile of the user; return the port of its bridge."""
    for variable in (dds_profile.VARIABLE, "FASTDDS_DEFAULT_PROFILES_FILE", "RMW_FASTRTPS_USE_QOS_FROM_XML"):
        monkeypatch.delenv(variable, raising=False)
    started = []

    def run(*arguments: str) -> int:
        foxglove_port = free_port()
        ports = ("--port", str(free_port()), "--foxglove-port", str(foxglove_port))
        started.append(Process(tmp_path, "thymio_sim_ros.cli.main", *ports, *arguments))
        return foxglove_port

    yield run
    for process in started:
        process.end()


@pytest.fixture
def studio(ros, start):
    """A client of the bridge of a suite with two robots without a program."""
    port = start("--playground", "two_robots", "--program", "none")
    wait_for_port(port)
    with Studio(port, lambda condition, what="": ros.until(condition, PATIENCE_S, what=what)) as client:
        yield client


def endpoints(ros, names):
    """Publishers, subscriptions and services of the given nodes together, without those that each has for itself."""
    found = set()
    for name in names:
        for kind in ("publisher", "subscriber", "service"):
            ask = getattr(ros.node, f"get_{kind}_names_and_types_by_node")
            found |= {(kind, topic, *types) for topic, types in ask(name, "/")}
    return found


def test_every_endpoint_of_nodes_that_match_each_other_is_there(ros, start):
    suite = SuiteConfig(playground="two_robots", port=0, foxglove_port=free_port())
    for life in combined.suite_nodes(ros.context, suite):
        ros.live(life)
    ros.until(lambda: set(ros.node.get_node_names()) >= NODES)
    promised = endpoints(ros, NODES)
    assert len(promised) > 300
    for life in [*ros._lives]:
        ros.end(life)
    ros.until(lambda: not NODES & set(ros.node.get_node_names()), what="the end of the nodes")
    start("--playground", "two_robots")
    ros.until(lambda: set(ros.node.get_node_names()) >= NODES, PATIENCE_S, what="the nodes of the process")
    hidden = {"_foxglove_subscriber", "_foxglove_publisher"}
    ros.until(lambda: set(ros.node.get_node_names()) >= hidden, PATIENCE_S, what="the peers")
    ros.until(lambda: endpoints(ros, NODES | hidden) >= promised, PATIENCE_S, what="every endpoint")


def test_programs_drive_all_robots(ros, start):
    start("--playground", "two_robots", "--program", "explorer", "--headless")
    odometry: dict[str, Odometry] = {}
    for name in ROBOTS:
        ros.node.create_subscription(
            Odometry, f"/{name}/odom", lambda message, name=name: odometry.update({name: message}), 10
        )
    ros.until(
        lambda: len(odometry) == 2 and all(abs(one.twist.twist.linear.x) > 0.01 for one in odometry.values()),
        PATIENCE_S,
        what="two robots that drive",
    )


def test_time_reaches_the_programs(ros, start):
    start("--playground", "line", "--program", "line_follower", "--headless")
    driven: list[Odometry] = []
    ros.node.create_subscription(Odometry, "/odom", driven.append, 10)
    ros.until(lambda: driven and driven[-1].pose.pose.position.x > 0.02, PATIENCE_S, what="a robot that drives")
    ros.call(Trigger, "/simulator/reset")
    driven.clear()
    ros.until(lambda: driven and driven[-1].pose.pose.position.x > 0.02, PATIENCE_S, what="a program that restarts")


def test_a_client_of_the_bridge_reaches_all_nodes_and_other_clients(ros, studio):
    studio.subscribe(1, "/red/odom")
    studio.next(ms.MessageData, lambda message: message.subscription_id == 1)
    studio.advertise(1, "/chat", "std_msgs/msg/String")
    studio.subscribe(2, "/chat")
    text = serialize_message(String(data="hello"))

    def is_heard():
        studio.send(ms.ClientMessageData(1, text))
        studio.read()
        return any(isinstance(one, ms.MessageData) and one.payload == text for one in studio.received)

    ros.until(is_heard, PATIENCE_S, what="the message of a client")
    service = studio.service("/red/reset_odometry")
    studio.send(ms.ServiceRequest(service.id, 5, "cdr", serialize_message(Trigger.Request())))
    assert studio.next(ms.ServiceResponse).call_id == 5
    for parameter in ("/simulator.real_time_factor", "/aseba_runtime.watch_rate", "/foxglove_bridge.port"):
        assert studio.parameter(parameter) is not None
    answer = set_and_answer(studio, ms.Parameter("/simulator.real_time_factor", 2.0))[-1]
    assert [one.value for one in answer.parameters] == [2.0]
