"""Events of programs ↔ topics, both ways, and the Aseba network of robots and runtimes."""

from __future__ import annotations

import math

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from nav_msgs.msg import Odometry
from rcl_interfaces.msg import Log
from std_msgs.msg import Empty, Int16MultiArray, MultiArrayDimension
from std_srvs.srv import Trigger

from tests.ros.aseba_tools import Status, event, get_variables, press, set_parameters
from thymio_sim_ros.engine.devices import MAX_ROUNDS
from thymio_sim_ros.ros.aseba.network import TOPIC
from thymio_sim_ros.ros.aseba.node import AsebaRuntime, RuntimeParams
from thymio_sim_ros.ros.rclpy_ext import message_reports

TWO = {"robots": ["anna", "bert"]}


def program(code, *events):
    declared = "".join(f'<event name="{name}" size="{size}"/>\n' for name, size in events)
    return f'<network>\n{declared}<node name="thymio-II">{code}</node></network>'


HEAR = program(
    "var heard[2]\nvar from = -1\nvar times = 0\nonevent ping\nheard = event.args[0:1]\nfrom = event.source\n"
    "times = times + 1\nonevent button.left\nemit ping [7, 8]",
    ("ping", 2),
)


def logged(ros, logs, text):
    ros.until(lambda: any(text in message.msg for message in logs), what=f"the log: {text}")


def test_an_event_from_ros_reaches_every_robot_that_declares_it(ros, runtime):
    runtime(HEAR, **TWO)
    ros.publisher(Int16MultiArray, "/anna/aseba/emit/ping").publish(Int16MultiArray(data=[1]))
    for robot in ("/anna", "/bert"):
        ros.until(lambda robot=robot: get_variables(ros, "heard", "from", robot=robot) == [[1, 0], [0]])


def test_an_event_from_ros_can_be_for_one_robot_only(ros, runtime):
    runtime(HEAR, **TWO, emit_reaches="robot")
    ros.publisher(Int16MultiArray, "/bert/_aseba/emit").publish(event("ping", 3, 4))
    ros.until(lambda: get_variables(ros, "heard", robot="/bert") == [[3, 4]])
    assert get_variables(ros, "times", robot="/anna") == [[0]]
    assert set_parameters(ros, {"emit_reaches": "network"}).successful
    ros.publisher(Int16MultiArray, "/bert/_aseba/emit").publish(event("ping", 5))
    ros.until(lambda: get_variables(ros, "heard", robot="/anna") == [[5, 0]])


def test_an_event_that_only_another_robot_declares_reaches_it(ros, runtime):
    runtime(HEAR, **TWO)
    assert set_parameters(ros, {"robots.anna.script.source": "var a"}).successful
    ros.publisher(Int16MultiArray, "/anna/_aseba/emit").publish(event("ping", 9))
    ros.until(lambda: get_variables(ros, "heard", robot="/bert") == [[9, 0]])


@pytest.mark.parametrize(
    ("message", "found"),
    [
        (event("ping", 1, 2, 3), "event ping rejected: found 3 values, expected at most 2"),
        (event("pong"), "event pong rejected: the program declares ping"),
        (event("menu.start", 1), "event menu.start rejected: internal events stay in the robot"),
        (Int16MultiArray(data=[1]), "layout.dim[0].label must be the name of the event"),
    ],
)
def test_an_invalid_event_is_rejected_with_a_warning(ros, runtime, message, found):
    runtime(HEAR)
    logs = ros.collect(Log, "/rosout")
    ros.publisher(Int16MultiArray, "/_aseba/emit").publish(message)
    logged(ros, logs, found)
    assert get_variables(ros, "times") == [[0]]


def test_rejected_events_are_in_the_diagnostics(ros, runtime, monkeypatch):
    monkeypatch.setattr(message_reports, "RECENT_S", math.inf)
    runtime(HEAR, **TWO)
    received = ros.collect(DiagnosticArray, "/diagnostics")
    for topic, message in (
        ("/anna/_aseba/emit", event("pong")),
        ("/anna/_aseba/emit", event("ping", 1, 2, 3)),
        ("/bert/aseba/emit/ping", Int16MultiArray(data=[1] * 4)),
        ("/bert/_aseba/emit", Int16MultiArray(data=[1])),
        (TOPIC, event("ping", 1)),
    ):
        ros.publisher(Int16MultiArray, topic).publish(message)

    def status():
        statuses = [one for one in received[-1].status if one.name == "aseba_runtime: messages"] if received else []
        return statuses[0] if statuses and len(statuses[0].values) == 7 else None

    found = ros.until(status)
    values = [(pair.key, pair.value) for pair in found.values]
    assert values[:2] == [("rejected", "5"), ("clamped", "0")]
    texts = dict(values[2:])
    assert found.level == DiagnosticStatus.WARN
    assert found.message in texts.values()
    network = f"/{TOPIC}"
    assert texts == {
        "anna: event pong": "anna: event pong rejected: the program declares ping",
        "anna: event ping": "anna: event ping rejected: found 3 values, expected at most 2",
        "bert: event ping": "bert: event ping rejected: found 4 values, expected at most 2",
        "/bert/_aseba/emit": "/bert/_aseba/emit rejected: found 0 dimensions, expected 1:"
        " layout.dim[0].label must be the name of the event",
        network: f"{network} rejected: found 1 labels and 1 values, expected 2 and 3 or more",
    }


def test_one_warning_does_not_hide_another(ros, runtime):
    runtime(HEAR)
    logs = ros.collect(Log, "/rosout")
    emit = ros.publisher(Int16MultiArray, "/_aseba/emit")
    for number in range(20):
        emit.publish(event("pong", number))
    emit.publish(event("ping", 1, 2, 3))
    logged(ros, logs, "event ping rejected: found 3 values, expected at most 2")
    assert sum("event pong rejected" in log.msg for log in logs) == 1


def test_an_event_whose_name_is_too_long_for_a_topic_has_none(ros, runtime):
    node = runtime("var a", robots=["anna"])
    logs = ros.collect(Log, "/rosout")
    name = "e" * 250
    assert set_parameters(
        ros, {"script.source": program(f"var {'v' * 245} = 7", (name, 0)), "watch": ["v" * 245]}
    ).successful
    logged(ros, logs, f"event {name} has a name that is too long for a topic: use _aseba/events and _aseba/emit")
    assert node.robots[0].program.events


def test_robots_receive_events_of_others_but_not_their_own(ros, runtime):
    runtime(HEAR, **TWO)
    reported = ros.collect(Int16MultiArray, "/anna/aseba/events/ping")
    press(ros, "left", "/anna")
    ros.until(lambda: reported and list(reported[0].data) == [7, 8])
    assert get_variables(ros, "heard", "from", robot="/bert") == [[7, 8], [1]]
    assert get_variables(ros, "times", robot="/anna") == [[0]]


def test_robots_that_answer_each_other_endlessly_do_not_starve_others(ros, runtime):
    source = "var n = 0\nonevent ball\nn = n + 1\nemit ball\nonevent button.left\nemit ball"
    node = runtime(program(source, ("ball", 0)), **TWO)
    anna, bert = (endpoints.device for endpoints in node.robots)
    press(ros, "left", "/anna")
    ros.until(lambda: bert.variables.get("n")[0] > 0)
    assert anna.variables.get("n")[0] + bert.variables.get("n")[0] <= MAX_ROUNDS
    before = bert.variables.get("n")[0]
    assert anna.is_busy or bert.is_busy
    node.robots.standalone.run()
    assert bert.variables.get("n")[0] > before
    assert ros.call(Trigger, "/anna/aseba/stop").success


def test_names_are_made_fit_for_topics_and_the_label_keeps_them(ros, runtime):
    runtime(program("onevent button.left\nemit a.b 1\nemit _ü 2", ("a.b", 1), ("_ü", 1)))
    plain = ros.collect(Int16MultiArray, "/aseba/events/a_b")
    anything = ros.collect(Int16MultiArray, "/_aseba/events")
    press(ros, "left")
    ros.until(lambda: plain and len(anything) == 2)
    assert [message.layout.dim[0].label for message in anything] == ["a.b", "_ü"]


def test_events_that_share_a_name_have_the_generic_pair_alone(ros, runtime):
    runtime("var a")
    logs = ros.collect(Log, "/rosout")
    source = program("onevent button.left\nemit a.b 1", ("a.b", 1), ("a_b", 1))
    assert set_parameters(ros, {"script.source": source}).successful
    logged(ros, logs, "event a.b has the same topic name a_b as another: use _aseba/events and _aseba/emit")
    anything = ros.collect(Int16MultiArray, "/_aseba/events")
    assert ros.node.count_publishers("/aseba/events/a_b") == 0
    press(ros, "left")
    ros.until(lambda: anything)


def test_topics_of_events_come_and_go_with_the_program(ros, runtime):
    runtime(HEAR)
    ros.until(lambda: ros.node.count_publishers("/aseba/events/ping") == 1)
    ros.until(lambda: ros.node.count_subscribers("/aseba/emit/ping") == 1)
    assert set_parameters(ros, {"script.source": program("var a", ("pong", 0))}).successful
    ros.until(lambda: ros.node.count_publishers("/aseba/events/ping") == 0)
    ros.until(lambda: ros.node.count_subscribers("/aseba/emit/pong") == 1)


def test_local_events_are_published_where_they_are_wanted(ros, runtime):
    runtime("var a", local_events=["tap", "button.left", "no.such"])
    tap = ros.collect(Int16MultiArray, "/aseba/events/tap")
    anything = ros.collect(Int16MultiArray, "/_aseba/events")
    ros.publisher(Empty, "/tap").publish(Empty())
    ros.until(lambda: tap and anything)
    assert list(tap[0].data) == []
    assert anything[0].layout.dim[0].label == "tap"
    assert ros.node.count_publishers("/aseba/events/motor") == 0
    assert set_parameters(ros, {"local_events": ["*"]}).successful
    motor = ros.collect(Int16MultiArray, "/aseba/events/motor")
    ros.publisher(Odometry, "/odom").publish(Odometry())
    ros.until(lambda: motor)
    assert set_parameters(ros, {"local_events": []}).successful
    ros.until(lambda: ros.node.count_publishers("/aseba/events/motor") == 0)


def second(ros, robot, number=7, source=HEAR):
    params = RuntimeParams(robots=[robot], source=source, first_id=number)
    life = ros.live(AsebaRuntime(ros.context, params, overrides={"use_sim_time": True}))
    ros.settle()
    return life


def test_robots_of_different_runtimes_receive_events_once(ros, runtime):
    runtime(HEAR, **TWO)
    other = second(ros, "carl")
    ros.until(lambda: ros.node.count_subscribers(TOPIC) == 2)
    air = ros.collect(Int16MultiArray, TOPIC)
    reported = ros.collect(Int16MultiArray, "/anna/aseba/events/ping")
    press(ros, "left", "/carl")
    carl = other.robots[0].device
    ros.until(lambda: get_variables(ros, "heard", "from", robot="/bert") == [[7, 8], [7]])
    press(ros, "left", "/anna")
    ros.until(lambda: carl.variables.get("from") == (1,))
    ros.until(lambda: len(air) == 2)
    times = {robot: get_variables(ros, "times", robot=f"/{robot}")[0] for robot in ("anna", "bert", "carl")}
    assert times == {"anna": [1], "bert": [2], "carl": [1]}
    assert len(reported) == 1


def test_an_event_from_ros_reaches_robots_of_other_runtimes(ros, runtime):
    runtime("var a", **TWO)
    other = second(ros, "carl")
    ros.until(lambda: ros.node.count_subscribers(TOPIC) == 2)
    publisher = ros.publisher(Int16MultiArray, "/anna/_aseba/emit")
    device = other.robots[0].device

    def heard():
        publisher.publish(event("ping", 5))
        return device.variables.get("heard") == (5, 0)

    ros.until(heard)
    assert device.variables.get("from") == (0,)


def test_robots_of_another_radio_network_receive_no_events(ros, runtime):
    runtime(HEAR, **TWO)
    setup = HEAR.replace("var times = 0", "var times = 0\ncall _rf.setup(2, 3)")
    other, third = second(ros, "carl", 7, setup), second(ros, "dora", 9, setup)
    ros.until(lambda: ros.node.count_subscribers(TOPIC) == 3)
    press(ros, "left", "/carl")
    ros.until(lambda: third.robots[0].device.variables.get("times") == (1,))
    assert get_variables(ros, "times", robot="/anna") == [[0]]
    assert other.robots[0].device.variables.get("times") == (0,)


@pytest.mark.parametrize(("values", "heard"), [([1, 2, 3, 4], [1, 2, 0, 0]), ([5], [5, 0, 0, 0])])
def test_a_robot_gets_as_many_values_as_its_program_declares(ros, runtime, values, heard):
    runtime(HEAR)
    message = Int16MultiArray(data=[7, 0, 0, *values])
    message.layout.dim = [MultiArrayDimension(label=label) for label in ("ping", "another runtime")]
    ros.publisher(Int16MultiArray, TOPIC).publish(message)
    ros.until(lambda: get_variables(ros, "times", "from") == [[1], [7]])
    assert get_variables(ros, "event.args")[0][:4] == heard


def test_nonsense_on_the_network_is_refused(ros, runtime):
    runtime(HEAR)
    logs = ros.collect(Log, "/rosout")
    publisher = ros.publisher(Int16MultiArray, TOPIC)
    publisher.publish(event("ping", 1))
    logged(ros, logs, f"{TOPIC} rejected: found 1 labels and 1 values")
    status = Status(ros)
    ros.until(lambda: status["state"] == "running")
