"""The integer readings of all robots in one message: its form, and its use by a runtime."""

from __future__ import annotations

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rclpy.serialization import deserialize_message, serialize_message
from std_msgs.msg import Int16MultiArray, MultiArrayDimension, MultiArrayLayout, String

from tests.ros.aseba_tools import get_variables
from thymio_sim_ros.ros.interface import qos
from thymio_sim_ros.ros.interface.raw_topic import RawDecoder, encode

COUNTER = "var motors = 0\nvar looks = 0\nonevent motor\n motors++\nonevent prox\n looks++\n"

readings = st.lists(
    st.tuples(
        st.text("abcäö_0", max_size=9),
        st.text("motorx", min_size=1, max_size=9),
        st.lists(st.integers(-0x8000, 0x7FFF), max_size=5).map(tuple),
    ),
    max_size=6,
)


def message(*parts, data):
    dims = [MultiArrayDimension(label=label, size=size, stride=size) for label, size in parts]
    return Int16MultiArray(layout=MultiArrayLayout(dim=dims), data=data)


@given(readings)
def test_the_message_is_an_array_with_a_dimension_for_each_reading(reported):
    found = deserialize_message(encode(reported), Int16MultiArray)
    labels = [f"{robot}/{sensor}" if robot else sensor for robot, sensor, _ in reported]
    sizes = [len(words) for _, _, words in reported]
    assert [(dim.label, dim.size, dim.stride) for dim in found.layout.dim] == list(
        zip(labels, sizes, sizes, strict=True)
    )
    assert list(found.data) == [word for _, _, words in reported for word in words]


@given(st.lists(readings, max_size=3))
def test_an_encoded_message_is_decoded_also_the_second_time(messages):
    decoder = RawDecoder()
    for _ in range(2):
        for message in messages:
            assert [
                (robot, sensor, tuple(words)) for robot, sensor, words in decoder.decode(encode(message))
            ] == message


def test_many_kinds_of_messages_are_read():
    decoder = RawDecoder()
    for count in range(1500):
        reported = [(f"r{count}", "motor", (count, 1))]
        assert list(decoder.decode(encode(reported))) == reported


def test_a_message_of_another_serializer_is_decoded():
    data = serialize_message(message(("a/motor", 2), ("tap", 1), data=[1, 2, 3]))
    padded = data + bytes(4)
    decoder = RawDecoder()
    for _ in range(2):
        for written in (data, padded):
            assert list(decoder.decode(written)) == [("a", "motor", (1, 2)), ("", "tap", (3,))]


def test_surplus_words_are_rejected():
    with pytest.raises(ValueError, match="found 3 words, expected 2"):
        list(RawDecoder().decode(serialize_message(message(("a/motor", 2), data=[1, 2, 3]))))


@pytest.mark.parametrize("broken", [b"", b"\0\1\0\0\1\0\0\0", encode([("a", "motor", (1, 2))])[:-3]])
def test_other_bytes_are_rejected(broken):
    with pytest.raises(RuntimeError):
        list(RawDecoder().decode(broken))


def test_a_runtime_gets_all_robots_of_a_simulator_in_one_topic(ros, simulation, runtime):
    sim = simulation(playground="two_robots")
    runtime(COUNTER)
    robots = list(sim.world.robots)
    ros.until(lambda: ros.node.count_subscribers("/simulator/_raw"), what="the runtime's ears")
    assert not any(ros.node.count_subscribers(f"/{robot}/_raw/motor") for robot in robots)
    before = sim.world.now_ns
    heard = ros.collect(Int16MultiArray, "/simulator/_raw")
    sim.until(lambda: sim.world.now_ns - before > 500_000_000 and heard)
    labels = {dim.label for one in heard for dim in one.layout.dim}
    assert {f"{robot}/{sensor}" for robot in robots for sensor in ("motor", "proximity", "ground")} <= labels


def test_each_reading_is_one_event(ros, simulation, runtime):
    sim = simulation()
    runtime(COUNTER)

    def count():
        return [value[0] for value in get_variables(ros, "motors", "looks")]

    ros.until(lambda: ros.node.count_subscribers("/simulator/_raw"), what="the runtime's ears")
    heard = ros.collect(Int16MultiArray, "/simulator/_raw")
    sim.until(lambda: heard)
    sim.simulator.runner.pause(True)
    ros.settle()
    motors, looks = count()
    done = len(heard)
    for _ in range(30):
        sim.simulator.runner.step(1)

    def reported(word):
        return sum(dim.label == word for one in list(heard)[done:] for dim in one.layout.dim)

    ros.until(lambda: reported("motor") == 30, what="the readings of 30 ticks")
    ros.settle()
    assert count() == [motors + 30, looks + reported("proximity")]
    assert reported("proximity") == 3


@pytest.fixture
def simulator(ros):
    """Says which robots there are, as a simulator."""
    state = ros.node.create_publisher(String, "/simulator/_state", qos.TRANSIENT_LOCAL)
    return lambda **fields: state.publish(String(data=json.dumps({"robots": [{"name": "anna"}], **fields})))


def told_by_single_topics(ros, *, speed):
    motor = ros.publisher(Int16MultiArray, "/anna/_raw/motor")
    motor.publish(Int16MultiArray(data=[speed, 0, 0, 0]))
    ros.until(lambda: get_variables(ros, "motor.left.speed", robot="/anna")[0] == [speed], what="a single reading")


def test_without_its_simulator_a_robot_uses_its_own_topics(ros, runtime, simulator):
    runtime(COUNTER)
    simulator(raw="/simulator/_raw")
    common = ros.publisher(Int16MultiArray, "/simulator/_raw")
    common.publish(message(("anna/motor", 4), data=[5, 0, 0, 0]))
    ros.until(lambda: get_variables(ros, "motor.left.speed", robot="/anna")[0] == [5], what="the common reading")
    assert ros.node.count_subscribers("/anna/_raw/motor") == 0
    ros.node.destroy_publisher(common)
    told_by_single_topics(ros, speed=6)


def test_a_simulator_without_the_common_topic_uses_one_topic_per_sensor(ros, runtime, simulator):
    runtime(COUNTER)
    simulator()
    told_by_single_topics(ros, speed=7)
    assert ros.node.count_subscribers("/simulator/_raw") == 0


def test_an_invalid_message_does_not_stop_the_runtime(ros, simulation, runtime):
    sim = simulation()
    node = runtime(COUNTER)
    node._follower._on_raw(b"\0\1\0\0nonsense")
    before = get_variables(ros, "motors")[0][0]
    sim.until(lambda: get_variables(ros, "motors")[0][0] > before)


def test_a_robot_without_a_simulator_uses_its_own_topics(ros, runtime):
    runtime(COUNTER, robots=["anna"])
    told_by_single_topics(ros, speed=8)
