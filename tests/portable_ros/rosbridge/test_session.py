"""Nodes of two processes on one graph, by a server in memory: topics, services, parameters, actions, queries."""

from __future__ import annotations

from typing import Any

import pytest

from tests.portable_ros.rosbridge.memory_server import MemoryServer, Program
from thymio_sim_ros.portable_ros.messages.action_class import action_type
from thymio_sim_ros.portable_ros.messages.message_class import message_type, service_type
from thymio_sim_ros.portable_ros.rclpy.action import ActionClient, ActionServer
from thymio_sim_ros.portable_ros.rclpy.event_handler import PublisherEventCallbacks
from thymio_sim_ros.portable_ros.rclpy.parameter import Parameter
from thymio_sim_ros.portable_ros.rclpy.parameter_client import AsyncParameterClient
from thymio_sim_ros.portable_ros.rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from thymio_sim_ros.portable_ros.rosbridge.descriptions import read_graph
from thymio_sim_ros.portable_ros.rosbridge.operations import OperationError, decode
from thymio_sim_ros.portable_ros.rosbridge.session import FOREIGN, NO_ROSAPI

String, Float64 = message_type("std_msgs/msg/String"), message_type("std_msgs/msg/Float64")
AddTwoInts = service_type("example_interfaces/srv/AddTwoInts")
Fibonacci = action_type("test_msgs/action/Fibonacci")
RETAINED = QoSProfile(depth=2, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def _connected(*, is_foreign: bool = False) -> tuple[MemoryServer, Program, Program]:
    server, one, other = MemoryServer(is_foreign=is_foreign), Program(), Program()
    server.connect(one)
    server.connect(other)
    return server, one, other


@pytest.mark.parametrize("is_foreign", [False, True])
def test_messages_reach_subscriptions_of_both_processes_once(*, is_foreign: bool) -> None:
    server, robot, student = _connected(is_foreign=is_foreign)
    publisher = robot.node("robot").create_publisher(String, "topic", 10)
    found: list[str] = []
    robot.node("listener").create_subscription(String, "topic", lambda message: found.append(f"own {message.data}"), 10)
    node = student.node("student")
    for name in "ab":
        node.create_subscription(String, "topic", lambda message, name=name: found.append(f"{name} {message.data}"), 10)
    server.run()
    publisher.publish(String(data="x"))
    server.run()
    assert sorted(found) == ["a x", "b x", "own x"]
    assert [one for one in student.reports if one != FOREIGN] == []


def test_messages_are_serialized_for_a_suite_so_that_nan_stays(capsys: pytest.CaptureFixture[str]) -> None:
    server, robot, student = _connected()
    publisher = robot.node("robot").create_publisher(Float64, "topic", 10)
    found: list[float] = []
    student.node("student").create_subscription(Float64, "topic", lambda message: found.append(message.data), 10)
    server.run()
    for value in (1.5, float("nan"), float("inf")):
        publisher.publish(Float64(data=value))
    server.run()
    assert str(found) == "[1.5, nan, inf]"


def test_late_subscriptions_get_what_is_retained_once() -> None:
    server, robot, student = MemoryServer(), Program(), Program()
    publisher = robot.node("robot").create_publisher(String, "topic", RETAINED)
    for text in "abc":
        publisher.publish(String(data=text))
    found: list[str] = []
    student.node("student").create_subscription(String, "topic", lambda message: found.append(message.data), RETAINED)
    server.connect(student)
    server.connect(robot)
    assert found == ["b", "c"]
    publisher.publish(String(data="d"))
    server.run()
    assert found == ["b", "c", "d"]


def test_nodes_names_types_and_counts_of_the_other_process_are_known() -> None:
    server, robot, student = _connected()
    remote = robot.node("robot", namespace="/lab")
    remote.create_publisher(String, "topic", QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT))
    remote.create_service(AddTwoInts, "add", lambda request, response: response)
    node = student.node("student")
    client = node.create_client(AddTwoInts, "/lab/add")
    assert not client.service_is_ready()
    server.run()
    assert client.wait_for_service(timeout_sec=0)
    assert ("robot", "/lab") in node.get_node_names_and_namespaces()
    assert dict(node.get_topic_names_and_types())["/lab/topic"] == ["std_msgs/msg/String"]
    assert dict(node.get_service_names_and_types())["/lab/add"] == ["example_interfaces/srv/AddTwoInts"]
    assert node.count_publishers("/lab/topic") == 1
    assert ("/lab/topic", ["std_msgs/msg/String"]) in node.get_publisher_names_and_types_by_node("robot", "/lab")
    info = node.get_publishers_info_by_topic("/lab/topic")[0]
    assert (info.node_name, info.qos_profile.reliability) == ("robot", ReliabilityPolicy.BEST_EFFORT)
    remote.destroy_node()
    server.run()
    assert node.get_node_names() == ["student"]
    assert node.count_publishers("/lab/topic") == 0
    assert not client.service_is_ready()


def test_matches_are_reported_and_end_with_the_connection() -> None:
    server, robot, student = _connected()
    counts: list[int] = []
    events = PublisherEventCallbacks(matched=lambda info: counts.append(info.current_count))
    publisher = robot.node("robot").create_publisher(String, "topic", 10, event_callbacks=events)
    student.node("student").create_subscription(String, "topic", print, 10)
    server.run()
    assert publisher.get_subscription_count() == 1
    server.disconnect(robot)
    robot.executor.spin_once(timeout_sec=0)
    robot.executor.spin_once(timeout_sec=0)
    assert counts == [1, 0]


@pytest.mark.parametrize("is_foreign", [False, True])
def test_services_answer_in_both_directions(*, is_foreign: bool) -> None:
    server, robot, student = _connected(is_foreign=is_foreign)

    def add(request: Any, response: Any) -> Any:
        response.sum = request.a + request.b
        return response

    robot.node("robot").create_service(AddTwoInts, "add", add)
    node = student.node("student")
    node.create_service(AddTwoInts, "add_here", add)
    server.run()
    for program in (robot, student):
        if is_foreign:
            assert program.session is not None
            program.session.poll()
    server.run()
    for caller, name in ((node, "/add"), (robot.node("caller"), "/add_here"), (node, "/add_here")):
        future = caller.create_client(AddTwoInts, name).call_async(AddTwoInts.Request(a=2**62, b=3))
        server.run()
        assert future.result().sum == 2**62 + 3


def test_a_service_of_the_own_process_is_called_without_the_server() -> None:
    server, _, student = _connected()
    node = student.node("student")
    node.create_service(AddTwoInts, "add", lambda request, response: response)
    server.run()
    future = node.create_client(AddTwoInts, "add").call_async(AddTwoInts.Request())
    server.run()
    assert future.done()
    assert server.said("call_service") == [one for one in server.said("call_service") if "rosapi" in one["service"]]


def test_parameters_of_a_node_are_set_from_the_other_process() -> None:
    server, robot, student = _connected()
    node = student.node("student")
    node.declare_parameter("speed", 1.0)
    client = AsyncParameterClient(robot.node("robot"), "student")
    server.run()
    assert client.services_are_ready()
    future = client.set_parameters([Parameter("speed", value=2.5)])
    server.run()
    assert future.result().results[0].successful
    assert node.get_parameter("speed").value == 2.5


def test_actions_are_carried_as_their_services_and_topics() -> None:
    server, robot, student = _connected()

    def execute(goal: Any) -> Any:
        goal.publish_feedback(Fibonacci.Feedback(sequence=[0, 1]))
        goal.succeed()
        return Fibonacci.Result(sequence=[0, 1, 1])

    server_of_action = ActionServer(robot.node("robot"), Fibonacci, "fibonacci", execute)
    client = ActionClient(student.node("student"), Fibonacci, "fibonacci")
    server.run()
    assert client.server_is_ready()
    feedback: list[list[int]] = []
    goal = client.send_goal_async(
        Fibonacci.Goal(order=3), lambda message: feedback.append(list(message.feedback.sequence))
    )
    server.run()
    assert goal.result().accepted
    result = goal.result().get_result_async()
    server.run()
    assert list(result.result().result.sequence) == [0, 1, 1]
    assert feedback == [[0, 1]]
    server_of_action.destroy()


def test_after_a_lost_connection_everything_is_announced_again() -> None:
    server, robot, student = _connected()
    publisher = student.node("student").create_publisher(String, "topic", 10)
    found: list[str] = []
    student.node("own").create_subscription(String, "topic", lambda message: found.append(f"own {message.data}"), 10)
    robot.node("robot").create_subscription(String, "topic", lambda message: found.append(message.data), 10)
    server.run()
    server.disconnect(student)
    for number in range(5000):
        publisher.publish(String(data=f"{number}"))
        student.executor.spin_once(timeout_sec=0)
    assert found == [f"own {number}" for number in range(5000)]
    assert student.executor._context.ok()
    server.connect(student)
    found.clear()
    publisher.publish(String(data="again"))
    server.run()
    assert sorted(found) == ["again", "own again"]


def test_a_flood_keeps_what_the_depth_says_and_delays_no_other() -> None:
    server, _, student = _connected()
    node = student.node("student")
    flood, other = node.create_publisher(String, "flood", 3), node.create_publisher(String, "other", 1)
    server.run()
    for number in range(10_000):
        flood.publish(String(data=f"{number}"))
    other.publish(String(data="x"))
    server.sent.clear()
    server.run()
    assert [one["topic"] for one in server.said("publish")] == ["/flood", "/other", "/flood", "/flood"]


def test_endpoints_that_are_gone_are_withdrawn_after_their_last_message() -> None:
    server, robot, student = _connected()
    found: list[str] = []
    robot.node("robot").create_subscription(String, "topic", lambda message: found.append(message.data), 10)
    node = student.node("student")
    server.run()
    publisher = node.create_publisher(String, "topic", 1)
    server.run()
    publisher.publish(String(data="last"))
    node.destroy_node()
    server.run()
    assert found == ["last"]
    assert "unadvertise" in [one["op"] for one in server.sent]
    assert [one["op"] for one in server.sent][-1] == "remove_node"


def test_new_publishers_are_not_taken_for_those_that_are_gone() -> None:
    server, robot, student = _connected()
    found: list[str] = []
    robot.node("robot").create_subscription(String, "topic", lambda message: found.append(message.data), 10)
    node = student.node("student")
    for number in range(50):  # new objects are where earlier ones were
        publisher = node.create_publisher(String, "topic", 10)
        publisher.publish(String(data=f"{number}"))
        server.run()
        node.destroy_publisher(publisher)
        del publisher
        server.run()
    assert found == [f"{number}" for number in range(50)]


def test_what_a_foreign_server_lacks_is_said_once() -> None:
    server, _, student = _connected(is_foreign=True)
    student.node("student")
    for _ in range(3):
        assert student.session is not None
        student.session.poll()
        server.run()
    assert student.reports == [FOREIGN]
    client = ActionClient(student.node("client"), Fibonacci, "fibonacci")
    server.run()
    assert student.reports == [FOREIGN, "/fibonacci: the server carries no actions"]
    client.destroy()


def test_a_foreign_server_without_rosapi_is_asked_once() -> None:
    server, student = MemoryServer(is_foreign=True, has_rosapi=False), Program()
    student.node("student")
    server.connect(student)
    assert student.reports == [FOREIGN, NO_ROSAPI]
    assert student.session is not None
    assert not student.session.needs_polls


@pytest.mark.parametrize(
    ("frame", "reason"),
    [
        ("{", "found a frame of 1 bytes, expected JSON or CBOR"),
        (b"\xff", "found a frame of 1 bytes, expected JSON or CBOR"),
        ("[1]", "found [1], expected an object with `op`"),
        ('{"op": 3}', "found op = 3, expected str"),
        ('{"op": "publish"}', "found topic = None, expected str"),
        ('{"op": "publish", "topic": "/topic", "msg": {"data": 3}}', "message.data: expected string, found 3"),
        ('{"op": "graph", "nodes": [3]}', "found node 3, expected an object"),
        ('{"op": "graph", "nodes": [{"name": "a", "namespace": "/", "services": [["x"]]}]}', "expected [name, type]"),
        (
            '{"op": "graph", "nodes": [{"name": "a", "namespace": "", "publishers": [["/x", "y", {"history": "z"}]]}]}',
            "found history = 'z'",
        ),
        ('{"op": "dance"}', "found operation 'dance', which this program does not know"),
        ('{"op": "status", "level": "error", "msg": "type x/msg/Y is not available"}', "type x/msg/Y is not available"),
    ],
)
def test_wrong_operations_are_reported_once_and_change_nothing(frame: str | bytes, reason: str) -> None:
    server, _, student = _connected()
    student.node("student").create_subscription(String, "topic", print, 10)
    server.run()
    assert student.session is not None
    for _ in range(3):
        student.session.receive(frame)
    server.run()
    assert len(student.reports) == 1
    assert reason in student.reports[0]


def test_an_error_of_the_server_names_the_topic() -> None:
    server, _, student = _connected()
    student.node("student").create_publisher(String, "topic", 1)
    server.run()
    wire_id = next(one["id"] for one in server.said("advertise") if one["topic"] == "/topic")
    server.tell(student, {"op": "status", "level": "error", "id": wire_id, "msg": "no such type"})
    assert student.reports == ["/topic: no such type"]


def test_a_failed_call_is_reported_and_a_request_that_is_none_is_answered() -> None:
    server, robot, student = _connected()
    robot.node("robot").create_service(AddTwoInts, "add", lambda request, response: response)
    node = student.node("student")
    server.run()
    client = node.create_client(AddTwoInts, "add")
    server._ends = [one for one in server._ends if one[1].get("service") != "/add"]
    future = client.call_async(AddTwoInts.Request())
    server.run()
    assert not future.done()
    assert student.reports == ["/add: Service /add does not exist"]
    for name, text in (("/add", "message.a: expected int64, found 'x'"), ("/none", "this program has no such service")):
        server._callers["wrong"] = (student, {"id": "answer"})
        server.tell(robot, {"op": "call_service", "id": "wrong", "service": name, "args": {"a": "x"}})
        server.run()
        answer = server.said("service_response")[-1]
        assert answer["result"] is False
        assert text in answer["values"]


def test_policies_that_are_not_carried_are_said() -> None:
    from thymio_sim_ros.portable_ros.rclpy.duration import Duration

    server, _, student = _connected()
    profile = QoSProfile(depth=1, deadline=Duration(seconds=1))
    student.node("student").create_publisher(String, "topic", profile)
    server.run()
    assert student.reports == ["/topic: deadline and liveliness are not carried by rosbridge"]


@pytest.mark.parametrize("policies", [{"depth": 1, 3: "a"}, {"depth": [1]}])
def test_a_graph_with_policies_of_other_types_is_rejected(policies: dict[Any, Any]) -> None:
    publishers = [["/topic", "std_msgs/msg/String", policies]]
    with pytest.raises(OperationError, match=r"operation 'graph': found publishers with .*, expected \[name, type\]"):
        read_graph({"op": "graph", "nodes": [{"name": "robot", "namespace": "/", "publishers": publishers}]})


def test_a_text_with_half_of_a_surrogate_pair_is_rejected() -> None:
    with pytest.raises(OperationError, match="surrogates not allowed"):
        decode('{"op": "call_service", "service": "/\\ud800"}')
    assert decode('{"op": "status", "msg": "\\ud83d\\ude00"}')["msg"] == "\N{GRINNING FACE}"
