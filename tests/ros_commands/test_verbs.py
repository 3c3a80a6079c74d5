"""The verbs on a graph in this process: what they print, and errors that say what is there."""

from __future__ import annotations

import pytest
import yaml
from geometry_msgs.msg import Twist, TwistStamped
from rcl_interfaces.msg import IntegerRange, ParameterDescriptor, SetParametersResult
from rclpy.action import ActionServer, GoalResponse
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile
from std_msgs.msg import String
from std_srvs.srv import SetBool

from thymio_sim_ros.cli.ros.tools import parser_of
from thymio_sim_ros.ros_commands import action, interface, node, param, service, topic
from thymio_sim_ros.ros_commands.errors import CommandError
from thymio_sim_ros.ros_commands.member import Member

MODULES = {"action": action, "interface": interface, "node": node, "param": param, "service": service, "topic": topic}


@pytest.fixture
def executor(ros):
    """One executor for the nodes that are there and that of the command."""
    made = SingleThreadedExecutor(context=ros.context)
    yield made
    made.shutdown()


@pytest.fixture
def make_node(ros, executor):
    nodes = []

    def make(name, **options):
        nodes.append(Node(name, context=ros.context, **options))
        executor.add_node(nodes[-1])
        return nodes[-1]

    yield make
    for one in nodes:
        one.destroy_node()


@pytest.fixture
def run(make_node, executor, capsys):
    """Run a command; the result is what it prints."""

    def printed(*words):
        options = parser_of(words[0]).parse_args(words)
        member = Member(make_node(f"_tool_{words[0]}", enable_rosout=False), executor, 0.3)
        capsys.readouterr()
        MODULES[options.command].VERBS[options.verb](member, options)
        return capsys.readouterr().out

    return printed


@pytest.fixture
def talker(make_node):
    """A node that publishes, answers and has parameters."""
    made = make_node("talker", namespace="/lab")
    publisher = made.create_publisher(String, "said", 10)
    made.create_timer(0.01, lambda: publisher.publish(String(data="hello: 1")))
    made.create_publisher(String, "_hidden", 10)
    made.heard = []
    made.create_subscription(Twist, "drive", made.heard.append, 10)

    def answer(request, response):
        response.success, response.message = request.data, "done"
        return response

    made.create_service(SetBool, "switch", answer)
    made.declare_parameter("speed", 1.5)
    made.declare_parameter("group.names", ["a", "b"])
    made.add_on_set_parameters_callback(
        lambda given: SetParametersResult(
            successful=all(one.name != "speed" or one.value > 0 for one in given), reason="speed is positive"
        )
    )
    return made


def test_topics_are_listed_with_types_numbers_and_hidden_ones(run, talker):
    plain = run("topic", "list").splitlines()
    assert [name for name in plain if name.startswith("/lab")] == ["/lab/drive", "/lab/said"]
    assert "/lab/said [std_msgs/msg/String]" in run("topic", "list", "-t").splitlines()
    assert "/lab/_hidden" in run("topic", "list", "--include-hidden-topics").splitlines()
    assert run("topic", "list", "-c") == f"{len(plain)}\n"


def test_a_topic_is_described(run, talker):
    assert run("topic", "info", "/lab/said") == "Type: std_msgs/msg/String\nPublisher count: 1\nSubscription count: 0\n"
    assert "Node name: talker" in run("topic", "info", "-v", "lab/said")


def test_messages_are_printed_as_yaml_and_by_field(run, talker):
    assert run("topic", "echo", "--once", "/lab/said") == "data: 'hello: 1'\n---\n"
    assert run("topic", "echo", "--once", "/lab/said", "std_msgs/String", "--field", "data") == "hello: 1\n---\n"


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        ("topic info /lab/sad", "found no topic /lab/sad; did you mean /lab/said?"),
        ("topic echo --once /lab/said --field q", "--field q: message: found q, expected one of data"),
        ("topic echo --once /lab/said --field data.x", "--field data.x: data: found x, expected no further field"),
        (
            "topic echo --once /lab/said std_msgs/msg/Bool",
            "topic /lab/said: found type std_msgs/msg/Bool, expected std_msgs/msg/String",
        ),
        (
            "topic pub /x geometry_msgs/msg/Twits",
            r"type geometry_msgs/msg/Twits is not available: .*; did you mean Twist\?",
        ),
        ("topic pub /x std_srvs/srv/Empty", "found type std_srvs/srv/Empty, expected one such as std_srvs/msg/Name"),
        ("topic pub /x std_msgs/msg/Bool {dat:_1}", "values: no field dat; fields are data"),
        ("topic pub /x std_msgs/msg/Bool {data:_2}", "values.data: expected boolean, found 2"),
        ("topic pub /x std_msgs/msg/Bool {data:", "values at column 7: .* in '{data:'; expected YAML"),
        ("topic pub /x std_msgs/msg/Bool 1", "values: expected fields such as {name: value}, found 1"),
        (
            "topic pub /lab/drive std_msgs/msg/Bool",
            "topic /lab/drive: found type std_msgs/msg/Bool, expected geometry_msgs/msg/Twist",
        ),
        ("node info /talker", "found no node /talker; did you mean /lab/talker?"),
        ("service type /lab/swit", "found no service /lab/swit; did you mean /lab/switch?"),
        (
            "service call /lab/switch std_srvs/srv/Trigger",
            "service /lab/switch: found type std_srvs/srv/Trigger, expected std_srvs/srv/SetBool",
        ),
        ("param get /lab/talker sped", "found no parameter sped of /lab/talker: `param list /lab/talker` prints"),
        ("param set /lab/talker speed -1.0", "Setting parameter failed: speed is positive"),
        ("action info /turn", "found no action /turn; there is none"),
        ("interface show String", "found type String, expected one such as std_msgs/msg/String"),
        (
            "interface show std_msgs/msg/Int8Multi",
            r"type std_msgs/msg/Int8Multi is not available: .*; did you mean Int8MultiArray\?",
        ),
        ("interface show st_msgs/msg/String", "type st_msgs/msg/String is not available: there is no package st_msgs"),
    ],
)
def test_a_mistake_is_one_line_with_what_is_there(run, talker, words, reason):
    with pytest.raises(CommandError, match=reason.replace("{", "[{]").replace("}", "[}]")) as error:
        run(*(word.replace("_", " ") if word.startswith("{") else word for word in words.split()))
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("nodes", "words", "reason"),
    [
        (
            ["simulator", "motion_control"],
            "topic echo --once /mouse",
            "topic /mouse: The simulated robot has no optical",
        ),
        (
            ["simulator", "motion_control"],
            "param get /ui_mgr x",
            "node /ui_mgr: This node of a Create 3 does not exist",
        ),
        (
            ["simulator", "motion_control"],
            "param get /motion_control max_speed",
            "parameter max_speed of /motion_control: A wheel drives at most 0.166 m/s",
        ),
        (
            ["simulator", "turtlesim"],
            "param describe /turtlesim holonomic",
            "parameter holonomic of /turtlesim: A Thymio cannot",
        ),
        (["simulator"], "action info /navigate_to_pose", "action /navigate_to_pose: Nav2 does not run here"),
        (["simulator", "turtlesim"], "topic type /mouse", "topic /mouse; there are"),
        (["other"], "topic type /mouse", "topic /mouse; there are"),
    ],
)
def test_what_the_simulator_does_not_have_on_purpose_is_answered_with_the_reason(run, make_node, nodes, words, reason):
    for name in nodes:
        make_node(name)
    with pytest.raises(CommandError, match=f"found no {reason}"):
        run(*words.split())


def test_messages_are_published_until_their_number_is_reached(run, talker):
    printed = run("topic", "pub", "-t", "2", "-r", "100", "/lab/drive", "geometry_msgs/Twist", "{linear: {x: 1}}")
    assert printed.startswith("publisher: beginning loop\npublishing #1: geometry_msgs.msg.Twist(")
    assert printed.count("publishing #") == 2
    assert talker.heard[0].linear.x == 1.0


def test_a_header_is_stamped(make_node, run):
    found = []
    make_node("listener").create_subscription(TwistStamped, "s", found.append, 10)
    run("topic", "pub", "-t", "2", "-r", "50", "/s", "geometry_msgs/msg/TwistStamped", "{header: auto}")
    assert found[0].header.stamp.sec > 0


def test_nodes_are_listed_and_described(run, talker):
    assert "/lab/talker" in run("node", "list").splitlines()
    printed = run("node", "info", "lab/talker")
    lines = printed.splitlines()
    assert lines[0] == "/lab/talker"
    assert "    /lab/said: std_msgs/msg/String" in lines
    assert "    /lab/switch: std_srvs/srv/SetBool" in lines
    assert [line for line in lines if line.startswith("  ") and line.endswith(":")] == [
        "  Subscribers:",
        "  Publishers:",
        "  Service Servers:",
        "  Service Clients:",
        "  Action Servers:",
        "  Action Clients:",
    ]


def test_services_are_listed_and_called(run, talker):
    assert "/lab/switch [std_srvs/srv/SetBool]" in run("service", "list", "-t").splitlines()
    assert run("service", "type", "/lab/switch") == "std_srvs/srv/SetBool\n"
    printed = run("service", "call", "/lab/switch", "std_srvs/srv/SetBool", "data: true")
    assert printed.endswith(
        "requester: making request: std_srvs.srv.SetBool_Request(data=True)\n\n"
        "response:\nstd_srvs.srv.SetBool_Response(success=True, message='done')\n\n"
    )


def test_requests_and_responses_are_printed(run, make_node, talker, capsys):
    from rclpy.service_introspection import ServiceIntrospectionState

    caller = make_node("caller")
    client = caller.create_client(SetBool, "/lab/switch")
    client.configure_introspection(caller.get_clock(), QoSProfile(depth=10), ServiceIntrospectionState.CONTENTS)
    printed = []

    def call():
        printed.append(capsys.readouterr().out)
        if "RESPONSE_RECEIVED" in "".join(printed):
            raise KeyboardInterrupt
        if client.service_is_ready() and caller.count_subscribers("/lab/switch/_service_event"):
            client.call_async(SetBool.Request(data=True))

    caller.create_timer(0.05, call)
    with pytest.raises(KeyboardInterrupt):
        run("service", "echo", "/lab/switch")
    events = list(yaml.safe_load_all("".join(printed).rpartition("---")[0]))
    sent = next(event for event in events if event["info"]["event_type"] == "REQUEST_SENT")
    assert (sent["request"], sent["response"]) == ([{"data": True}], [])
    received = next(event for event in events if event["info"]["event_type"] == "RESPONSE_RECEIVED")
    assert received["response"] == [{"success": True, "message": "done"}]


def test_a_service_that_reports_nothing_says_why(run, make_node, talker, capsys):
    def stop():
        if "neither its server nor a client has called configure_introspection" in capsys.readouterr().err:
            raise KeyboardInterrupt

    make_node("reader").create_timer(0.05, stop)
    with pytest.raises(KeyboardInterrupt):
        run("service", "echo", "/lab/switch")


def test_parameters_are_listed_read_set_and_dumped(run, talker):
    assert "  speed" in run("param", "list", "/lab/talker").splitlines()
    assert "/lab/talker:\n  group.names\n" in run("param", "list")
    assert run("param", "get", "/lab/talker", "speed") == "Double value is: 1.5\n"
    assert run("param", "set", "/lab/talker", "speed", "2.5").startswith("Set parameter successful")
    assert run("param", "get", "/lab/talker", "group.names") == "String values are: ['a', 'b']\n"
    dumped = yaml.safe_load(run("param", "dump", "/lab/talker"))["/lab/talker"]["ros__parameters"]
    assert (dumped["speed"], dumped["group"]) == (2.5, {"names": ["a", "b"]})


def test_parameters_are_described_with_type_text_and_limits(run, make_node):
    node = make_node("sized")
    limits = IntegerRange(from_value=0, to_value=255, step=5)
    described = ParameterDescriptor(description="Red of the light", integer_range=[limits], read_only=True)
    node.declare_parameter("red", 10, described)
    node.declare_parameter("word", "world")
    assert run("param", "describe", "/sized", "red", "word") == (
        "Parameter name: red\n"
        "  Type: integer\n"
        "  Description: Red of the light\n"
        "  Constraints:\n"
        "    Read only: true\n"
        "    Min value: 0\n"
        "    Max value: 255\n"
        "    Step: 5\n"
        "Parameter name: word\n"
        "  Type: string\n"
        "  Constraints:\n"
    )
    with pytest.raises(CommandError, match="found no parameter wrd of /sized: `param list /sized` prints"):
        run("param", "describe", "/sized", "word", "wrd")


def test_a_node_without_parameters_is_named(run, make_node):
    make_node("plain", start_parameter_services=False)
    with pytest.raises(CommandError, match="node /plain: found no services of parameters"):
        run("param", "list", "/plain")


def test_interfaces_are_shown_with_the_fields_of_their_types(run):
    assert run("interface", "show", "geometry_msgs/msg/Twist").splitlines()[-8:] == [
        "Vector3  linear",
        "\tfloat64 x",
        "\tfloat64 y",
        "\tfloat64 z",
        "Vector3  angular",
        "\tfloat64 x",
        "\tfloat64 y",
        "\tfloat64 z",
    ]
    assert run("interface", "show", "std_srvs/srv/SetBool").splitlines()[1] == "---"


def test_goals_are_sent_and_their_feedback_and_result_printed(run, make_node):
    fibonacci = pytest.importorskip("test_msgs.action").Fibonacci

    def execute(goal):
        goal.publish_feedback(fibonacci.Feedback(sequence=[0, 1]))
        goal.succeed()
        return fibonacci.Result(sequence=[0, 1, 1])

    def check(request):
        return GoalResponse.ACCEPT if request.order < 9 else GoalResponse.REJECT

    server = ActionServer(make_node("counter"), fibonacci, "count", execute, goal_callback=check)
    assert run("action", "list", "-t") == "/count [test_msgs/action/Fibonacci]\n"
    assert run("action", "info", "/count") == "Action: /count\nAction clients: 0\nAction servers: 1\n    /counter\n"
    words = ("action", "send_goal", "-f", "/count", "test_msgs/action/Fibonacci")
    printed = run(*words, "order: 3")
    assert "Sending goal:\n     order: 3\n\n" in printed
    assert "Feedback:\n    sequence:\n- 0\n- 1\n\n" in printed
    assert printed.endswith("Result:\n    sequence:\n- 0\n- 1\n- 1\n\nGoal finished with status: SUCCEEDED\n")
    assert run(*words, "order: 9").endswith("Goal was rejected.\n")
    server.destroy()


def test_types_are_printed_and_names_are_found_by_their_type(run, talker):
    assert run("topic", "type", "/lab/said") == "std_msgs/msg/String\n"
    assert run("topic", "find", "geometry_msgs/msg/Twist") == "/lab/drive\n"
    assert run("topic", "find", "-c", "geometry_msgs/msg/PoseStamped") == "0\n"
    assert run("service", "find", "std_srvs/srv/SetBool") == "/lab/switch\n"
    with pytest.raises(CommandError, match="did you mean Twist"):
        run("topic", "find", "geometry_msgs/msg/Twst")


def test_a_service_is_described(run, talker):
    talker.create_client(SetBool, "/lab/switch")
    described = run("service", "info", "/lab/switch")
    assert described == "Type: std_srvs/srv/SetBool\nClients count: 1\nServices count: 1\n"


def test_parameters_are_loaded_as_they_were_dumped(run, talker, tmp_path):
    file = tmp_path / "talker.yaml"
    file.write_text(run("param", "dump", "/lab/talker").replace("speed: 1.5", "speed: 2.5"))
    assert "Set parameter speed successful\n" in run("param", "load", "/lab/talker", str(file))
    assert talker.get_parameter("speed").value == 2.5
    assert list(talker.get_parameter("group.names").value) == ["a", "b"]


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("/lab/talker:\n  ros__parameters:\n    speed: -1.0\n", "no parameter of .*file.yaml could be set"),
        ("/other:\n  ros__parameters:\n    speed: 1.0\n", "found no parameters of /lab/talker"),
        ("speed: [1.0\n", "file.yaml: "),
        ("3", "found no parameters of /lab/talker, expected `/lab/talker:`"),
    ],
)
def test_a_file_of_parameters_that_cannot_be_loaded_is_named(run, talker, tmp_path, text, reason):
    file = tmp_path / "file.yaml"
    file.write_text(text)
    with pytest.raises(CommandError, match=reason):
        run("param", "load", "/lab/talker", str(file))
    with pytest.raises(CommandError, match=r"nothing.yaml: No such file or directory, expected a file of parameters"):
        run("param", "load", "/lab/talker", str(tmp_path / "nothing.yaml"))
    assert talker.get_parameter("speed").value == 1.5


def test_publishing_waits_for_the_wanted_number_of_subscriptions(run, talker, make_node):
    other = make_node("other")
    heard = []
    talker.create_timer(
        0.2, lambda: other.create_subscription(Twist, "/lab/drive", heard.append, 1) if not heard else 0
    )
    printed = run("topic", "pub", "--once", "-w", "2", "/lab/drive", "geometry_msgs/msg/Twist", "{linear: {x: 2.0}}")
    assert printed.startswith("Waiting for at least 2 matching subscription(s)...")
    assert "publishing #1" in printed
