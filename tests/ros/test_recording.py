"""What `ros2 bag record` does: raw subscriptions to all of the graph with the QoS that each topic offers."""

from __future__ import annotations

import importlib
from functools import partial

from geometry_msgs.msg import Twist, Vector3
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import Range
from std_msgs.msg import Int16MultiArray

from thymio_sim_ros.ros.aseba.outside.driver_input import proximity_count
from thymio_sim_ros.ros.compat import tf2_messages
from thymio_sim_ros.ros.interface.names import PROXIMITY

PROGRAM = "var n = 0\ntimer.period[0] = 100\nonevent timer0\nn = n + 1"
# One topic of each kind: transient local, sensor, clock, transforms, runtime. No command is sent.
SPEAKS = {
    "/_aseba/status", "/clock", "/diagnostics", "/imu", "/_markers", "/_markers/objects", "/odom", "/proximity/center",
    "/_proximity/laser", "/_raw/proximity", "/robot_description", "/simulator/_state", "/tf", "/tf_static",
}  # fmt: skip


def message_class(kind):
    if kind == tf2_messages.TF_TYPE_NAME:
        return tf2_messages.TFMessage
    package, _, name = kind.split("/")
    return getattr(importlib.import_module(f"{package}.msg"), name)


def offered(node, topic):
    """The QoS that `ros2 bag record` chooses: what all publishers offer."""
    policies = {info.qos_profile.durability for info in node.get_publishers_info_by_topic(topic)}
    is_transient_local = policies == {DurabilityPolicy.TRANSIENT_LOCAL}
    return QoSProfile(
        depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL if is_transient_local else DurabilityPolicy.VOLATILE
    )


def test_everything_can_be_recorded_and_read_back(ros, simulation, runtime):
    sim = simulation()
    runtime(PROGRAM)
    sim.step(0.2)
    recorded, kinds = {}, {}
    for topic, (kind, *others) in ros.node.get_topic_names_and_types():
        if not ros.node.count_publishers(topic) or "/_action/" in topic:
            continue
        assert others == []
        kinds[topic] = message_class(kind)
        keep = partial(recorded.setdefault, topic)
        ros.node.create_subscription(kinds[topic], topic, keep, offered(ros.node, topic), raw=True)
    assert kinds.keys() >= SPEAKS
    sim.until(lambda: recorded.keys() >= SPEAKS)
    for topic, message in recorded.items():
        if kinds[topic] is not tf2_messages.TFMessage:
            assert isinstance(deserialize_message(message, kinds[topic]), kinds[topic])


def test_a_robot_that_is_driven_by_a_recording_drives_the_same_way(ros, simulation):
    recorded, sent = [], []
    ros.node.create_subscription(Twist, "/cmd_vel", recorded.append, 10, raw=True)
    first = simulation()
    wheels = ros.publisher(Twist, "/cmd_vel")
    for speed in (0.1, -0.05, 0.08):
        sent.append(first.now)
        wheels.publish(Twist(linear=Vector3(x=speed), angular=Vector3(z=speed * 5)))
        first.step(0.5)
    ros.end(first.simulator)
    again = simulation()
    for input_context, data in zip(sent, recorded[:], strict=True):
        again.until(lambda input_context=input_context: again.now >= input_context)
        wheels.publish(bytes(data))
    again.until(lambda: again.now >= first.now)
    assert again.thymio.pose == first.thymio.pose


def test_a_program_runs_on_recorded_readings(ros, simulation, runtime):
    sim = simulation(playground="obstacle")
    recorded = {}
    for place, name in enumerate(PROXIMITY):
        ros.node.create_subscription(
            Range, f"/proximity/{name}", lambda data, place=place: recorded.update({place: data}), 10, raw=True
        )
    ros.settle()
    sim.step(0.5)
    seen = [proximity_count(deserialize_message(recorded[place], Range)) for place in range(len(PROXIMITY))]
    assert any(seen)
    ros.end(sim.simulator)
    ros.simulation = None
    runtime("var kept[7]\nonevent prox\nkept = prox.horizontal", watch=["kept"])
    reported = ros.collect(Int16MultiArray, "/aseba/variables/kept", transient_local=True)
    for place, name in enumerate(PROXIMITY):
        ros.publisher(Range, f"/proximity/{name}").publish(bytes(recorded[place]))
    ros.until(lambda: reported and list(reported[-1].data) == seen)
