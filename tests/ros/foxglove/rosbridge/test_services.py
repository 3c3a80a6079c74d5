"""Clients of rosbridge that call and serve, on the ROS graph."""

from __future__ import annotations

import json

import pytest
from rclpy.serialization import deserialize_message, serialize_message
from std_srvs.srv import SetBool, Trigger
from websockets.sync.client import connect

from tests.bridge.ros_client import RosClient
from tests.patience import PATIENCE_S
from thymio_sim_ros.access.tokens import Tokens
from thymio_sim_ros.ros.foxglove.node import FoxgloveBridge
from thymio_sim_ros.ros.foxglove.options import FoxgloveParams


@pytest.fixture
def switch(ros):
    """A service that answers with what it was asked."""

    def answer(request, response):
        response.success, response.message = request.data, "é"
        return response

    return ros.node.create_service(SetBool, "/switch", answer)


def test_a_client_calls_a_service_of_the_graph(switch, roslib):
    answer = roslib.call("/switch", args={"data": True}, id="c")
    values = {"success": True, "message": "é"}
    assert answer == {"op": "service_response", "service": "/switch", "id": "c", "values": values, "result": True}


def test_arguments_may_be_given_in_their_order(switch, roslib):
    assert roslib.call("switch", args=[True], type="std_srvs/SetBool")["values"]["success"] is True


def test_a_client_may_call_with_cdr(switch, roslib):
    request = serialize_message(SetBool.Request(data=True))
    roslib.send_cbor("call_service", service="/switch", args={"bytes": request}, compression="cbor-raw")
    values = roslib.next("service_response")["values"]
    assert deserialize_message(values["bytes"], SetBool.Response) == SetBool.Response(success=True, message="é")


@pytest.mark.parametrize(
    ("fields", "text"),
    [
        ({"service": "/nothing"}, "call_service.service: expected a name in the ROS graph, or a type, found /nothing"),
        ({"service": "/switch", "args": {"flag": True}}, "call_service.args: no field flag; fields are data"),
        ({"service": "/switch", "args": {"data": 1}}, "call_service.args.data: expected boolean, found 1"),
        (
            {"service": "/switch", "type": "std_msgs/msg/Bool"},
            "expected the type of a service, found std_msgs/msg/Bool",
        ),
        ({"service": "/gone", "type": "std_srvs/Trigger", "timeout": 0.01}, "no answer from /gone within 0.01 s"),
        ({"service": "/rosapi/message_details", "args": {"type": "a/B"}}, "type a/msg/B is not available"),
        ({"service": "/switch", "node": "x"}, "call_service.node: expected the id of a node, found x"),
    ],
)
def test_a_call_that_fails_is_answered_with_the_reason(switch, roslib, fields, text):
    roslib.send("call_service", id="c", **fields)
    assert text in roslib.next("status")["msg"]
    answer = roslib.next("service_response")
    assert (answer["id"], answer["result"]) == ("c", False)
    assert text in answer["values"]


def test_a_client_serves(ros, roslib):
    roslib.send("advertise_service", service="/toggle", type="std_srvs/SetBool")
    client = ros.node.create_client(SetBool, "/toggle")
    ros.until(client.service_is_ready)
    first, second = (client.call_async(SetBool.Request(data=data)) for data in (True, False))
    calls = [roslib.next("call_service") for _ in range(2)]
    assert [call["args"] for call in calls] == [{"data": True}, {"data": False}]
    for call in reversed(calls):  # in any order
        values = {"success": call["args"]["data"]}
        roslib.send("service_response", service="/toggle", id=call["id"], values=values, result=True)
    ros.until(lambda: first.done() and second.done())
    assert (first.result().success, second.result().success) == (True, False)
    roslib.send("unadvertise_service", service="/toggle")
    ros.until(lambda: not client.service_is_ready())


def test_a_client_may_serve_with_cdr_and_on_a_node_of_its_own(ros, roslib):
    roslib.send("node", id="n", name="server", namespace="/a")
    assert roslib.next("node") == {"op": "node", "id": "n", "name": "server", "namespace": "/a"}
    roslib.send(
        "advertise_service", service="~/toggle", type="std_srvs/srv/SetBool", node="n", id="s", compression="cbor-raw"
    )
    client = ros.node.create_client(SetBool, "/a/server/toggle")
    ros.until(client.service_is_ready)
    asked = client.call_async(SetBool.Request(data=True))
    call = roslib.next("call_service")
    assert (call["service"], call["node"], call["served"]) == ("~/toggle", "n", "s")
    assert deserialize_message(call["args"]["bytes"], SetBool.Request).data is True
    values = {"bytes": serialize_message(SetBool.Response(message="yes"))}
    roslib.send_cbor("service_response", service="~/toggle", id=call["id"], values=values, result=True)
    ros.until(asked.done)
    assert asked.result().message == "yes"


def test_an_answer_that_does_not_fit_is_rejected_and_may_be_repeated(ros, roslib):
    roslib.send("advertise_service", service="/t", type="std_srvs/Trigger")
    client = ros.node.create_client(Trigger, "/t")
    ros.until(client.service_is_ready)
    asked = client.call_async(Trigger.Request())
    call = roslib.next("call_service")
    roslib.send("service_response", service="/t", id=call["id"], values={"message": 1}, result=True)
    assert roslib.next("status")["msg"] == "service_response.values.message: expected string, found 1"
    roslib.send("service_response", service="/t", id=call["id"], values={"message": "b"}, result=True)
    ros.until(asked.done)
    roslib.send("service_response", service="/t", id=call["id"], values={}, result=True)
    assert "service_response.id: expected the id of a request" in roslib.next("status")["msg"]


def test_a_client_may_not_open_files_by_a_parameter(ros, roslib, peer):
    arguments = {"parameters": [{"name": "playground", "value": {"type": 4, "string_value": "/etc/passwd"}}]}
    answer = roslib.call("/peer/set_parameters", args=arguments)
    assert "expected the name of a shipped playground" in answer["values"]
    value = '"/etc/passwd"'
    answer = roslib.call("/rosapi/set_param", args={"name": "/peer:playground", "value": value})
    assert "expected the name of a shipped playground" in answer["values"]


def test_services_of_rosapi_describe_the_graph(ros, switch, roslib, peer):
    def ask(of_rosapi, **args):
        answer = roslib.call(f"/rosapi/{of_rosapi}", args=args)
        assert answer["result"], answer
        return answer["values"]

    topics = ask("topics")
    assert dict(zip(topics["topics"], topics["types"], strict=True))["/rosout"] == "rcl_interfaces/msg/Log"
    assert ask("topic_type", topic="/rosout") == {"type": "rcl_interfaces/msg/Log"}
    assert ask("topics_for_type", type="rcl_interfaces/Log") == {"topics": ["/rosout"]}
    assert (
        "uint8 level"
        in dict(zip(topics["topics"], ask("topics_and_raw_types")["typedefs_full_text"], strict=True))["/rosout"]
    )
    assert "/switch" in ask("services")["services"]
    assert ask("service_type", service="/switch") == {"type": "std_srvs/srv/SetBool"}
    assert ask("service_type", service="/nothing") == {"type": ""}
    assert ask("services_for_type", type="std_srvs/SetBool") == {"services": ["/switch"]}
    assert "/peer" in ask("nodes")["nodes"]
    assert "/peer/get_parameters" in ask("node_details", node="/peer")["services"]
    assert ask("node_details", node="/no_node")["services"] == []
    assert ask("service_node", service="/peer/get_parameters") == {"node": "/peer"}
    assert "/foxglove_bridge" in ask("publishers", topic="/rosout")["publishers"]
    assert ask("get_param", name="/peer:speed") == {"value": "1.5"}
    assert ask("get_param", name="/peer:nothing", default_value="7") == {"value": "7"}
    assert ask("has_param", name="/peer:speed") == {"exists": True}
    assert ask("has_param", name="/no_node:speed") == {"exists": False}
    assert ask("set_param", name="/peer:count", value="4") == {}
    assert peer.get_parameter("count").value == 4
    assert "/peer:count" in ask("get_param_names")["names"]
    details = ask("message_details", type="geometry_msgs/PoseWithCovariance")["typedefs"]
    assert details[0]["fieldtypes"] == ["geometry_msgs/Pose", "double"]
    assert details[0]["fieldarraylen"] == [-1, 36]
    assert [each["type"].split("/")[1] for each in details[1:]] == ["Pose", "Point", "Quaternion"]
    assert ask("service_request_details", type="std_srvs/SetBool")["typedefs"][0]["fieldnames"] == ["data"]
    assert ask("get_time")["time"].keys() == {"sec", "nanosec"}


def test_a_rejected_parameter_is_answered_with_the_reason(roslib, peer):
    answer = roslib.call("/rosapi/set_param", args={"name": "/peer:program", "value": '"bad"'})
    assert answer["values"] == "/rosapi/set_param: program: line 3, column 5: bad"
    answer = roslib.call("/rosapi/set_param", args={"name": "/peer:program", "value": "{"})
    assert "args.value: expected a parameter in JSON" in answer["values"]


def test_a_client_that_may_only_read_changes_nothing(ros, switch, peer):
    defaults = FoxgloveParams(port=0, read_only_services=("/switch",))
    bridge = ros.live(FoxgloveBridge(context=ros.context, defaults=defaults, tokens=Tokens("full", "read")))
    with RosClient(bridge.port, ros.until, "/?token=read") as client:
        assert client.call("/switch", args={"data": True})["result"]
        assert client.call("/rosapi/nodes")["result"]
        refused = [
            client.call("/peer/list_parameters"),
            client.call("/rosapi/set_param", args={"name": "/peer:count", "value": "9"}),
        ]
        assert all("read-only" in answer["values"] for answer in refused)
        client.send("subscribe", topic="/rosout", id="s")
        for operation in ("advertise", "publish"):
            client.send(operation, topic="/a", type="std_msgs/Bool", id=operation)
            assert "read-only" in client.next("status", lambda each, by=operation: each["id"] == by)["msg"]
    assert peer.get_parameter("count").value == 3


def test_a_page_without_a_token_gets_the_reason(ros):
    defaults = FoxgloveParams(port=0)
    bridge = ros.live(FoxgloveBridge(context=ros.context, defaults=defaults, tokens=Tokens("full", "read")))
    with connect(f"ws://127.0.0.1:{bridge.port}", origin="https://a.example") as page:
        status = json.loads(page.recv(timeout=PATIENCE_S))
    assert (status["op"], status["level"], status["id"]) == ("status", "error", "access")
    assert "a token is needed" in status["msg"]


def test_a_client_calls_what_another_one_serves_without_its_type(ros, bridge):
    port = bridge().port
    with RosClient(port, ros.until) as one, RosClient(port, ros.until) as other:
        one.send("advertise_service", service="/t", type="std_srvs/Trigger")
        one.call("/rosapi/nodes")
        other.send("call_service", service="/t")
        call = one.next("call_service")
        one.send("service_response", service="/t", id=call["id"], values={"message": "a"}, result=True)
        assert other.next("service_response")["values"]["message"] == "a"
