"""A publisher of a wrong type is noticed: said once with the cure, shown as a warning until it is gone."""

from __future__ import annotations

import pytest
import rclpy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import Twist, TwistStamped
from rcl_interfaces.msg import Log
from rclpy.context import Context
from rclpy.node import Node
from std_msgs.msg import String

from thymio_sim_ros.ros.interface.robot_inputs import robot_inputs
from thymio_sim_ros.ros.rclpy_ext import type_mismatch
from thymio_sim_ros.ros.rclpy_ext.type_mismatch import TypeMismatches

TWIST, STAMPED, TEXT = "geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped", "std_msgs/msg/String"


@pytest.fixture
def stranger(ros):
    """Make a node in another participant, as another process has it, that publishes one topic."""
    contexts, nodes = [], []

    def make(kind, topic, name="teleop", namespace=""):
        context = Context()
        rclpy.init(context=context, domain_id=ros.domain)
        contexts.append(context)
        node = Node(name, context=context, namespace=namespace, enable_rosout=False, start_parameter_services=False)
        node.create_publisher(kind, topic, 1)
        nodes.append(node)
        return node

    yield make
    for context in contexts:
        context.try_shutdown()


def beaten(simulator):
    """Publish the heartbeat of the simulator and return its mismatches."""
    simulator._diagnostics._type_mismatches._next_s = 0.0  # a slow machine would make it wait longer than a test does
    simulator._publish_heartbeat(0)
    return simulator._diagnostics._type_mismatches.mismatches


def test_a_stamped_velocity_is_detected_logged_once_and_shown(ros, simulation, stranger):
    sim = simulation()
    logs = ros.collect(Log, "/rosout", where=lambda log: "publisher of" in log.msg)
    diagnostics = ros.collect(DiagnosticArray, "/diagnostics")
    node = stranger(TwistStamped, "/cmd_vel")
    ros.until(lambda: beaten(sim.simulator))
    said = (
        f"/cmd_vel has a publisher of {STAMPED} by node /teleop; expected {TWIST}: its messages never arrive."
        " Publish it on /cmd_vel_stamped, or start the simulator with stamped_cmd_vel:=true"
    )
    ros.until(lambda: logs)
    assert [str(one) for one in beaten(sim.simulator)] == [said]
    diagnostics.clear()
    beaten(sim.simulator)
    ros.until(lambda: diagnostics)
    (status,) = [one for one in diagnostics[-1].status if one.name == "simulator: inputs"]
    assert (status.level, status.message) == (DiagnosticStatus.WARN, said)
    assert [(pair.key, pair.value) for pair in status.values] == [("/cmd_vel", said)]
    assert [log.msg for log in logs] == [said]
    node.destroy_node()
    ros.until(lambda: not beaten(sim.simulator))
    assert sim.simulator._diagnostics._type_mismatches.status().level == DiagnosticStatus.OK


def test_the_right_type_is_not_reported(ros, simulation, stranger):
    sim = simulation()
    stranger(Twist, "/cmd_vel")
    ros.until(lambda: ros.node.count_publishers("/cmd_vel"))
    mismatches = TypeMismatches(sim.simulator.node)
    mismatches.poll()
    assert mismatches.mismatches == ()


def test_every_input_of_every_robot_is_checked(ros, simulation, stranger):
    sim = simulation(playground="two_robots")
    robots = [names.name for names in sim.simulator.endpoints.robots.names.values()]
    topics = [*(f"/{robot}/{one.topic}" for robot in robots for one in robot_inputs()), "/simulator/_place"]
    node = stranger(String, topics[0])
    for topic in topics[1:]:
        node.create_publisher(String, topic, 1)
    mismatches = TypeMismatches(sim.simulator.node)

    def found():
        mismatches._next_s = 0.0
        mismatches.poll()
        return sorted(one.topic for one in mismatches.mismatches) == sorted(topics)

    ros.until(found)
    assert {(one.node, one.found) for one in mismatches.mismatches} == {("/teleop", TEXT)}


def test_added_robots_are_checked_too(ros, simulation, stranger):
    sim = simulation(playground="two_robots")
    (name, *_) = [names.name for names in sim.simulator.endpoints.robots.names.values()]
    mismatches = TypeMismatches(sim.simulator.node)
    mismatches.poll()
    sim.world.remove(name)
    sim.simulator.runner.update_robots()
    stranger(String, f"/{name}/_alarm", "late")
    ros.until(lambda: ros.node.count_publishers(f"/{name}/_alarm"))
    mismatches._next_s = 0.0
    mismatches.poll()
    assert mismatches.mismatches == ()


def test_a_runtime_checks_the_types_of_its_inputs(ros, runtime, stranger):
    made = runtime("onevent prox")
    stranger(Twist, "/_aseba/emit")

    def found():
        made._diagnostics._type_mismatches._next_s = 0.0
        made._diagnostics.publish_all(made.robots)
        return made._diagnostics._type_mismatches.mismatches

    ros.until(found)
    assert [one.topic for one in made._diagnostics._type_mismatches.mismatches] == ["/_aseba/emit"]


@pytest.mark.parametrize(
    ("topic", "found", "wanted", "reported"),
    [
        ("/r/cmd_vel", STAMPED, TWIST, "Publish it on /r/cmd_vel_stamped, or start the simulator with stamped_cmd"),
        ("/r/cmd_vel_stamped", TWIST, STAMPED, "Publish it on /r/cmd_vel"),
        ("/r/cmd_vel", TEXT, TWIST, f"Publish {TWIST} there"),
        ("/r/alarm", STAMPED, "std_msgs/msg/Bool", "Publish std_msgs/msg/Bool there"),
    ],
)
def test_the_cure_names_the_right_topic_or_type(topic, found, wanted, reported):
    inputs = {"/s/cmd_vel": TWIST, "/r/cmd_vel": TWIST, "/r/cmd_vel_stamped": STAMPED, "/r/alarm": "std_msgs/msg/Bool"}
    assert type_mismatch.cure(topic, found, wanted, inputs).startswith(reported)


def test_with_stamped_velocities_the_cure_is_the_other_topic():
    inputs = {"/cmd_vel": STAMPED, "/cmd_vel_unstamped": TWIST}
    assert type_mismatch.cure("/cmd_vel", TWIST, STAMPED, inputs) == "Publish it on /cmd_vel_unstamped"


def test_looking_takes_its_share_of_time_only(ros, simulation, monkeypatch):
    sim = simulation()
    mismatches, now = TypeMismatches(sim.simulator.node), [100.0]
    monkeypatch.setattr(type_mismatch.time, "monotonic", lambda: now[0])
    calls = []

    def find():
        calls.append(now[0])
        now[0] += 0.05
        return ()

    monkeypatch.setattr(mismatches, "_find", find)
    while now[0] < 200.0:
        mismatches.poll()
        now[0] += 1.0
    assert len(calls) == pytest.approx(100.0 * type_mismatch.SHARE / 0.05, abs=1)
