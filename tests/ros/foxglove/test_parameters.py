"""Parameters of all nodes, read, set and watched by a real client."""

from __future__ import annotations

import pytest
from rcl_interfaces.msg import ParameterType, ParameterValue
from rcl_interfaces.srv import DescribeParameters, GetParameters, GetParameterTypes, ListParameters, SetParameters
from rclpy.node import Node
from rclpy.parameter import Parameter

from tests.bridge.studio import Studio, set_and_answer
from thymio_sim_ros.bridge.protocol import messages as ms
from thymio_sim_ros.bridge.protocol.constants import StatusLevel
from thymio_sim_ros.bridge.switchboard.outcome import MAX_REFUSALS


def test_parameters_of_all_nodes_can_be_read(studio, peer):
    assert studio.parameter("/peer.speed") == 1.5
    assert studio.parameter("/peer.program") == "good"
    assert studio.parameter("/foxglove_bridge.port") == 0


def test_a_parameter_is_set_and_its_earlier_status_removed(studio, peer):
    studio.parameter("/peer.program")
    messages = set_and_answer(studio, ms.Parameter("/peer.program", "better"))
    assert messages == [
        ms.RemoveStatus(("parameter:/peer.program",)),
        ms.ParameterValues((ms.Parameter("/peer.program", "better"),), "mine"),
    ]
    assert peer.get_parameter("program").value == "better"


def test_a_rejection_is_reported_before_the_answer_with_the_current_value(studio, peer):
    studio.parameter("/peer.program")
    messages = set_and_answer(studio, ms.Parameter("/peer.program", "bad"))
    assert messages == [
        ms.Status(StatusLevel.ERROR, "/peer.program: line 3, column 5: bad", "parameter:/peer.program"),
        ms.ParameterValues((ms.Parameter("/peer.program", "good"),), "mine"),
    ]


def test_several_values_are_answered_together_each_with_its_own_result(studio, peer):
    studio.parameter("/peer.program")
    debug_options = ms.Parameter("/peer.speed", 2), ms.Parameter("/peer.program", "bad"), ms.Parameter("/no/node.x", 1)
    removed, *complaints, answer = set_and_answer(studio, *debug_options)
    assert removed == ms.RemoveStatus(("parameter:/peer.speed",))
    assert {status.id for status in complaints} == {"parameter:/peer.program", "parameter:/no/node.x"}
    expected = (ms.Parameter("/peer.speed", 2.0, "float64"), ms.Parameter("/peer.program", "good"))
    assert answer == ms.ParameterValues(expected, "mine")


@pytest.mark.parametrize(
    ("wish", "text"),
    [
        (ms.Parameter("/peer.fixed", 2), "/peer.fixed: "),
        (ms.Parameter("/peer.speed", "fast"), "/peer.speed: "),
        (
            ms.Parameter("/peer.count", (1, "x")),
            "/peer.count: expected a list with elements of one type, found several types",
        ),
        (ms.Parameter("/peer", 1), "/peer: not offered by this bridge"),
        (ms.Parameter("/peer.count", 2**70), "/peer.count: expected an integer of 64 bits"),
    ],
)
def test_a_parameter_that_cannot_be_set_is_rejected_with_the_reason(studio, peer, wish, text):
    studio.parameter("/peer.program")
    status, _ = set_and_answer(studio, wish)
    assert status.message.startswith(text)
    assert len(status.message) > len(text) or text.count(":") == 1


def test_a_change_by_another_client_reaches_watching_clients(ros, bridge, peer):
    port = bridge().port
    with Studio(port, ros.until) as watcher, Studio(port, ros.until) as setter:
        setter.parameter("/peer.speed")
        watcher.send(ms.SubscribeParameterUpdates(("/peer.speed",)))
        watcher.send(ms.GetParameters((), "settle"))
        watcher.next(ms.ParameterValues, lambda answer: answer.id == "settle")
        set_and_answer(setter, ms.Parameter("/peer.speed", 3.5))
        assert watcher.next(ms.ParameterValues).parameters == (ms.Parameter("/peer.speed", 3.5, "float64"),)


def test_a_change_by_the_node_reaches_watching_clients(studio, peer):
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


def test_a_parameter_that_was_never_set_hides_no_other(ros, studio, peer):
    """rclpy then answers without any value; an exception in the callback of the answer once ended the process."""
    node = ros.add(Node("later", context=ros.context, enable_rosout=False))
    node.declare_parameter("now", 7)
    node.declare_parameter("later", Parameter.Type.STRING)
    assert studio.parameter("/later.now") == 7
    node.set_parameters([Parameter("later", value="here")])
    assert studio.parameter("/later.later") == "here"


def test_an_unknown_parameter_is_rejected_and_the_bridge_continues(studio, peer):
    studio.parameter("/peer.program")
    status, _ = set_and_answer(studio, ms.Parameter("/peer.sped", 1))
    assert status.message == "/peer.sped: found unknown parameter sped of /peer (did you mean speed?)"
    status, _ = set_and_answer(studio, ms.Parameter("/pear.speed", 1))
    assert status.message == "/pear.speed: no node /pear with parameters (did you mean /peer?)"
    status, _ = set_and_answer(studio, ms.Parameter("/peer.\ud800", 1))
    assert status.message.endswith("not offered by this bridge")
    status, _ = set_and_answer(studio, ms.Parameter("/peer.program", "half \ud800"))
    assert "expected Unicode text" in status.message
    assert set_and_answer(studio, ms.Parameter("/peer.program", "better"))[-1].parameters[0].value == "better"


def test_an_unknown_parameter_that_is_read_is_named_with_the_nearest_one(studio, peer):
    studio.parameter("/peer.speed")
    studio.send(ms.GetParameters(("/peer.speed", "/peer.sped", "/foxglove_bridge.nothing", "/peer"), "mine"))
    sentences = {
        "/peer.sped": "found unknown parameter sped of /peer (did you mean speed?)",
        "/foxglove_bridge.nothing": "found unknown parameter nothing of /foxglove_bridge;"
        " `ros2 param list /foxglove_bridge` lists them",
        "/peer": "not offered by this bridge",
    }
    for name, sentence in sentences.items():
        assert studio.next(ms.Status) == ms.Status(StatusLevel.WARNING, f"{name}: {sentence}", f"parameter:{name}")
    answer = studio.next(ms.ParameterValues, lambda values: values.id == "mine")
    assert answer.parameters == (ms.Parameter("/peer.speed", 1.5, "float64"),)


def test_of_many_rejections_only_some_are_reported(studio, peer):
    studio.parameter("/peer.program")
    *statuses, _ = set_and_answer(studio, *(ms.Parameter(f"/no/node.x{number}", 1) for number in range(1000)))
    assert len(statuses) == MAX_REFUSALS + 1
    assert statuses[-1].message == f"{1000 - MAX_REFUSALS} more parameters were rejected"


def test_a_request_that_was_not_answered_is_repeated(ros, bridge):
    server = bridge()
    server._calls._timeout_s = 0.2
    slow = Node("slow", context=ros.context, enable_rosout=False)
    slow.declare_parameter("speed", 2.5)
    with Studio(server.port, ros.until) as studio:
        studio.send(ms.SubscribeParameterUpdates(("/slow.speed",)))
        ros.until(lambda: "/slow" in server._parameters._unread, what="the node did not answer in time")
        ros.add(slow)
        assert studio.parameter("/slow.speed") == 2.5


class Stranger:
    """A node that records calls of its parameter services."""

    def __init__(self, ros, name="stranger"):
        self.node = node = ros.make_node(name)
        self.asked = []
        for kind in (ListParameters, GetParameters, SetParameters, GetParameterTypes, DescribeParameters):
            service = "".join(f"_{letter.lower()}" if letter.isupper() else letter for letter in kind.__name__)
            node.create_service(kind, f"~/{service[1:]}", self.note)

    def note(self, request, response):
        self.asked.append(type(request).__name__)
        if isinstance(request, ListParameters.Request):
            response.result.names = ["here"]
        if isinstance(request, GetParameters.Request):
            response.values = [ParameterValue(type=ParameterType.PARAMETER_INTEGER, integer_value=5)]
        return response


def test_no_clients_remain_of_a_node_that_ended_during_a_call(ros, bridge):
    """A call that ends reads the value back, which must not create a client of the node that ended."""
    peer = Stranger(ros, "short").node
    ending = next(service for service in peer.services if service.srv_name.endswith("/set_parameters"))
    peer.destroy_service(ending)
    mute = Node("mute", context=ros.context, enable_rosout=False, start_parameter_services=False)  # not spun
    mute.create_service(SetParameters, "/short/set_parameters", lambda request, response: response)
    server = bridge()
    with Studio(server.port, ros.until) as studio:
        studio.parameter("/short.here")
        studio.send(ms.SetParameters((ms.Parameter("/short.here", 3),), "late"))
        ros.until(lambda: server.node.count_clients("/short/set_parameters"), what="the call is open")
        for service in list(peer.services):
            peer.destroy_service(service)
        assert studio.next(ms.Status).message == "/short.here: service /short/set_parameters no longer exists"
        studio.next(ms.ParameterValues, lambda values: values.id == "late")
        names = [f"/short/{kind}_parameters" for kind in ("list", "get", "set")]
        ros.until(lambda: not any(map(server.node.count_clients, names)), what="no client remains")
    mute.destroy_node()


def test_nodes_get_no_requests_before_a_client_requests_parameters(ros, bridge, peer):
    """A request may print warnings in a student's terminal."""
    stranger = Stranger(ros)
    server = bridge()
    ros.until(lambda: "/stranger" in server._parameters._present)
    with Studio(server.port, ros.until) as studio:
        # What our page does: it watches parameters of our nodes, and no others.
        studio.send(ms.SubscribeParameterUpdates(("/peer.speed",)))
        assert studio.parameter("/peer.speed") == 1.5
        assert set_and_answer(studio, ms.Parameter("/peer.count", 5))[-1].parameters[0].value == 5
        assert stranger.asked == []
        studio.send(ms.GetParameters((), "all"))
        answer = studio.next(ms.ParameterValues, lambda values: values.id == "all")
        assert ms.Parameter("/stranger.here", 5) in answer.parameters
        assert stranger.asked == ["ListParameters_Request", "GetParameters_Request"]


def test_new_nodes_get_no_requests_after_the_last_client_has_disconnected(ros, bridge, peer):
    server = bridge()
    with Studio(server.port, ros.until) as studio:
        studio.send(ms.GetParameters((), "all"))
        studio.next(ms.ParameterValues)
    ros.until(lambda: not server._parameters._wants_all)
    stranger = Stranger(ros)
    ros.until(lambda: "/stranger" in server._parameters._present)
    with Studio(server.port, ros.until) as studio:
        assert studio.parameter("/peer.speed") == 1.5
    assert stranger.asked == []


def test_a_node_that_does_not_answer_delays_the_first_answer_by_a_second_only(ros, bridge, peer):
    server = bridge()
    mute = Node("mute", context=ros.context, enable_rosout=False)  # not spun
    with Studio(server.port, ros.until) as studio:
        ros.until(lambda: {"/mute", "/peer"} <= server._parameters._present)
        studio.send(ms.GetParameters((), "all"))
        answer = studio.next(ms.ParameterValues)
        assert ms.Parameter("/peer.count", 3) in answer.parameters
        assert "/mute" in server._parameters._reading
    mute.destroy_node()


def test_a_watched_node_that_starts_later_gets_requests_then(ros, bridge):
    with Studio(bridge().port, ros.until) as studio:
        studio.send(ms.SubscribeParameterUpdates(("/later.now",)))
        node = ros.add(Node("later", context=ros.context, enable_rosout=False))
        node.declare_parameter("now", 7)
        assert studio.next(ms.ParameterValues).parameters == (ms.Parameter("/later.now", 7),)


@pytest.mark.slow
def test_2000_requests_at_once_are_set_or_rejected_and_others_are_served(ros, bridge, peer):
    port = bridge().port
    with Studio(port, ros.until) as busy, Studio(port, ros.until) as other:
        assert other.parameter("/peer.count") == 3
        for number in range(2000):
            busy.send(ms.SetParameters((ms.Parameter("/peer.count", number),), str(number)))
        assert set_and_answer(other, ms.Parameter("/peer.speed", 2.5))[-1].parameters[0].value == 2.5
        answers = {busy.next(ms.ParameterValues).id for _ in range(2000)}
        assert answers == {str(number) for number in range(2000)}
        assert set_and_answer(busy, ms.Parameter("/peer.count", 5))[-1].parameters[0].value == 5
