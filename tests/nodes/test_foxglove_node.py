"""The bridge in the test's own process, with a real client: every way from ROS to the socket and back."""

from __future__ import annotations

import functools
import math
import random
import socket
import threading

import pytest
from geometry_msgs.msg import Twist, Vector3
from rcl_interfaces.msg import ParameterDescriptor, SetParametersResult
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.serialization import deserialize_message, serialize_message
from rosgraph_msgs.msg import Clock
from std_msgs.msg import Bool, Int16MultiArray, String
from std_srvs.srv import SetBool, Trigger

from tests.bridge.studio import Studio
from thymio_sim_ros.bridge import messages as ms
from thymio_sim_ros.bridge.vocabulary import CDR, JSON, StatusLevel
from thymio_sim_ros.nodes import foxglove_node, tf_messages
from thymio_sim_ros.nodes.foxglove_calls import Calls
from thymio_sim_ros.nodes.foxglove_node import FoxgloveBridge, FoxgloveParams
from thymio_sim_ros.nodes.life import StartError, make_executor

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
BEST_EFFORT = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)


@pytest.fixture
def bridge(ros):
    """Make a bridge on a free port."""

    def make(use_sim_time=False, **parameters):
        defaults = FoxgloveParams(port=0, **parameters)
        return ros.live(FoxgloveBridge(context=ros.context, use_sim_time=use_sim_time, defaults=defaults))

    return make


@pytest.fixture
def studio(ros, bridge):
    """A client of a bridge with default parameters."""
    with Studio(bridge().port, ros.until) as client:
        yield client


@pytest.fixture
def peer(ros):
    """A node with parameters, one of which has opinions."""
    node = ros.add(Node("peer", context=ros.context, enable_rosout=False))
    node.declare_parameter("speed", 1.5)
    node.declare_parameter("count", 3)
    node.declare_parameter("program", "good")
    node.declare_parameter("fixed", 1, ParameterDescriptor(read_only=True))

    def check(parameters):
        is_bad = any(item.name == "program" and item.value == "bad" for item in parameters)
        return SetParametersResult(successful=not is_bad, reason="line 3, column 5: bad" if is_bad else "")

    node.add_on_set_parameters_callback(check)
    return node


# --- topics ---


def test_the_bytes_of_a_message_arrive_as_they_were_published(ros, studio):
    publisher = ros.node.create_publisher(String, "/chat", 10)
    studio.subscribe(7, "/chat")
    ros.until(publisher.get_subscription_count)
    message = String(data="hello")
    publisher.publish(message)
    data = studio.next(ms.MessageData)
    assert (data.subscription_id, data.payload) == (7, serialize_message(message))


def test_a_channel_carries_the_type_and_its_definition(ros, studio):
    ros.node.create_publisher(String, "/chat", 10)
    channel = studio.channel("/chat")
    assert (channel.encoding, channel.schema_name, channel.schema_encoding) == ("cdr", "std_msgs/msg/String", "ros2msg")
    assert "string data" in channel.schema


def test_a_topic_with_subscribers_only_is_a_channel_too(ros, studio):
    ros.node.create_subscription(Twist, "/cmd_vel", lambda _: None, 10)
    assert studio.channel("/cmd_vel").schema_name == "geometry_msgs/msg/Twist"


def test_ros_is_subscribed_only_while_somebody_watches(ros, studio):
    publisher = ros.node.create_publisher(String, "/chat", 10)
    studio.subscribe(1, "/chat")
    ros.until(lambda: publisher.get_subscription_count() == 1)
    studio.send(ms.Unsubscribe((1,)))
    ros.until(lambda: publisher.get_subscription_count() == 0)


def test_a_client_that_leaves_ends_its_subscriptions(ros, bridge):
    publisher = ros.node.create_publisher(String, "/chat", 10)
    with Studio(bridge().port, ros.until) as studio:
        studio.subscribe(1, "/chat")
        ros.until(lambda: publisher.get_subscription_count() == 1)
    ros.until(lambda: publisher.get_subscription_count() == 0)


def test_a_best_effort_publisher_is_heard(ros, studio):
    publisher = ros.node.create_publisher(String, "/chat", BEST_EFFORT)
    studio.subscribe(1, "/chat")
    ros.until(publisher.get_subscription_count)
    publisher.publish(String(data="x"))
    assert studio.next(ms.MessageData).subscription_id == 1


def test_a_latched_message_is_given_to_every_newcomer_once(ros, bridge):
    publisher = ros.node.create_publisher(String, "/description", LATCHED)
    publisher.publish(String(data="old"))
    port = bridge().port
    with Studio(port, ros.until) as first, Studio(port, ros.until) as second:
        first.subscribe(1, "/description")
        payload = first.next(ms.MessageData).payload
        assert deserialize_message(payload, String).data == "old"
        second.subscribe(2, "/description")
        assert second.next(ms.MessageData).payload == payload
        publisher.publish(String(data="new"))
        for client in (first, second):
            assert deserialize_message(client.next(ms.MessageData).payload, String).data == "new"


def test_a_latched_publisher_that_comes_after_the_client_is_heard(ros, studio):
    ros.node.create_subscription(String, "/description", lambda _: None, 1)
    studio.subscribe(1, "/description")
    publisher = ros.node.create_publisher(String, "/description", LATCHED)
    publisher.publish(String(data="late"))
    assert deserialize_message(studio.next(ms.MessageData).payload, String).data == "late"


def test_clients_that_come_and_go_leave_no_subscription_behind(ros, bridge):
    publisher = ros.node.create_publisher(String, "/chat", 10)
    port = bridge().port
    for number in range(20):
        with Studio(port, ros.until) as studio:
            studio.subscribe(number, "/chat")
            studio.advertise(number, "/back", "std_msgs/msg/String")
            ros.until(lambda: ros.node.count_publishers("/back"))
    ros.until(lambda: publisher.get_subscription_count() == 0)
    ros.until(lambda: ros.node.count_publishers("/back") == 0)


def test_a_vanished_topic_is_taken_away(ros, studio):
    publisher = ros.node.create_publisher(String, "/chat", 10)
    studio.channel("/chat")
    ros.node.destroy_publisher(publisher)
    ros.until(lambda: "/chat" not in studio.read().channels)


def test_hidden_and_unlisted_topics_are_not_offered(ros, bridge):
    with Studio(bridge(topic_whitelist=("/list.*",)).port, ros.until) as studio:
        for topic in ("/other", "/_hidden/list", "/list/_hidden", "/list/shown"):
            ros.node.create_publisher(Bool, topic, 1)
        studio.channel("/list/shown")
        assert set(studio.channels) == {"/list/shown"}


@pytest.mark.skipif(not tf_messages.available(), reason="no transforms here")
def test_transforms_reach_the_client_without_tf2_msgs(ros, studio):
    publisher = ros.node.create_publisher(tf_messages.TFMessage, "/tf", 10)
    studio.subscribe(1, "/tf")
    assert "MSG: geometry_msgs/TransformStamped" in studio.channel("/tf").schema
    ros.until(publisher.get_subscription_count)
    data = tf_messages.encode([tf_messages.Transform(5, "odom", "base_link", (1.0, 2.0, 0.0), (0.0, 0.0, 0.0, 1.0))])
    publisher.publish(data)
    assert studio.next(ms.MessageData).payload == data


# --- client publish ---


def test_a_clients_twist_reaches_a_subscriber(ros, studio):
    twists = []
    ros.node.create_subscription(Twist, "/cmd_vel", twists.append, 10)
    twist = Twist(linear=Vector3(x=0.1))
    studio.advertise(1, "/cmd_vel", "geometry_msgs/Twist")
    studio.send(ms.ClientMessageData(1, serialize_message(twist)))
    ros.until(lambda: twists)
    assert twists == [twist]


def test_a_client_may_publish_json(ros, studio):
    arrays = []
    ros.node.create_subscription(Int16MultiArray, "/motor/target", arrays.append, 10)
    studio.advertise(1, "motor/target", "std_msgs/msg/Int16MultiArray", JSON)
    studio.send(ms.ClientMessageData(1, b'{"data": [100, -100]}'))
    ros.until(lambda: arrays)
    assert list(arrays[0].data) == [100, -100]


def test_two_clients_with_equal_channel_ids_publish_each_to_its_own_topic(ros, bridge):
    heard = []
    for topic in ("/a", "/b"):
        ros.node.create_subscription(String, topic, lambda m, topic=topic: heard.append((topic, m.data)), 10)
    port = bridge().port
    with Studio(port, ros.until) as second:
        with Studio(port, ros.until) as first:
            first.advertise(1, "/a", "std_msgs/String", JSON)
            second.advertise(1, "/b", "std_msgs/String", JSON)
            first.send(ms.ClientMessageData(1, b'{"data": "first"}'))
            second.send(ms.ClientMessageData(1, b'{"data": "second"}'))
            ros.until(lambda: len(heard) == 2)
        second.send(ms.ClientMessageData(1, b'{"data": "again"}'))
        ros.until(lambda: len(heard) == 3)
    assert sorted(heard) == [("/a", "first"), ("/b", "again"), ("/b", "second")]


def test_a_ros_publisher_lives_as_long_as_its_last_client_channel(ros, bridge):
    subscription = ros.node.create_subscription(String, "/a", lambda _: None, 10)
    port = bridge().port
    with Studio(port, ros.until) as first:
        with Studio(port, ros.until) as second:
            first.advertise(1, "/a", "std_msgs/String")
            second.advertise(9, "/a", "std_msgs/msg/String")
            ros.until(lambda: subscription.get_publisher_count() == 1)
        ros.until(lambda: ros.node.count_publishers("/a") == 1)
    ros.until(lambda: subscription.get_publisher_count() == 0)


@pytest.mark.parametrize(
    ("payload", "text"),
    [
        (b"\0\1\0\0\1", "/cmd_vel: expected a geometry_msgs/msg/Twist in cdr"),
        (b"", "/cmd_vel: expected a geometry_msgs/msg/Twist in cdr"),
        (serialize_message(Twist(linear=Vector3(x=math.nan))), "/cmd_vel: a velocity that is not a number"),
        (serialize_message(Twist(angular=Vector3(z=math.inf))), "/cmd_vel: a velocity that is not a number"),
    ],
)
def test_a_bad_twist_is_refused_and_the_next_good_one_taken(ros, studio, payload, text):
    twists = []
    ros.node.create_subscription(Twist, "/cmd_vel", twists.append, 10)
    studio.advertise(1, "/cmd_vel", "geometry_msgs/Twist")
    studio.send(ms.ClientMessageData(1, payload))
    status = studio.next(ms.Status)
    assert status.level == StatusLevel.ERROR
    assert status.message.startswith(text)
    studio.send(ms.ClientMessageData(1, serialize_message(Twist())))
    ros.until(lambda: twists)
    assert twists == [Twist()]


@pytest.mark.parametrize(
    ("topic", "schema", "text"),
    [
        ("/a", "no_such_msgs/msg/Thing", "/a: type no_such_msgs/msg/Thing is not available"),
        ("/a", "nonsense", "/a: type nonsense is not available: expected package/msg/Type"),
        ("/a b", "std_msgs/msg/Bool", "/a b: not a topic name"),
    ],
)
def test_a_channel_that_cannot_be_published_is_refused(studio, topic, schema, text):
    studio.advertise(1, topic, schema)
    assert studio.next(ms.Status).message.startswith(text)


def test_a_second_type_on_a_topic_is_refused(ros, studio):
    ros.node.create_subscription(Twist, "/cmd_vel", lambda _: None, 10)
    studio.advertise(1, "/cmd_vel", "std_msgs/msg/Bool")
    assert studio.next(ms.Status).message == "/cmd_vel: cannot publish std_msgs/msg/Bool here, it carries another type"


def test_clients_publish_only_where_they_may(ros, bridge):
    with Studio(bridge(client_topic_whitelist=("/cmd_vel",)).port, ros.until) as studio:
        studio.advertise(1, "/other", "std_msgs/msg/Bool")
        assert "client_topic_whitelist" in studio.next(ms.Status).message


# --- services ---


def flip(request, response):
    response.success = request.data
    response.message = "done"
    return response


@pytest.mark.parametrize(
    ("encoding", "request_bytes"),
    [(CDR, serialize_message(SetBool.Request(data=True))), (JSON, b'{"data": true}')],
)
def test_a_service_answers(ros, studio, encoding, request_bytes):
    ros.node.create_service(SetBool, "/flip", flip)
    service = studio.service("/flip")
    studio.send(ms.ServiceRequest(service.id, 42, encoding, request_bytes))
    answer = studio.next(ms.ServiceResponse)
    assert (answer.service_id, answer.call_id, answer.encoding) == (service.id, 42, encoding)
    if encoding == CDR:
        assert deserialize_message(answer.payload, SetBool.Response) == SetBool.Response(success=True, message="done")
    else:
        assert answer.payload == b'{"success":true,"message":"done"}'


def test_a_service_carries_the_definitions_of_both_sides(ros, studio):
    ros.node.create_service(SetBool, "/flip", flip)
    service = studio.service("/flip")
    assert (service.type, service.request.schema_name) == ("std_srvs/srv/SetBool", "std_srvs/srv/SetBool_Request")
    assert "bool data" in service.request.schema
    assert "string message" in service.response.schema


@pytest.mark.parametrize(
    ("encoding", "payload", "text"),
    [
        (CDR, b"", "/flip: undecodable request"),
        (JSON, b'{"no": 1}', "/flip: undecodable request: message: no field no"),
        ("protobuf", b"", "/flip: undecodable request: expected encoding cdr or json, found protobuf"),
    ],
)
def test_an_undecodable_request_fails_with_a_status_beside_it(ros, studio, encoding, payload, text):
    ros.node.create_service(SetBool, "/flip", flip)
    studio.send(ms.ServiceRequest(studio.service("/flip").id, 1, encoding, payload))
    failure = studio.next(ms.ServiceCallFailure)
    assert failure.call_id == 1
    assert failure.message.startswith(text)
    assert studio.next(ms.Status).message == failure.message


def test_a_service_that_does_not_answer_fails_in_the_end(ros, bridge, monkeypatch):
    monkeypatch.setattr(foxglove_node, "Calls", functools.partial(Calls, timeout_s=0.1))
    ros.node.create_service(Trigger, "/mute", lambda request, response: pytest.fail("not to be called"))
    with Studio(bridge().port, ros.until) as studio:
        service = studio.service("/mute")
        ros.node.destroy_service(next(item for item in ros.node.services if item.srv_name == "/mute"))
        studio.send(ms.ServiceRequest(service.id, 1, CDR, serialize_message(Trigger.Request())))
        failure = studio.next(ms.ServiceCallFailure)
    assert failure.call_id == 1


def test_parameter_services_are_not_offered(ros, studio, peer):
    ros.node.create_service(SetBool, "/flip", flip)
    studio.service("/flip")
    assert not [name for name in studio.services if name.startswith("/peer/")]


# --- parameters ---


def test_parameters_of_all_nodes_can_be_read(studio, peer):
    assert studio.parameter("/peer.speed") == 1.5
    assert studio.parameter("/peer.program") == "good"
    assert studio.parameter("/foxglove_bridge.port") == 0


def set_and_answer(studio, *parameters):
    """Everything told from the wish to its answer."""
    studio.read()
    studio.received.clear()
    studio.send(ms.SetParameters(parameters, "mine"))
    told = []
    while not (told and isinstance(told[-1], ms.ParameterValues) and told[-1].id == "mine"):
        told.append(studio.next(object))
    return told


def test_a_parameter_is_set_and_its_old_complaint_removed(studio, peer):
    studio.parameter("/peer.program")
    told = set_and_answer(studio, ms.Parameter("/peer.program", "better"))
    assert told == [
        ms.RemoveStatus(("parameter:/peer.program",)),
        ms.ParameterValues((ms.Parameter("/peer.program", "better"),), "mine"),
    ]
    assert peer.get_parameter("program").value == "better"


def test_a_refused_value_is_told_before_the_answer_with_the_value_in_force(studio, peer):
    studio.parameter("/peer.program")
    told = set_and_answer(studio, ms.Parameter("/peer.program", "bad"))
    assert told == [
        ms.Status(StatusLevel.ERROR, "/peer.program: line 3, column 5: bad", "parameter:/peer.program"),
        ms.ParameterValues((ms.Parameter("/peer.program", "good"),), "mine"),
    ]


def test_several_values_are_answered_together_each_with_its_own_fate(studio, peer):
    studio.parameter("/peer.program")
    wishes = ms.Parameter("/peer.speed", 2), ms.Parameter("/peer.program", "bad"), ms.Parameter("/no/node.x", 1)
    removed, *complaints, answer = set_and_answer(studio, *wishes)
    assert removed == ms.RemoveStatus(("parameter:/peer.speed",))
    assert {status.id for status in complaints} == {"parameter:/peer.program", "parameter:/no/node.x"}
    expected = (ms.Parameter("/peer.speed", 2.0, "float64"), ms.Parameter("/peer.program", "good"))
    assert answer == ms.ParameterValues(expected, "mine")


@pytest.mark.parametrize(
    ("wish", "text"),
    [
        (ms.Parameter("/peer.fixed", 2), "/peer.fixed: "),
        (ms.Parameter("/peer.speed", "fast"), "/peer.speed: "),
        (ms.Parameter("/peer.count", (1, "x")), "/peer.count: a list must have elements of one kind"),
        (ms.Parameter("/peer", 1), "/peer: not offered by this bridge"),
        (ms.Parameter("/peer.count", 2**70), "/peer.count: expected an integer of 64 bits"),
    ],
)
def test_what_cannot_be_set_is_refused_with_a_reason(studio, peer, wish, text):
    studio.parameter("/peer.program")
    status, _ = set_and_answer(studio, wish)
    assert status.message.startswith(text)
    assert len(status.message) > len(text) or text.count(":") == 1


def test_a_change_from_elsewhere_reaches_those_who_asked(ros, bridge, peer):
    port = bridge().port
    with Studio(port, ros.until) as watcher, Studio(port, ros.until) as setter:
        setter.parameter("/peer.speed")
        watcher.send(ms.SubscribeParameterUpdates(("/peer.speed",)))
        watcher.send(ms.GetParameters((), "settle"))
        watcher.next(ms.ParameterValues, lambda answer: answer.id == "settle")
        set_and_answer(setter, ms.Parameter("/peer.speed", 3.5))
        assert watcher.next(ms.ParameterValues).parameters == (ms.Parameter("/peer.speed", 3.5, "float64"),)


def test_a_change_by_the_node_itself_reaches_those_who_asked(studio, peer):
    studio.parameter("/peer.count")
    studio.send(ms.SubscribeParameterUpdates(("/peer.count",)))
    studio.send(ms.GetParameters((), "settle"))
    studio.next(ms.ParameterValues, lambda answer: answer.id == "settle")
    peer.set_parameters([peer.get_parameter("count").__class__("count", value=4)])
    assert studio.next(ms.ParameterValues).parameters == (ms.Parameter("/peer.count", 4),)


def test_unlisted_parameters_are_neither_shown_nor_set(ros, bridge, peer):
    with Studio(bridge(param_whitelist=(r"/peer\.speed",)).port, ros.until) as studio:
        studio.parameter("/peer.speed")
        studio.send(ms.GetParameters((), "all"))
        answer = studio.next(ms.ParameterValues, lambda values: values.id == "all")
        assert [item.name for item in answer.parameters] == ["/peer.speed"]
        status, _ = set_and_answer(studio, ms.Parameter("/peer.count", 9))
        assert status.message == "/peer.count: not offered by this bridge"


# --- hostile clients ---


def test_a_storm_of_changed_bytes_harms_nobody_else(ros, bridge, peer):
    rng = random.Random(7)
    ros.node.create_subscription(Twist, "/cmd_vel", lambda _: None, 10)
    ros.node.create_service(SetBool, "/flip", flip)
    port = bridge().port
    with Studio(port, ros.until) as fuzzer, Studio(port, ros.until) as other:
        fuzzer.advertise(1, "/cmd_vel", "geometry_msgs/Twist")
        fuzzer.advertise(2, "/cmd_vel", "geometry_msgs/Twist", JSON)
        service = fuzzer.service("/flip").id
        fuzzer.parameter("/peer.speed")

        def changed(data):
            at = rng.randrange(len(data))
            return data[:at] + rng.randbytes(rng.randrange(3)) + data[at + 1 :]

        for _ in range(60):
            fuzzer.send(
                ms.ClientMessageData(1, changed(serialize_message(Twist()))),
                ms.ClientMessageData(2, changed(b'{"linear": {"x": 1.0}, "angular": {"z": [1]}}')),
                ms.ServiceRequest(service, 1, CDR, changed(serialize_message(SetBool.Request()))),
                ms.ServiceRequest(service, 2, JSON, changed(b'{"data": true}')),
                ms.SetParameters((ms.Parameter("/peer.speed", rng.choice([1, "x", 2.5, (1, 2), None, True, 2**80])),)),
            )
            ros.spin()
        assert set_and_answer(other, ms.Parameter("/peer.count", 5))[-1].parameters == (ms.Parameter("/peer.count", 5),)
        other.subscribe(1, "/cmd_vel")
        other.advertise(1, "/cmd_vel", "geometry_msgs/Twist")
        other.send(ms.ClientMessageData(1, serialize_message(Twist(linear=Vector3(x=0.25)))))
        other.next(ms.MessageData, lambda data: deserialize_message(data.payload, Twist).linear.x == 0.25)


# --- time ---


def test_simulated_time_is_told_and_a_step_back_begins_a_new_session(ros, bridge):
    publisher = ros.node.create_publisher(Clock, "/clock", 1)
    with Studio(bridge(use_sim_time=True).port, ros.until) as studio:
        first = studio.next(ms.ServerInfo)
        assert "time" in first.capabilities
        assert studio.next(ms.Time) == ms.Time(0)
        ros.until(publisher.get_subscription_count)
        publisher.publish(clock(5))
        assert studio.next(ms.Time) == ms.Time(5_000_000_000)
        publisher.publish(clock(1))
        assert studio.next(ms.ServerInfo).session_id != first.session_id
        assert studio.next(ms.Time) == ms.Time(1_000_000_000)


def test_messages_are_stamped_with_simulated_time(ros, bridge):
    clocks = ros.node.create_publisher(Clock, "/clock", 1)
    publisher = ros.node.create_publisher(String, "/chat", 10)
    with Studio(bridge(use_sim_time=True).port, ros.until) as studio:
        ros.until(clocks.get_subscription_count)
        clocks.publish(clock(5))
        studio.next(ms.Time, lambda time: time.time_ns > 0)
        studio.subscribe(1, "/chat")
        ros.until(publisher.get_subscription_count)
        publisher.publish(String())
        assert studio.next(ms.MessageData).time_ns == 5_000_000_000


def test_without_simulated_time_none_is_told(studio):
    assert "time" not in studio.next(ms.ServerInfo).capabilities


def clock(seconds):
    message = Clock()
    message.clock.sec = seconds
    return message


# --- connection graph, assets ---


def test_the_connection_graph_names_publishers_subscribers_and_providers(ros, studio):
    ros.node.create_publisher(String, "/chat", 10)
    ros.node.create_subscription(String, "/chat", lambda _: None, 10)
    ros.node.create_service(SetBool, "/flip", flip)
    studio.service("/flip")
    studio.channel("/chat")
    studio.send(ms.SubscribeConnectionGraph())
    update = studio.next(ms.ConnectionGraphUpdate)
    assert ms.PublishedTopic("/chat", ("/test",)) in update.published_topics
    assert ms.SubscribedTopic("/chat", ("/test",)) in update.subscribed_topics
    assert ms.AdvertisedService("/flip", ("/test",)) in update.advertised_services
    assert "/foxglove_bridge/get_parameters" not in [service.name for service in update.advertised_services]


def test_an_asset_that_is_not_there_is_an_error_for_its_request(studio):
    studio.send(ms.FetchAsset("package://std_msgs/no.stl", 3))
    assert studio.next(ms.AssetResponse) == ms.AssetResponse(3, b"", "package://std_msgs/no.stl does not exist")


# --- life ---


def test_a_port_in_use_is_one_clear_line(ros):
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
        ros.until(lambda: life.turn(executor) or condition(), what=what)

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


def test_the_greeting_says_where_to_connect(bridge):
    life = bridge()
    assert f"ws://localhost:{life.port}" in life.greeting
    assert f"ds.url=ws%3A%2F%2Flocalhost%3A{life.port}" in life.greeting
