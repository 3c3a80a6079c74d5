"""An endpoint that is not connected is noticed: said once with the cure, shown as a warning until it is gone."""

from __future__ import annotations

import json
import math

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import Twist, TwistStamped
from nav_msgs.msg import OccupancyGrid, Odometry
from rcl_interfaces.msg import Log
from rcl_interfaces.srv import GetParameters
from rclpy.qos import DurabilityPolicy, QoSProfile, qos_profile_sensor_data
from sensor_msgs.msg import LaserScan
from std_msgs.msg import ColorRGBA, String
from std_srvs.srv import Empty, Trigger

from thymio_sim_ros.ros.interface.robot_inputs import robot_inputs
from thymio_sim_ros.ros.rclpy_ext import connections
from thymio_sim_ros.ros.rclpy_ext.connections import PUBLISHER, Connections

TWIST, STAMPED, TEXT, ODOMETRY = (
    "geometry_msgs/msg/Twist",
    "geometry_msgs/msg/TwistStamped",
    "std_msgs/msg/String",
    "nav_msgs/msg/Odometry",
)


@pytest.fixture
def stranger(strange_node):
    """Make a node in another participant that publishes one topic."""

    def make(kind, topic, name="teleop", namespace=""):
        node = strange_node(name, namespace)
        node.create_publisher(kind, topic, 1)
        return node

    return make


def beaten(simulator):
    """Publish the heartbeat of the simulator and return what is not connected."""
    simulator._connections._next_s = 0.0  # a slow machine would make it wait longer than a test does
    simulator._publish_heartbeat(0)
    return simulator._connections.unconnected


def test_a_stamped_velocity_is_detected_logged_once_and_shown(ros, simulation, stranger):
    sim = simulation()
    logs = ros.collect(Log, "/rosout", where=lambda log: "publisher of" in log.msg)
    diagnostics = ros.collect(DiagnosticArray, "/diagnostics")
    node = stranger(TwistStamped, "/cmd_vel")
    ros.until(lambda: beaten(sim.simulator))
    said = (
        f"/cmd_vel has a publisher of {STAMPED} by node /teleop; expected {TWIST}: its messages never arrive."
        " Publish on /cmd_vel_stamped, or start the simulator with --ros-args -p stamped_cmd_vel:=true"
    )
    ros.until(lambda: logs)
    assert [str(one) for one in beaten(sim.simulator)] == [said]
    diagnostics.clear()
    beaten(sim.simulator)
    ros.until(lambda: diagnostics)
    (status,) = [one for one in diagnostics[-1].status if one.name == "simulator: connections"]
    assert (status.level, status.message) == (DiagnosticStatus.WARN, said)
    assert [(pair.key, pair.value) for pair in status.values] == [("/cmd_vel", said)]
    assert [log.msg for log in logs] == [said]
    node.destroy_node()
    ros.until(lambda: not beaten(sim.simulator))
    assert sim.simulator._connections.status().level == DiagnosticStatus.OK


def test_the_right_type_is_not_reported(ros, simulation, stranger):
    sim = simulation()
    stranger(Twist, "/cmd_vel")
    ros.until(lambda: ros.node.count_publishers("/cmd_vel"))
    known = Connections(sim.simulator.node)
    known.poll()
    assert known.unconnected == ()


def test_no_hidden_name_is_proposed(ros, simulation, strange_node):
    """`/_led/state` is a topic of each robot, and `/state` is one of many students."""
    sim = simulation()
    strange_node("report").create_subscription(String, "/state", lambda _message: None, 1)
    ros.until(lambda: ros.node.count_subscribers("/state"))
    assert sim.simulator._connections.find(is_settled=True) == ()


def sentences(ros, sim, topic):
    """Wait until an endpoint of a topic is reported, and return the sentences about it."""
    return ros.until(lambda: [str(one) for one in beaten(sim.simulator) if one.topic == topic])


@pytest.mark.parametrize(
    ("topic", "kind", "namespace", "found", "cure"),
    [
        (
            "cmd_vel",
            Twist,
            "/thymio0",
            f"/thymio0/cmd_vel has a publisher of {TWIST} by node /thymio0/teleop; expected /cmd_vel, since"
            " /thymio0/cmd_vel has no subscriber: its messages never arrive.",
            "Publish on /cmd_vel, start the node without the namespace /thymio0, or start the simulator with"
            " --ros-args -p 'robot_names:=[thymio0]'",
        ),
        (
            "/turtle/one/cmd_vel",
            Twist,
            "",
            f"/turtle/one/cmd_vel has a publisher of {TWIST} by node /teleop; expected /cmd_vel, since"
            " /turtle/one/cmd_vel has no subscriber: its messages never arrive.",
            "Publish on /cmd_vel",
        ),
        (
            "CmdVel",
            Twist,
            "",
            f"/CmdVel has a publisher of {TWIST} by node /teleop; expected /cmd_vel, since /CmdVel has no subscriber:"
            " its messages never arrive.",
            "Publish on /cmd_vel",
        ),
        (
            "/a/led/top",
            ColorRGBA,
            "",
            "/a/led/top has a publisher of std_msgs/msg/ColorRGBA by node /teleop; expected /led/body/top, since"
            " /a/led/top has no subscriber: its messages never arrive.",
            "Publish on /led/body/top",
        ),
        (
            "/a/cmd_vel",
            String,
            "",
            f"/a/cmd_vel has a publisher of {TEXT} by node /teleop; expected /cmd_vel of {TWIST}, since /a/cmd_vel has"
            " no subscriber: its messages never arrive.",
            "Publish on /cmd_vel, or start the simulator with --ros-args -p 'robot_names:=[a]'",
        ),
    ],
)
def test_a_publisher_with_another_name_is_reported(ros, simulation, stranger, topic, kind, namespace, found, cure):
    sim = simulation()
    node = stranger(kind, topic, namespace=namespace)
    assert sentences(ros, sim, node.resolve_topic_name(topic)) == [f"{found} {cure}"]


def test_a_subscriber_with_another_name_is_reported(ros, simulation, strange_node):
    sim = simulation(playground="two_robots")
    first, second = (names.name for names in sim.simulator.endpoints.robots.names.values())
    strange_node().create_subscription(Odometry, "odom", print, 1)
    assert sentences(ros, sim, "/odom") == [
        f"/odom has a subscriber of {ODOMETRY} by node /teleop; expected /{first}/odom or /{second}/odom, since /odom"
        f" has no publisher: it gets no message. Subscribe to /{first}/odom"
    ]


def test_a_name_that_another_node_uses_is_not_reported(ros, simulation, strange_node):
    sim = simulation()
    node = strange_node()
    node.create_publisher(Twist, "/turtle1/cmd_vel", 1)
    node.create_subscription(Twist, "/turtle1/cmd_vel", print, 1)
    node.create_publisher(Twist, "/turtle2/cmd_vel", 1)
    node.create_publisher(String, "/chatter", 1)
    node.create_client(GetParameters, "/other/get_parameters")
    assert sentences(ros, sim, "/turtle2/cmd_vel")
    assert [one.topic for one in beaten(sim.simulator)] == ["/turtle2/cmd_vel"]


def test_a_topic_that_is_switched_off_is_reported_with_its_parameter(ros, simulator_with, strange_node):
    simulator = simulator_with("-p", "publish_ground_truth:=false")
    node = strange_node()
    node.create_subscription(Odometry, "/_ground_truth/odom", print, 1)
    node.create_subscription(OccupancyGrid, "/map", print, 1)
    node.create_subscription(LaserScan, "/scan", print, 1)
    ros.until(lambda: len(beaten(simulator)) == 3)
    assert sorted(str(one) for one in beaten(simulator)) == [
        f"/_ground_truth/odom has a subscriber of {ODOMETRY} by node /teleop; expected a publisher: it gets no message."
        " It is switched off: start the simulator with --ros-args -p publish_ground_truth:=true",
        "/map has a subscriber of nav_msgs/msg/OccupancyGrid by node /teleop; expected a publisher: it gets no message."
        " It is switched off: start the simulator with --ros-args -p publish_map:=true",
        "/scan has a subscriber of sensor_msgs/msg/LaserScan by node /teleop; expected a publisher: it gets no message."
        " It is switched off: start the simulator with --ros-args -p lidar.enabled:=true",
    ]


def test_clients_and_subscribers_of_the_wrong_type_are_reported(ros, simulation, strange_node):
    sim = simulation()
    node = strange_node()
    node.create_client(Empty, "/reset_odometry")
    node.create_subscription(Twist, "/odom", print, 1)
    assert sentences(ros, sim, "/reset_odometry") == [
        "/reset_odometry has a client of std_srvs/srv/Empty by node /teleop; expected std_srvs/srv/Trigger: its calls"
        " are never answered. Use the type std_srvs/srv/Trigger"
    ]
    assert sentences(ros, sim, "/odom") == [
        f"/odom has a subscriber of {TWIST} by node /teleop; expected {ODOMETRY}: it gets no message. Use the type"
        f" {ODOMETRY}"
    ]


def test_a_client_with_another_name_is_reported(ros, simulation, strange_node):
    sim = simulation()
    strange_node().create_client(Trigger, "/thymio0/reset_odometry")
    assert sentences(ros, sim, "/thymio0/reset_odometry") == [
        "/thymio0/reset_odometry has a client of std_srvs/srv/Trigger by node /teleop; expected /reset_odometry, since"
        " /thymio0/reset_odometry has no server: its calls are never answered. Call /reset_odometry, or start the"
        " simulator with --ros-args -p 'robot_names:=[thymio0]'"
    ]


def test_an_incompatible_qos_is_reported(ros, simulation, strange_node):
    sim = simulation()
    node = strange_node()
    node.create_publisher(Twist, "/cmd_vel", qos_profile_sensor_data)
    retained = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    node.create_subscription(Odometry, "/odom", print, retained)
    node.create_subscription(Odometry, "/_ground_truth/odom", print, qos_profile_sensor_data)
    assert sentences(ros, sim, "/cmd_vel") == [
        f"/cmd_vel has a publisher of {TWIST} with reliability best_effort by node /teleop; expected reliability"
        " reliable: its messages never arrive. Create it with the reliability reliable"
    ]
    assert sentences(ros, sim, "/odom") == [
        f"/odom has a subscriber of {ODOMETRY} with durability transient_local by node /teleop; expected durability"
        " volatile: it gets no message. Create it with the durability volatile"
    ]
    assert sorted(one.topic for one in beaten(sim.simulator)) == ["/cmd_vel", "/odom"]


def test_viewers_get_what_is_not_connected(ros, simulation, stranger):
    sim = simulation()
    stranger(String, "/_alarm")
    said = sentences(ros, sim, "/_alarm")
    assert json.loads(sim.simulator.runner.state().as_json())["faults"] == said


def test_every_input_of_every_robot_is_checked(ros, simulation, stranger):
    sim = simulation(playground="two_robots")
    robots = [names.name for names in sim.simulator.endpoints.robots.names.values()]
    topics = [*(f"/{robot}/{one.topic}" for robot in robots for one in robot_inputs()), "/simulator/_place"]
    node = stranger(String, topics[0])
    for topic in topics[1:]:
        node.create_publisher(String, topic, 1)
    known = Connections(sim.simulator.node)

    def found():
        known._next_s = 0.0
        known.poll()
        return sorted(one.topic for one in known.unconnected) == sorted(topics)

    ros.until(found)
    assert {(one.node, one.found) for one in known.unconnected} == {("/teleop", TEXT)}


def test_added_robots_are_checked_too(ros, simulation, stranger):
    sim = simulation(playground="two_robots")
    (name, *_) = [names.name for names in sim.simulator.endpoints.robots.names.values()]
    known = Connections(sim.simulator.node)
    known.poll()
    sim.world.remove(name)
    sim.simulator.runner.update_robots()
    stranger(String, f"/{name}/_alarm", "late")
    ros.until(lambda: ros.node.count_publishers(f"/{name}/_alarm"))
    known._next_s = 0.0
    known.poll()
    assert known.unconnected == ()


def test_a_runtime_checks_the_types_of_its_inputs(ros, runtime, stranger):
    made = runtime("onevent prox")
    stranger(Twist, "/_aseba/emit")

    def found():
        made._diagnostics._connections._next_s = 0.0
        made._diagnostics.publish_all(made.robots)
        return made._diagnostics._connections.unconnected

    ros.until(found)
    assert [one.topic for one in made._diagnostics._connections.unconnected] == ["/_aseba/emit"]


@pytest.mark.parametrize(
    ("topic", "found", "reported"),
    [
        ("/r/cmd_vel", STAMPED, "Publish on /r/cmd_vel_stamped, or start the simulator with --ros-args -p stamped_cmd"),
        ("/r/cmd_vel_stamped", TWIST, "Publish on /r/cmd_vel"),
        ("/r/cmd_vel", TEXT, f"Use the type {TWIST}"),
        ("/r/alarm", STAMPED, "Use the type std_msgs/msg/Bool"),
    ],
)
def test_the_cure_names_the_right_topic_or_type(topic, found, reported):
    inputs = {"/s/cmd_vel": TWIST, "/r/cmd_vel": TWIST, "/r/cmd_vel_stamped": STAMPED, "/r/alarm": "std_msgs/msg/Bool"}
    assert connections.cure(PUBLISHER, topic, found, inputs).startswith(reported)


def test_with_stamped_velocities_the_cure_is_the_other_topic():
    inputs = {"/cmd_vel": STAMPED, "/cmd_vel_unstamped": TWIST}
    assert connections.cure(PUBLISHER, "/cmd_vel", TWIST, inputs) == "Publish on /cmd_vel_unstamped"


def test_looking_takes_its_share_of_time_only(ros, simulation, monkeypatch):
    sim = simulation()
    known, now = Connections(sim.simulator.node), [100.0]
    for clock in ("monotonic", "thread_time"):
        monkeypatch.setattr(connections.time, clock, lambda: now[0])
    calls = []

    def find():
        calls.append(now[0])
        now[0] += 0.05
        return ()

    monkeypatch.setattr(known, "find", find)
    while now[0] < 200.0:
        known.poll()
        now[0] += 1.0
    assert len(calls) == pytest.approx(100.0 * connections.SHARE / 0.05, abs=1)


def test_a_new_node_is_looked_at_although_the_next_poll_is_far(ros, simulation, stranger):
    sim = simulation()
    known = Connections(sim.simulator.node)
    known.poll()
    known._next_s = math.inf
    stranger(TwistStamped, "/cmd_vel")

    def found():
        known._next_look_s = 0.0
        known.poll()
        return known.unconnected

    (only,) = ros.until(found)
    assert only.topic == "/cmd_vel"
