"""Clients of rosbridge that are nodes, and that follow the graph."""

from __future__ import annotations

import pytest
from rclpy.serialization import serialize_message
from std_msgs.msg import String

from tests import ros_graph
from tests.bridge.ros_client import RosClient
from thymio_sim_ros.ros.foxglove.rosbridge import session
from thymio_sim_ros.ros.interface.qos import TRANSIENT_LOCAL


@pytest.fixture
def my_node(roslib):
    """A client with a node."""
    roslib.send("node", id="n", name="my_node", namespace="/ns")
    roslib.next("node")
    return roslib


def test_what_belongs_to_a_node_is_shown_as_its_own(ros, my_node):
    my_node.send("advertise", topic="out", type="std_msgs/String", node="n", id="p")
    my_node.send("subscribe", topic="~/in", type="std_msgs/String", node="n", id="s")
    my_node.call("/rosapi/nodes")
    node = ros.node
    assert ("my_node", "/ns") in node.get_node_names_and_namespaces()
    assert ("/ns/out", ["std_msgs/msg/String"]) in node.get_publisher_names_and_types_by_node("my_node", "/ns")
    found = node.get_subscriber_names_and_types_by_node("my_node", "/ns")
    assert ("/ns/my_node/in", ["std_msgs/msg/String"]) in found
    my_node.send("remove_node", id="n")
    ros.until(lambda: "my_node" not in node.get_node_names())
    assert node.count_publishers("/ns/out") == 0


def test_two_subscriptions_of_one_topic_have_their_own_qos_and_messages(ros, my_node):
    publisher = ros.node.create_publisher(String, "/names", TRANSIENT_LOCAL)
    publisher.publish(String(data="retained"))
    for name, durability in (("late", "volatile"), ("all", "transient_local")):
        my_node.send(
            "subscribe", topic="/names", type="std_msgs/String", node="n", id=name, qos={"durability": durability}
        )
    found = my_node.next("publish")
    assert (found["id"], found["msg"]) == ("all", {"data": "retained"})
    ros.until(lambda: publisher.get_subscription_count() == 2)
    publisher.publish(String(data="new"))
    assert {my_node.next("publish")["id"] for _ in range(2)} == {"late", "all"}


def test_two_publishers_of_one_topic_have_their_own_qos(ros, my_node):
    for name, reliability in (("one", "reliable"), ("two", "best_effort")):
        my_node.send(
            "advertise",
            topic="/a",
            type="std_msgs/String",
            node="n",
            id=name,
            qos={"reliability": reliability, "depth": 3},
        )
    ros.until(lambda: ros.node.count_publishers("/a") == 2)
    found = {info.qos_profile.reliability.name for info in ros.node.get_publishers_info_by_topic("/a")}
    assert found == {"RELIABLE", "BEST_EFFORT"}
    my_node.send("unadvertise", topic="/a", node="n", id="one")
    ros.until(lambda: ros.node.count_publishers("/a") == 1)


def test_a_node_hears_itself_and_other_clients(ros, bridge):
    port = bridge().port
    payload = serialize_message(String(data="é"))
    with RosClient(port, ros.until) as one, RosClient(port, ros.until) as other:
        for client, name in ((one, "one"), (other, "other")):
            client.send("node", id="n", name=name)
            client.send("subscribe", topic="/a", type="std_msgs/String", node="n", id="s", compression="cbor-raw")
            client.next("node")
        one.send("advertise", topic="/a", type="std_msgs/String", node="n", id="p")
        one.send_cbor("publish", topic="/a", node="n", id="p", msg={"bytes": payload})
        for client in (one, other):
            found = client.next("publish")
            assert (found["id"], found["msg"]["bytes"]) == ("s", payload)


@pytest.mark.skipif(not ros_graph.IS_EMBEDDED, reason="types of an installed ROS need a build")
def test_nodes_of_clients_share_types_that_the_server_does_not_have(ros, bridge):
    texts = {"msg/Spot": "float64 x\nfloat64 y\n"}
    port = bridge().port
    with RosClient(port, ros.until) as one, RosClient(port, ros.until) as other:
        for client in (one, other):
            client.send("interfaces", package="rosbridge_taught", texts=texts)
        other.send("subscribe", topic="/spot", type="rosbridge_taught/msg/Spot")
        one.send("advertise", topic="/spot", type="rosbridge_taught/msg/Spot")
        one.send("publish", topic="/spot", msg={"x": 1.5})
        assert other.next("publish")["msg"] == {"x": 1.5, "y": 0.0}
        for wrong, reason in (
            ({"msg/Spot": "int8 x\n"}, "found another definition"),
            ({"msg/Spot": 3}, "expected texts"),
        ):
            one.send("interfaces", package="rosbridge_taught", texts=wrong)
            assert reason in one.next("status")["msg"]


def test_a_client_follows_the_graph_without_its_own_nodes(ros, my_node):
    my_node.send("graph", id="g")
    first = my_node.next("graph")
    assert first["id"] == "g"
    nodes = {node["name"]: node for node in first["nodes"]}
    assert "my_node" not in nodes
    assert any(name == "/foxglove_bridge/get_parameters" for name, _ in nodes["foxglove_bridge"]["services"])
    publisher = ros.node.create_publisher(String, "/new", TRANSIENT_LOCAL)
    name = ros.node.get_name()

    def has_new(graph):
        node = next(each for each in graph["nodes"] if each["name"] == name)
        return any(topic == "/new" for topic, *_ in node["publishers"])

    node = next(each for each in my_node.next("graph", has_new)["nodes"] if each["name"] == name)
    _, kind, qos = next(each for each in node["publishers"] if each[0] == "/new")
    assert (kind, qos["durability"]) == ("std_msgs/msg/String", "transient_local")
    ros.node.destroy_publisher(publisher)
    my_node.next("graph", lambda graph: not has_new(graph))


def test_a_client_has_limits(ros, roslib, monkeypatch):
    monkeypatch.setattr(session, "MAX_NODES", 2)
    monkeypatch.setattr(session, "MAX_ENDPOINTS", 2)
    for number in range(3):
        roslib.send("node", id=number, name=f"n{number}")
    assert roslib.next("status")["msg"] == "node: this client has 2 nodes, the maximum"
    roslib.send("node", id=1, name="again")
    assert roslib.next("status")["msg"] == "node.id: expected a new one, found '1'"
    for number in range(3):
        roslib.send("subscribe", topic=f"/t{number}", type="std_msgs/Bool", id=number)
    status = roslib.next("status")
    assert (status["id"], status["msg"]) == (2, "subscribe: this client has 2 endpoints, the maximum")
