"""The device manager of a runtime and the topics of the same robots: programs, events, variables, names."""

from __future__ import annotations

import json
from concurrent.futures import ThreadPoolExecutor

import pytest
from std_msgs.msg import Int16MultiArray, String

from tests.network.tdm.raw_client import RawClient
from tests.network.tdm.talk import values
from tests.ros.aseba_tools import Status, event
from thymio_sim_ros.network.settings import OFF
from thymio_sim_ros.network.tdm.protocol import messages as m
from thymio_sim_ros.network.tdm.protocol.constants import Command, VMState, Watch
from thymio_sim_ros.network.tdm.protocol.constants import Status as NodeStatus
from thymio_sim_ros.network.tdm.protocol.values import encode_value
from thymio_sim_ros.ros.aseba.parameters import NetworkParams

TEXT = "var n = 3\nonevent ping\nn = event.args[0] * 2\nemit pong n\n"
TABLE = (m.EventDescription("ping", 1), m.EventDescription("pong", 1))


@pytest.fixture
def manager(ros, runtime):
    """Start a runtime with a device manager; return functions that run in another thread while the executor spins."""
    pool = ThreadPoolExecutor(1)
    clients = []

    def start(source="", **parameters):
        node = runtime(source, network=NetworkParams(tdm_port=0, tdm_ws_port=0, announce=False), **parameters)
        ros.until(lambda: node.network.servers.tdm_ports[0] != OFF, what="the ports are open")
        clients.append(start.work(lambda: RawClient(node.network.servers.tdm_ports[0], greet=False)))
        clients[-1].send(m.ConnectionHandshake())
        return clients[-1]

    def work(function):
        future = pool.submit(function)
        ros.until(future.done, what="the client has its answers")
        return future.result()

    start.work = work
    yield start
    for one in clients:
        one.socket.close()
    pool.shutdown()


def _robots(client, count):
    """Wait until all robots are there; return their ids by name."""
    found = {}
    while len(found) < count:
        found |= {node.name: node.node_id for node in client.wait_for(m.NodesChanged).nodes}
    return found


def _use(client, key):
    """Lock a robot, load the program, and run it."""
    client.send(m.LockNode(1, key))
    client.wait_for(m.RequestCompleted)
    client.send(m.RegisterEvents(2, key, TABLE))
    client.wait_for(m.RequestCompleted)
    client.send(m.WatchNode(3, key, Watch.EVENTS | Watch.VM_STATE))
    client.wait_for(m.RequestCompleted)
    client.send(m.CompileAndLoadCodeOnVM(4, key, 1, TEXT, 2))
    client.wait_for(m.CompilationResultSuccess)
    client.send(m.SetVMExecutionState(5, key, Command.RUN))
    client.wait_for(m.VMExecutionStateChanged, lambda message: message.state == VMState.RUNNING)


def test_a_program_of_a_client_runs_on_the_robot_and_its_events_have_topics(ros, manager):
    client = manager()
    status, pongs = Status(ros), ros.collect(Int16MultiArray, "/_aseba/events")
    targets = ros.collect(String, "/_aseba/target", transient_local=True)
    (key,) = manager.work(lambda: _robots(client, 1)).values()
    manager.work(lambda: _use(client, key))
    ros.until(lambda: status["program"] == "from the network")
    described = json.loads(targets[-1].data)["program"]
    assert not described["foreign"]
    assert [one["name"] for one in described["events"]] == ["ping", "pong"]

    def exchange():
        client.send(m.SendEvents(6, key, (m.NamedValue("ping", encode_value((21,))),)))
        return values(client.wait_for(m.EventsEmitted))

    assert manager.work(exchange) == {"pong": (42,)}
    ros.until(lambda: [42] in [list(message.data) for message in pongs])


def test_variables_of_sensors_and_programs_are_watched(ros, manager):
    client = manager()
    (key,) = manager.work(lambda: _robots(client, 1)).values()

    def watch():
        _use(client, key)
        client.send(m.WatchNode(7, key, Watch.VARIABLES))
        dump = values(client.wait_for(m.VariablesChanged))
        client.send(m.SetVariables(8, key, (m.NamedValue("n", encode_value((-7,))),)))
        changed = client.wait_for(m.VariablesChanged, lambda message: "n" in values(message))
        return dump, values(changed)

    dump, changed = manager.work(watch)
    assert dump["n"] == (3,)
    assert dump["_fwversion"][0] == 14
    assert len(dump["prox.horizontal"]) == 7
    assert changed["n"] == (-7,)


def test_what_a_program_answers_to_ros_is_shown_to_clients(ros, manager):
    client = manager()
    (key,) = manager.work(lambda: _robots(client, 1)).values()
    emit = ros.publisher(Int16MultiArray, "/_aseba/emit")
    manager.work(lambda: _use(client, key))
    emit.publish(event("ping", 5))
    assert values(manager.work(lambda: client.wait_for(m.EventsEmitted))) == {"pong": (10,)}


def test_each_robot_has_its_name_and_can_be_locked_alone(ros, manager):
    client = manager(robots=["red", "blue"])
    robots = manager.work(lambda: _robots(client, 2))
    assert set(robots) == {"red", "blue"}
    manager.work(lambda: _use(client, robots["blue"]))

    def look():
        client.send(m.RequestListOfNodes())
        listed = client.wait_for(m.NodesChanged, lambda message: len(message.nodes) == 2)
        return {node.name: node.status for node in listed.nodes}

    assert manager.work(look) == {"red": NodeStatus.AVAILABLE, "blue": NodeStatus.READY}
