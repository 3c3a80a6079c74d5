"""Tools of an Aseba network and the topics of the same robot: programs, events, variables, faults."""

from __future__ import annotations

import json
from concurrent.futures import ThreadPoolExecutor

import pytest
from std_msgs.msg import Int16MultiArray, String

from aseba_vm.protocol import (
    ExecutionStateChanged,
    GetNodeDescription,
    GetVariables,
    ListNodes,
    NodePresent,
    Pause,
    Run,
    SetBytecode,
    SetVariables,
    UserMessage,
    Variables,
)
from aseba_vm.protocol.messages import NativeFunctionDescription
from tests.device.test_network_node import compiled
from tests.network.aseba_client import AsebaClient
from tests.ros.aseba_tools import Status, event, get_variables, set_parameters
from thymio_sim_ros.device.layout import target
from thymio_sim_ros.ros.aseba.parameters import NetworkParams
from thymio_sim_ros.ros.interface.names import RobotNames
from thymio_sim_ros.ros.rclpy_ext.node_runner import StartError

FILE = '<network><event size="1" name="ping"/><event size="1" name="pong"/><node name="thymio-II">{}</node></network>'
OWN = FILE.format("var own = 5\nonevent ping\nown = event.args[0]\nemit pong own\n")
FROM_TOOL = "var n = 3\nonevent ping\nn = event.args[0] * 2\nemit pong n\n"
EVENTS = (("ping", 1), ("pong", 1))


@pytest.fixture
def network(ros, runtime):
    """Start a runtime with Aseba ports; return functions that run in another thread while the executor spins."""
    pool = ThreadPoolExecutor(1)
    clients = []

    def start(source="", **parameters):
        node = runtime(source, network=NetworkParams(aseba_port=0, announce=False), **parameters)
        ros.until(lambda: len(node.network.servers.ports) == len(node.robots), what="the ports are open")
        return node

    def work(function):
        future = pool.submit(function)
        ros.until(future.done, what="the client has its answers")
        return future.result()

    def client(node, robot=""):
        clients.append(AsebaClient(node.network.servers.ports[robot]))
        return clients[-1]

    start.work, start.client = work, client
    yield start
    for one in clients:
        one.close()
    pool.shutdown()


def load(client, source=FROM_TOOL, node=1):
    """Load and run a program as Studio does."""
    client.send(SetBytecode(0, node, 0, compiled(source, EVENTS).program.words), Run(0, node))
    while client.wait_for(ExecutionStateChanged).flags & 2:
        pass


def test_a_program_of_a_tool_runs_on_the_robot_and_its_topics_work(ros, network):
    node = network(OWN)
    status, client = Status(ros), network.client(node)
    targets = ros.collect(String, "/_aseba/target", transient_local=True)
    network.work(lambda: load(client))
    ros.until(lambda: status["program"] == "from the network")
    described = json.loads(targets[-1].data)["program"]
    assert described["foreign"]
    assert "onevent ping" in described["source"]
    assert [one["name"] for one in described["events"]] == ["ping", "pong"]
    # an event from ROS: the answer goes to the topic and to the tool
    answers = ros.collect(Int16MultiArray, "/aseba/events/pong")
    emit = ros.publisher(Int16MultiArray, "/_aseba/emit")
    emit.publish(event("ping", 21))
    ros.until(lambda: [list(message.data) for message in answers] == [[42]])
    assert network.work(lambda: client.wait_for(UserMessage)) == UserMessage(1, 1, (42,))
    # an event from the tool: the answer goes to both too
    assert network.work(lambda: client.ask(UserMessage(0, 0, (5,)), UserMessage)) == UserMessage(1, 1, (10,))
    ros.until(lambda: [list(message.data) for message in answers] == [[42], [10]])


def test_the_same_text_replaces_a_program_of_a_tool(ros, network):
    node = network(OWN)
    status, client = Status(ros), network.client(node)
    network.work(lambda: load(client))
    ros.until(lambda: status["program"] == "from the network")
    assert set_parameters(ros, {"script.source": OWN}).successful
    ros.until(lambda: status["program"] != "from the network")
    assert get_variables(ros, "own") == [[5]]


def test_a_program_of_the_file_is_recognized(ros, network):
    node = network(OWN)
    status, client = Status(ros), network.client(node)
    network.work(lambda: load(client))
    ros.until(lambda: status["program"] == "from the network")
    network.work(lambda: load(client, node.robots[0]._own.source))
    ros.until(lambda: status["program"] == "program")
    assert get_variables(ros, "own") == [[5]]


def test_variables_and_pause_are_seen_on_both_sides(ros, network):
    node = network(OWN)
    status, client = Status(ros), network.client(node)
    address, _ = target().addresses["motor.left.target"]
    network.work(lambda: client.ask(ListNodes(0, 5), NodePresent))
    client.send(SetVariables(0, 1, address, (-77,)), Pause(0, 1))
    ros.until(lambda: status["state"] == "paused")
    assert get_variables(ros, "motor.left.target") == [[-77]]
    assert network.work(lambda: client.ask(GetVariables(0, 1, address, 1), Variables)).values == (-77,)


def test_an_unknown_server_on_the_page_is_rejected(runtime):
    with pytest.raises(StartError, match=r"network\.on_page: found 'ftp', expected some of tdm, http"):
        runtime("", network=NetworkParams(aseba_port=0, on_page=("tdm", "ftp")))


def test_robots_have_ports_in_order_and_keep_them(ros, network):
    node = network("", robots=["anna", "ben"])
    first, second = network.client(node, "anna"), network.client(node, "ben")
    assert network.work(lambda: first.ask(ListNodes(0, 9), NodePresent)) == NodePresent(1, 9)
    assert network.work(lambda: second.ask(ListNodes(0, 5), NodePresent)) == NodePresent(2, 5)
    ports = node.network.servers.ports
    node.robots.follow({"ben": RobotNames("ben")})
    ros.until(lambda: list(node.network.servers.ports) == ["ben"])
    assert node.network.servers.ports["ben"] == ports["ben"]
    assert network.work(lambda: first.is_closed_by_server)
    assert network.work(lambda: second.ask(ListNodes(0, 5), NodePresent)) == NodePresent(2, 5)


@pytest.mark.parametrize("is_shared", [False, True])
def test_events_without_names_reach_other_robots_on_a_shared_port_only(ros, network, is_shared):
    node = network("", robots=["anna", "ben"])
    node.robots.standalone.devices.shares_numbers = is_shared
    first, second = network.client(node, "anna"), network.client(node, "ben")
    address, _ = target().addresses["motor.left.target"]
    network.work(lambda: load(first, "onevent ping\nemit pong 7\n", 1))
    network.work(lambda: load(second, "onevent pong\nmotor.left.target = event.args[0]\n", 2))
    assert network.work(lambda: first.ask(UserMessage(0, 0, (5,)), UserMessage)) == UserMessage(1, 1, (7,))
    words = network.work(lambda: second.ask(GetVariables(0, 2, address, 1), Variables)).values
    assert words == ((7,) if is_shared else (0,))


def test_many_descriptions_at_once(ros, network):
    """Twenty requests in one write are answered completely."""
    node = network()
    client = network.client(node)
    last = target().natives[-1].name

    def ask():
        client.send(*[GetNodeDescription(0, 1, 5)] * 20)
        for _ in range(20):
            while client.wait_for(NativeFunctionDescription).name != last:
                pass

    network.work(ask)
