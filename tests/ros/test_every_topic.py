"""Every topic and service that docs/ros.md lists: type, QoS, frame, stamp, rate; and what every message does."""

from __future__ import annotations

import json
import time

import pytest
from geometry_msgs.msg import (
    Point,
    Pose,
    PoseWithCovariance,
    PoseWithCovarianceStamped,
    Quaternion,
    Twist,
    TwistStamped,
    Vector3,
)
from rclpy.qos import DurabilityPolicy, ReliabilityPolicy
from std_msgs.msg import (
    Bool,
    ColorRGBA,
    Empty,
    Float32,
    Float32MultiArray,
    Float64MultiArray,
    Int8,
    Int8MultiArray,
    Int16,
    Int16MultiArray,
    MultiArrayDimension,
    MultiArrayLayout,
    UInt8MultiArray,
)

from thymio_sim_ros.ros import generate_ros_docs
from thymio_sim_ros.ros.interface import command_topics, qos, sensor_topics
from thymio_sim_ros.ros.interface.robot_inputs import robot_inputs
from thymio_sim_ros.ros.simulator import robot_endpoints, world_services, world_topics
from thymio_sim_ros.sim import commands
from thymio_sim_ros.sim.audio.synthesis import TRIANGLE
from thymio_sim_ros.sim.commands import LED_GROUPS

PAIR = json.dumps(
    {
        "format": 1,
        "title": "Two that face each other, and a wall behind one",
        "shapes": [
            {"kind": "rectangle", "name": "ground", "size_x_m": 2.0, "size_y_m": 2.0, "color": "#ffffff"},
            {"kind": "box", "name": "wall", "x_m": -0.2, "y_m": 0, "size_x_m": 0.1, "size_y_m": 1, "height_m": 0.1,
             "color": "#ff0000"},
        ],
        "robots": [
            {"name": "anna", "x_m": 0.0, "y_m": 0.0},
            {"name": "bert", "x_m": 0.3, "y_m": 0.0, "yaw_rad": 3.14159},
        ],
    }
)  # fmt: skip

PUBLISHED = [(sensor, row) for sensor in generate_ros_docs.own_sensors() for row in sensor_topics.rows_of(sensor)]
INPUTS = {one.topic: one for one in robot_inputs()}


def pose(x, y):
    place = Pose(position=Point(x=x, y=y), orientation=Quaternion(w=1.0))
    return PoseWithCovarianceStamped(pose=PoseWithCovariance(pose=place))


MAKES_EVENT = {
    "collision": ("_wheels/command", Float64MultiArray(data=[-7.0, -7.0])),
    "loudspeaker": ("_sound/samples", UInt8MultiArray(data=bytes([128, 200, 50] * 100))),
    "pen": ("pen/down", Bool(data=True)),
    "remote": ("_press/remote", Int8(data=80)),
    "sound": ("_press/sound", Float32(data=1.0)),
    "sound_finished": ("sound/tone", Float32MultiArray(data=[440.0, 0.05])),
    "tap": ("_press/tap", Empty()),
}
"""What makes a sensor of rare things measure."""


def is_as_declared(info, profile):
    found = info.qos_profile
    return (found.reliability, found.durability) == (profile.reliability, profile.durability)


@pytest.mark.parametrize(("sensor", "row"), PUBLISHED, ids=[row.topic for _, row in PUBLISHED])
def test_what_a_robot_publishes(ros, simulation, sensor, row):
    sim = simulation(playground=PAIR, lidar=True)
    topic = f"/anna/{row.topic}"
    (info,) = ros.node.get_publishers_info_by_topic(topic)
    assert info.topic_type == generate_ros_docs.type_name(row.type)
    assert is_as_declared(info, row.profile)
    messages = ros.collect(row.type, topic)
    if sensor.name in MAKES_EVENT:
        if sensor.name == "sound":
            ros.publisher(Float32, "/anna/_sound_threshold").publish(Float32(data=0.1))
            sim.step(0.05)
        word, message = MAKES_EVENT[sensor.name]
        ros.publisher(type(message), f"/anna/{word}").publish(message)
    elif sensor.name == "comm":
        for name in ("anna", "bert"):
            ros.publisher(Bool, f"/{name}/_comm/enable").publish(Bool(data=True))
            ros.publisher(Int16, f"/{name}/_comm/tx").publish(Int16(data=7))
    sim.until(lambda: messages, seconds=3.0)
    message = messages[-1]
    if row.frame:
        headed = message.markers[-1] if hasattr(message, "markers") else message
        usual = {"map": "map"}.get(row.frame, f"anna/{row.frame}")
        assert headed.header.frame_id == usual
        assert (headed.header.stamp.nanosec + headed.header.stamp.sec * 10**9) % 10_000_000 == 0
    rate = sensor_topics.rate(sensor, row)
    if rate not in ("event", "change"):
        messages.clear()
        sim.step(2.0)
        ros.until(lambda: abs(len(messages) - 2 * float(rate)) <= 1)


SENT = {
    "cmd_vel": (Twist(linear=Vector3(x=0.1)), commands.BodyTwist(0.1, 0.0)),
    "cmd_vel_stamped": (TwistStamped(twist=Twist(linear=Vector3(x=0.1))), commands.BodyTwist(0.1, 0.0)),
    "_wheels/command": (Float64MultiArray(data=[1.0, 2.0]), commands.WheelVelocities(1.0, 2.0)),
    "_motor/target": (Int16MultiArray(data=[100, -100]), commands.MotorTargets(100, -100)),
    **{
        f"led/body/{group}": (ColorRGBA(r=1.0, g=0.5), commands.SetLeds(group, (32, 16, 0)))
        for group in ("top", "bottom_left", "bottom_right")
    },
    **{
        command_topics.led_topic(group): (Float32MultiArray(data=[1.0] * size), commands.SetLeds(group, (32,) * size))
        for group, size in LED_GROUPS.items()
        if command_topics.led_topic(group) in INPUTS and group not in command_topics.BODY_LEDS
    },
    "_led/single": (Int16MultiArray(data=[3, 8]), commands.SetLed(3, 8)),
    "_led/own": (
        Float32MultiArray(layout=MultiArrayLayout(dim=[MultiArrayDimension(label="sd", size=1)]), data=[0.5]),
        commands.ShowOnLeds("sd", (16,)),
    ),
    "_led/off": (Empty(), commands.SetLeds("top", (0, 0, 0))),
    **{
        f"_led/gesture/{name}": (Float32(data=2.0), commands.PlayGesture(name, 2.0))
        for name in ("circle", "blink", "kit")
    },
    "_led/gesture/alive": (Empty(), commands.PlayGesture),
    "_led/gesture/off": (Empty(), commands.StopGesture()),
    "sound/tone": (Float32MultiArray(data=[440.0, 0.5]), commands.PlayTone(440.0, 500_000_000)),
    "_sound/system": (Int8(data=3), commands.PlaySystemSound(3)),
    "_sound/samples": (UInt8MultiArray(data=b"\x80\x90"), commands.PlaySamples(b"\x80\x90")),
    "_sound/wave": (Int8MultiArray(data=list(TRIANGLE)), commands.SetWave(TRIANGLE)),
    "_sound/volume": (Int8(data=2), commands.SetVolume(2)),
    "_sound_threshold": (Float32(data=1.0), commands.SetSoundThreshold(255)),
    "_comm/enable": (Bool(data=True), commands.EnableComm(True)),
    "_comm/tx": (Int16(data=9), commands.SetCommPayload(9)),
    "_alarm": (Bool(data=True), commands.SetAlarm(True)),
    "shutdown": (Empty(), commands.MotorTargets(0, 0)),
    "pen/down": (Bool(data=True), commands.SetPen(down=True)),
    "_pen/color": (ColorRGBA(r=1.0, a=1.0), commands.SetPen(color=(1.0, 0.0, 0.0), erase=False)),
    "_pen/width": (Float32(data=0.03125), commands.SetPen(width_m=0.03125)),
    "initialpose": (pose(0.0, 0.5), commands.MoveRobot(0.0, 0.5, 0.0)),
    **{f"_press/{name}": (Bool(data=True), commands.PressButton(name, True)) for name in commands.BUTTONS},
    "_press/tap": (Empty(), commands.Tap()),
    "_press/clap": (Float32(data=1.0), commands.Clap(255)),
    "_press/sound": (Float32(data=1.0), commands.SetNoiseLevel(255)),
    "_press/remote": (Int8(data=5), commands.RemoteKey(0, 5)),
    "_press/rc5": (Int16MultiArray(data=[1, 5]), commands.RemoteKey(1, 5)),
    "_press/lift": (Bool(data=True), commands.Lift(True)),
    "_press/tilt": (Float32MultiArray(data=[0.5, 0.0]), commands.Tilt(0.5, 0.0)),
    "_press/light": (Float32(data=1.0), commands.SetAmbientLight(1023)),
    "_press/proximity": (Int16MultiArray(data=[9, -1] + [0] * 5), commands.SetProximity((9, -1, 0, 0, 0, 0, 0))),
    "_press/ground": (Int16MultiArray(data=[-1, 1023]), commands.SetGround((-1, 1023))),
    "_press/temperature": (Float32(data=30.5), commands.SetTemperature(30.5)),
    "_press/battery": (Float32(data=3.5), commands.SetBattery(3.5)),
    "_press/charger": (Bool(data=True), commands.ConnectCharger(True)),
}  # fmt: skip
"""A message for every topic, and the command, or its type, that comes first of it."""


def test_there_is_a_message_for_every_topic():
    assert [topic for topic in INPUTS if topic not in SENT and not topic.startswith("actuator/")] == []


@pytest.mark.parametrize("topic", SENT)
def test_a_robot_subscribes_to_every_input(ros, simulation, monkeypatch, topic):
    sim = simulation(playground=PAIR, cmd_vel_timeout=0.0)
    posted = []
    monkeypatch.setattr(sim.world, "post", lambda robot, command: posted.append((robot, command)))
    (info,) = ros.node.get_subscriptions_info_by_topic(f"/anna/{topic}")
    one, (message, wanted) = INPUTS[topic], SENT[topic]
    assert info.topic_type == generate_ros_docs.type_name(one.type)
    assert is_as_declared(info, one.profile)
    ros.publisher(one.type, f"/anna/{topic}").publish(message)
    ros.until(lambda: posted)
    robot, command = posted[0]
    assert robot == "anna"
    assert command == wanted if not isinstance(wanted, type) else isinstance(command, wanted)
    sim.world.robots["anna"].accepts(command)


@pytest.mark.parametrize("topic", ["cmd_vel", "cmd_vel_stamped", "_wheels/command"])
def test_velocities_end_after_their_timeout_on_all_topics(ros, simulation, topic):
    sim = simulation(cmd_vel_timeout=0.25)
    ros.publisher(INPUTS[topic].type, f"/{topic}").publish(SENT[topic][0])
    robot = sim.world.robots["thymio"]
    sim.until(lambda: robot.twist.linear_m_s > 0.01, seconds=0.2)
    sim.until(lambda: robot.twist.linear_m_s == pytest.approx(0.0), seconds=0.5)


@pytest.mark.parametrize("topic", world_topics.TOPICS)
def test_what_is_published_of_the_world(ros, simulation, topic):
    one = world_topics.TOPICS[topic]
    sim = simulation(playground=PAIR, publish_map=True)
    name = topic if topic.startswith("/") else f"/{topic.replace('~', 'simulator')}"
    (info,) = ros.node.get_publishers_info_by_topic(name)
    assert info.topic_type == generate_ros_docs.type_name(one.type)
    assert is_as_declared(info, one.profile)
    messages = ros.collect(one.type, name)
    if topic == "/diagnostics":
        sim.simulator._publish_heartbeat(0)
    if topic == "~/_overview":  # at a rate of wall time, which the test does not wait for
        sim.simulator.endpoints.world.publish_overview_if_due(sim.world, time.monotonic_ns())
    sim.until(lambda: messages, seconds=1.0)
    if one.frame:
        headed = messages[-1].markers[0] if hasattr(messages[-1], "markers") else messages[-1]
        assert headed.header.frame_id == one.frame


def test_transforms_and_places_have_their_types(ros, simulation):
    simulation(playground=PAIR)
    for topic, profile in (("/tf", qos.TRANSFORMS), ("/tf_static", qos.TRANSIENT_LOCAL)):
        (info,) = ros.node.get_publishers_info_by_topic(topic)
        assert info.topic_type == "tf2_msgs/msg/TFMessage"
        assert is_as_declared(info, profile)
    (info,) = ros.node.get_subscriptions_info_by_topic("/simulator/_place")
    assert info.topic_type == "geometry_msgs/msg/TransformStamped"


def test_all_services_are_there_with_their_types(ros, simulation):
    simulation(playground=PAIR)
    found = dict(ros.node.get_service_names_and_types())
    wanted = {
        f"/{robot}/{name}": kind for robot in ("anna", "bert") for name, (kind, _) in robot_endpoints.SERVICES.items()
    }
    wanted |= {name.replace("~", "/simulator"): one.type for name, one in world_services.SERVICES.items()}
    assert {name: found.get(name) for name in wanted} == {
        name: [generate_ros_docs.type_name(kind)] for name, kind in wanted.items()
    }


def test_two_robots_share_no_topic_but_those_of_the_world(ros, simulation):
    sim = simulation(playground=PAIR)
    ours = [name for name, _ in sim.simulator.node.get_topic_names_and_types()]
    common = [name for name in ours if not name.startswith(("/anna/", "/bert/", "/simulator/"))]
    assert sorted(common) == sorted([
        "/tf", "/tf_static", "/clock", "/_markers", "/_markers/objects", "/diagnostics", "/rosout", "/parameter_events",
    ])  # fmt: skip


def test_everything_is_reliable():
    assert {profile.reliability for profile, _ in qos.KINDS.values()} == {ReliabilityPolicy.RELIABLE}
    assert qos.TRANSIENT_LOCAL.durability == DurabilityPolicy.TRANSIENT_LOCAL
